#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// What a texture tolerance costs: seconds of simplify_with_bound with --texture-tolerance and without, one
// thread, the best of five runs of each in turn; with --all also a line tolerance and 30 degrees for normals. Prints a
// table in Markdown. Needs the tools in build/tools and Node.js.
// Usage: tools/bench/appearance/times.mjs [--all] MODEL.obj...
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '../../..');
const models = process.argv.slice(2).filter((argument) => argument !== '--all');
const all = models.length < process.argv.length - 2;
if (models.length === 0) {
  console.error('usage: tools/bench/appearance/times.mjs [--all] MODEL.obj...');
  process.exit(2);
}
const percents = ['1%', '0.3%', '0.1%'];
const runs = 5;
const out = join(root, 'out/appearance');
mkdirSync(out, { recursive: true });

function run(model, percent, more) {
  const json = join(out, 'times.json');
  const { status, stderr } = spawnSync(join(root, 'build/tools/simplify_with_bound'), [model, join(out, 'times.obj'),
    '--tolerance', percent, ...more, '--threads', '1', '--json', json, '--quiet'], { encoding: 'utf8' });
  if (status !== 0) throw new Error(`${model}, ${percent}: ${stderr}`);
  const { simplified, seconds } = JSON.parse(readFileSync(json, 'utf8'));
  return { seconds: seconds.total, faces: simplified.faces };
}

const better = (a, b) => (a && a.seconds <= b.seconds ? a : b);
const mean = (numbers) => Math.exp(numbers.reduce((sum, x) => sum + Math.log(x), 0) / numbers.length);
const row = (cells) => console.log(`| ${cells.join(' | ')} |`);

row(['model', ...percents.map((percent) => `${percent}: faces, seconds, ratio`)]);
row(['---', ...percents.map(() => '---')]);
const ratios = [];
for (const model of models) {
  const cells = percents.map((percent) => {
    let bare, textured;
    for (let i = 0; i < runs; ++i) {
      bare = better(bare, run(model, percent, []));
      const more = all ? ['--line-tolerance', percent, '--normal-tolerance', '30'] : [];
      textured = better(textured, run(model, percent, ['--texture-tolerance', percent, ...more]));
    }
    const ratio = textured.seconds / bare.seconds;
    ratios.push(ratio);
    return `${bare.faces} → ${textured.faces}, ${bare.seconds.toFixed(3)} → ${textured.seconds.toFixed(3)}, ` +
      `${ratio.toFixed(2)}`;
  });
  row([basename(model, '.obj').replace(/^[a-z]+_/, ''), ...cells]);
}
ratios.sort((a, b) => a - b);
console.log(`\nRatio: geometric mean ${mean(ratios).toFixed(2)}, median ` +
  `${ratios[Math.floor(ratios.length / 2)].toFixed(2)}, worst ${ratios.at(-1).toFixed(2)}.`);
