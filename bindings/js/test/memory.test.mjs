// SPDX-License-Identifier: MIT
// The npm package where the engine's memory is beyond 2 GB, of which addresses are negative as signed numbers.
// Environment: MESHBOUND_NPM is the folder of the package.
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const npm = process.env.MESHBOUND_NPM;
const folder = mkdtempSync(join(tmpdir(), 'meshbound-js-'));
after(() => rmSync(folder, { recursive: true }));

// The package with another engine.js: the engine of the package, with its first 2 GB taken, which are never written.
for (const file of ['meshbound.js', 'options.js', 'simplifier.js', 'engine.wasm', 'package.json'])
  copyFileSync(join(npm, file), join(folder, file));
writeFileSync(join(folder, 'engine.js'), `
  import createEngine from ${JSON.stringify(pathToFileURL(join(npm, 'engine.js')).href)};
  export let engine;
  export default async (options) => {
    engine = await createEngine(options);
    if (engine._malloc(2 ** 31) === 0) throw new Error('there is no memory of 2 GB');
    return engine;
  };
`);
const url = (path) => pathToFileURL(path).href;
const low = await import(url(join(npm, 'meshbound.js')));
const high = await import(url(join(folder, 'meshbound.js')));
const loaded = await import(url(join(folder, 'engine.js')));
before(() => Promise.all([low.ready, high.ready]));

/** A wavy square of side * side vertices. */
function sheet(side, lift) {
  const positions = new Float64Array(3 * side * side);
  const indices = [];
  for (let i = 0; i < side * side; ++i) {
    const [x, y] = [i % side, Math.floor(i / side)];
    positions.set([x, y, lift + Math.sin(x / 5) * Math.cos(y / 7)], 3 * i);
    if (x + 1 < side && y + 1 < side) indices.push(i, i + 1, i + side + 1, i, i + side + 1, i + side);
  }
  return { positions, indices: Uint32Array.from(indices) };
}

test('results are the same beyond 2 GB', () => {
  const [a, b] = [sheet(30, 0), sheet(30, 0.1)];
  const options = {
    tolerance: 0.2, levels: [0.05], certificate: true, featureEdges: [0, 1], lineTolerance: 0.1,
    lockedVertices: new Uint8Array(900).fill(1, 0, 50),
  };
  for (const call of [
    ({ describe }) => describe(a),
    ({ hausdorffDistance }) => hausdorffDistance(a, b),
    ({ check }) => check(a, b, 0.2),
    ({ simplify }) => simplify(a, options),
    ({ buildCertificate }) => buildCertificate(a, b, 0.2),
    ({ readMesh, writeMesh }) => readMesh(writeMesh(a, 'ply'), 'ply'),
    ({ MeshboundSimplifier }) => MeshboundSimplifier.simplify(a.indices, Float32Array.from(a.positions), 3, 0, 0.01),
  ])
    assert.deepEqual(call(high), call(low), String(call));
  assert.throws(() => high.describe({ ...a, indices: a.indices.map((v) => v + 1) }), /there are only 900/);
});

test('a level without triangles is no result', () => {
  const { engine } = loaded, level = engine._js_level;
  engine._js_level = (simplification, index, out) => {
    const status = level(simplification, index, out);
    engine.HEAPF64[(out >>> 0) / 8 + 4] = 0;
    return status;
  };
  assert.throws(() => high.simplify(sheet(5, 0), { tolerance: 0.1 }), /without triangles/);
  engine._js_level = level;
});

test('locked vertices do not take a second copy of the mesh', () => {
  const { engine } = loaded, newMesh = engine._js_mesh_new;
  let copies = 0;
  engine._js_mesh_new = (...values) => {
    ++copies;
    return newMesh(...values);
  };
  high.simplify(sheet(5, 0), { tolerance: 0.1, lockedVertices: new Uint8Array(25) });
  engine._js_mesh_new = newMesh;
  assert.equal(copies, 1);
});
