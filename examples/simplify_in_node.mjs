// SPDX-License-Identifier: MIT
// node simplify_in_node.mjs IN.ply OUT.ply: simplifies a mesh at 0.1% of its diagonal.
import { readFile, writeFile } from 'node:fs/promises';
import { describe, readMesh, ready, simplify, writeMesh } from 'meshbound';

const [, , input, output] = process.argv;
await ready;
const original = readMesh(await readFile(input), 'ply');
const { level } = simplify(original, { tolerance: 0.001 * describe(original).bboxDiagonal });
await writeFile(output, writeMesh(level, 'ply'));
console.log(`${original.indices.length / 3} -> ${level.indices.length / 3} triangles, H <= ${level.distance.upper}`);
