// SPDX-License-Identifier: MIT
// node compare.mjs TOOLS CHROMIUM FOLDER SHARE MODEL.obj...: simplifies each model to that share of its faces, by our tool
// within 1% of its diagonal, shape and texture, and by meshoptimizer; measures both, draws both, and prints a table in
// Markdown. Files go to FOLDER. Where one of the two stops earlier, the other gets as many faces. Of meshoptimizer's
// results with several weights of texture coordinates the one that looks best counts.
import { execFileSync } from 'node:child_process';
import { mkdir, readFile } from 'node:fs/promises';
import { basename, join } from 'node:path';

import { simplifyByMeshopt } from './meshopt.mjs';
import { faceCount, linesOf, readObj, writeLines, writeObj } from './obj.mjs';
import { pictureErrors } from './render.mjs';

const [, , tools, chromium, folder, share, ...models] = process.argv;
if (models.length === 0) {
  console.error('usage: node compare.mjs TOOLS CHROMIUM FOLDER SHARE MODEL.obj...');
  process.exit(2);
}
const tolerance = '1%';
const weights = [0, 1, 10];

async function byMeshopt(mesh, faces) {
  const levels = [];
  for (const weight of weights) levels.push(await simplifyByMeshopt(mesh, faces, weight));
  return levels;
}

async function distances(a, b, more = []) {
  const json = `${b}.json`;
  execFileSync(join(tools, 'hausdorff_distance'), [a, b, ...more, '--error-bound', '0.01%', '--json', json, '--quiet'],
    { stdio: 'ignore' });
  return JSON.parse(await readFile(json, 'utf8'));
}

async function measured(model, level) {
  const files = [];
  for (const path of [model, level]) {
    const mesh = await readObj(path);
    const lines = linesOf(mesh);
    if (lines.length === 0) continue;
    files.push(join(folder, `${basename(path, '.obj')}_lines.obj`));
    await writeLines(files.at(-1), mesh, lines);
  }
  const { a, distance, texture } = await distances(model, level, ['--texture']);
  const lines = files.length === 2 ? (await distances(...files)).distance.upper : NaN;
  const percent = (length) => (100 * length) / a.bbox_diagonal;
  return { distance: percent(distance.upper), lines: percent(lines), texture: percent(texture.upper) };
}

const row = (cells) => console.log(`| ${cells.join(' | ')} |`);
const digits = (number) => number.toPrecision(3);

await mkdir(folder, { recursive: true });
row(['model', 'faces', 'ours, meshoptimizer', 'distance', 'lines', 'texture moves', 'mean difference of a pixel']);
row(['---', '---', '---', '---', '---', '---', '---']);
let won = 0;
for (const model of models) {
  const name = basename(model, '.obj');
  const ours = join(folder, `${name}_ours.obj`);
  const original = await readObj(model);
  let others = await byMeshopt(original, Number(share) * faceCount(original));
  const target = Math.max(...others.map(faceCount));
  execFileSync(join(tools, 'simplify_with_bound'),
    [model, ours, '--tolerance', tolerance, '--texture-tolerance', tolerance, '--target-faces', `${target}`, '--quiet'],
    { stdio: 'ignore' });
  const level = await readObj(ours);
  if (faceCount(level) > target) others = await byMeshopt(original, faceCount(level));
  const [error, ...errors] = await pictureErrors(chromium, original, [level, ...others]);
  const best = errors.indexOf(Math.min(...errors));
  const theirs = join(folder, `${name}_meshopt.obj`);
  await writeObj(theirs, others[best]);
  const [our, their] = [await measured(model, ours), await measured(model, theirs)];
  if (error < errors[best]) ++won;
  row([name, faceCount(original), `${faceCount(level)}, ${faceCount(others[best])}`,
    `${digits(our.distance)}%, ${digits(their.distance)}%`, `${digits(our.lines)}%, ${digits(their.lines)}%`,
    `${digits(our.texture)}%, ${digits(their.texture)}%`,
    `${digits(error)}, ${digits(errors[best])}`]);
}
console.log(`\nOurs looks more like the original on ${won} of ${models.length} models.`);
