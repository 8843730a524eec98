// SPDX-License-Identifier: MIT
// node compare.mjs TOOLS CHROMIUM FOLDER MODEL.obj...: simplifies each model by our tool within 1% of its diagonal, shape
// and texture, and by meshoptimizer to as many faces; measures both, draws both, and prints a table in Markdown. Files go
// to FOLDER. Of meshoptimizer's results with several weights of texture coordinates the one that looks best counts.
import { execFileSync } from 'node:child_process';
import { mkdir, readFile } from 'node:fs/promises';
import { basename, join } from 'node:path';

import { simplifyByMeshopt } from './meshopt.mjs';
import { faceCount, readObj, writeObj } from './obj.mjs';
import { pictureErrors } from './render.mjs';

const [, , tools, chromium, folder, ...models] = process.argv;
if (models.length === 0) {
  console.error('usage: node compare.mjs TOOLS CHROMIUM FOLDER MODEL.obj...');
  process.exit(2);
}
const tolerance = '1%';
const weights = [0, 1, 10];

async function measured(original, level) {
  const json = `${level}.json`;
  execFileSync(join(tools, 'hausdorff_distance'),
    [original, level, '--texture', '--error-bound', '0.01%', '--json', json, '--quiet'], { stdio: 'ignore' });
  const { a, distance, texture } = JSON.parse(await readFile(json, 'utf8'));
  const percent = (length) => (100 * length) / a.bbox_diagonal;
  return { distance: percent(distance.upper), texture: percent(texture.upper) };
}

const row = (cells) => console.log(`| ${cells.join(' | ')} |`);
const digits = (number) => number.toPrecision(3);

await mkdir(folder, { recursive: true });
row(['model', 'faces', 'ours, meshoptimizer', 'distance', 'texture moves', 'mean difference of a pixel']);
row(['---', '---', '---', '---', '---', '---']);
let won = 0;
for (const model of models) {
  const name = basename(model, '.obj');
  const ours = join(folder, `${name}_ours.obj`);
  execFileSync(join(tools, 'simplify_with_bound'),
    [model, ours, '--tolerance', tolerance, '--texture-tolerance', tolerance, '--quiet'], { stdio: 'ignore' });
  const original = await readObj(model);
  const level = await readObj(ours);
  const others = [];
  for (const weight of weights) others.push(await simplifyByMeshopt(original, faceCount(level), weight));
  const [error, ...errors] = await pictureErrors(chromium, original, [level, ...others]);
  const best = errors.indexOf(Math.min(...errors));
  const theirs = join(folder, `${name}_meshopt.obj`);
  await writeObj(theirs, others[best]);
  const [our, their] = [await measured(model, ours), await measured(model, theirs)];
  if (error < errors[best]) ++won;
  row([name, faceCount(original), `${faceCount(level)}, ${faceCount(others[best])}`,
    `${digits(our.distance)}%, ${digits(their.distance)}%`, `${digits(our.texture)}%, ${digits(their.texture)}%`,
    `${digits(error)}, ${digits(errors[best])}`]);
}
console.log(`\nOurs looks more like the original on ${won} of ${models.length} models.`);
