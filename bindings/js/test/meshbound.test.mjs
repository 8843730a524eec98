// SPDX-License-Identifier: MIT
// The npm package in Node: the same intervals as the native tools, bit for bit; simplification; what stands in for
// MeshoptSimplifier. Environment: MESHBOUND_NPM is the folder of the package; MESHBOUND_TOOLS and MESHBOUND_GENERATOR are
// the native tools, without which the comparison is skipped.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const meshbound = await import(pathToFileURL(join(process.env.MESHBOUND_NPM, 'meshbound.js')).href);
before(() => meshbound.ready);

const folder = mkdtempSync(join(tmpdir(), 'meshbound-js-'));
after(() => rmSync(folder, { recursive: true }));

/** A square of side * side vertices, wavy. */
function sheet(side, height, lift = 0) {
  const positions = new Float32Array(3 * side * side);
  const indices = [];
  for (let i = 0; i < side * side; ++i) {
    const [x, y] = [i % side, Math.floor(i / side)];
    positions.set([x, y, lift + height * Math.sin(x / 5) * Math.cos(y / 7)], 3 * i);
    if (x + 1 < side && y + 1 < side) indices.push(i, i + 1, i + side + 1, i, i + side + 1, i + side);
  }
  return { positions, indices: Uint32Array.from(indices) };
}

function readOff(path) {
  const words = readFileSync(path, 'utf8').split(/\s+/);
  const [vertices, triangles] = words.slice(1, 3).map(Number);
  const positions = Float64Array.from(words.slice(4, 4 + 3 * vertices), Number);
  const indices = new Uint32Array(3 * triangles);
  for (let i = 0; i < triangles; ++i)
    for (let k = 0; k < 3; ++k) indices[3 * i + k] = Number(words[4 + 3 * vertices + 4 * i + 1 + k]);
  return { positions, indices };
}

const { MESHBOUND_TOOLS: tools, MESHBOUND_GENERATOR: generator } = process.env;

test('30 pairs have the intervals of the native tool, bit for bit', { skip: !tools && 'no native tools' }, () => {
  const meshes = ['icosphere', 'uv-sphere', 'torus', 'cube', 'thin-sheet', 'spiked-plane', 'cylinder', 'gear', 'terrain']
    .map((kind) => {
      const path = join(folder, `${kind}.off`);
      execFileSync(generator, [kind, '--size', '1300', '-o', path]);
      return { kind, path, mesh: readOff(path) };
    });
  let pairs = 0;
  for (const [i, a] of meshes.entries()) {
    for (const b of meshes.slice(i + 1)) {
      if (pairs === 30) return;
      const output = execFileSync(join(tools, 'hausdorff_distance'), [a.path, b.path, '--json']);
      const native = JSON.parse(output).distance;
      const ours = meshbound.hausdorffDistance(a.mesh, b.mesh);
      const pair = `${a.kind} and ${b.kind}`;
      assert.equal(ours.lower, native.lower, pair);
      assert.equal(ours.upper, native.upper, pair);
      for (const [direction, key] of [[ours.aToB, 'a_to_b'], [ours.bToA, 'b_to_a']]) {
        assert.equal(direction.lower, native[key].lower, pair);
        assert.equal(direction.upper, native[key].upper, pair);
        assert.deepEqual(direction.from.position, native[key].witness.from, pair);
      }
      ++pairs;
    }
  }
  assert.equal(pairs, 30);
});

test('two parallel sheets are as far apart as they were placed', () => {
  const distance = meshbound.hausdorffDistance(sheet(8, 0), sheet(8, 0, 0.25));
  assert.ok(distance.lower <= 0.25 && 0.25 <= distance.upper && distance.upper < 0.2501);
  assert.equal(meshbound.check(sheet(8, 0), sheet(8, 0, 0.25), 0.3).verdict, 'within');
  assert.equal(meshbound.check(sheet(8, 0), sheet(8, 0, 0.25), 0.2).verdict, 'exceeds');
  const oneSided = meshbound.hausdorffDistance(sheet(4, 0), sheet(8, 0), { oneSided: true });
  assert.ok(oneSided.upper < 1e-4);
  assert.equal(oneSided.bToA.outcome, 'not_searched');
});

test('a mesh that is a point beside the other one, of sizes whose squares are no numbers', () => {
  const corner = (size) => ({ positions: Float64Array.of(0, 0, 0, size, 0, 0, 0, size, 0), indices: Uint32Array.of(0, 1, 2) });
  for (const exponent of [-600, 600]) {
    const large = corner(2 ** exponent), small = corner(2 ** (exponent - 50));
    const distance = meshbound.hausdorffDistance(large, small), length = 2 ** exponent - 2 ** (exponent - 50);
    assert.ok(distance.lower <= length && length <= distance.upper && distance.upper - distance.lower < 1e-12 * length);
    assert.equal(meshbound.check(large, small, length / 1024).verdict, 'exceeds');
    assert.ok(Math.abs(meshbound.describe(large).bboxDiagonal / 2 ** exponent - Math.SQRT2) < 1e-12);
  }
});

test('a decision of one side has its own bounds', () => {
  // A small triangle of the second mesh floats above the large one that both have, so that only that mesh is far away.
  const indices = Uint32Array.of(0, 1, 2, 3, 4, 5);
  const positions = Float32Array.of(0, 0, 0, 10, 0, 0, 0, 10, 0, 1, 1, 0, 2, 1, 0, 1, 2, 0);
  const floating = positions.map((x, i) => (i > 9 && i % 3 === 2 ? 1 : x));
  const oneSided = meshbound.check({ positions, indices }, { positions: floating, indices }, 1.5, { oneSided: true });
  assert.equal(oneSided.verdict, 'within');
  assert.equal(oneSided.distance.lower, 0);
  assert.equal(oneSided.distance.bToA.outcome, 'not_searched');
});

test('facts of a mesh at a stride, with short indices', () => {
  const { positions, indices } = sheet(5, 0);
  const wide = new Float32Array((positions.length / 3) * 8 - 5);
  for (let v = 0; v < positions.length / 3; ++v) wide.set(positions.subarray(3 * v, 3 * v + 3), 8 * v);
  const facts = meshbound.describe({ positions: wide, stride: 8, indices: Uint16Array.from(indices) });
  assert.deepEqual({ ...facts, bboxDiagonal: 0 }, { vertices: 25, triangles: 32, components: 1, closed: false, bboxDiagonal: 0 });
  assert.equal(facts.bboxDiagonal, Math.hypot(4, 4));
});

test('a simplified mesh keeps its tolerance at every level', () => {
  const original = sheet(40, 3);
  const { levels, level } = meshbound.simplify(original, { tolerance: 0.2, levels: [0.05], certificate: true });
  assert.equal(levels.length, 2);
  assert.ok(level.indices.length < levels[0].indices.length);
  for (const one of levels) {
    assert.equal(one.verdict, 'within');
    assert.ok(one.distance.upper <= one.tolerance);
    assert.equal(meshbound.check(original, one, one.tolerance).verdict, 'within');
    assert.equal(one.sourceVertices.length * 3, one.positions.length);
    assert.ok(one.certificate.length > 0);
  }
  const subset = meshbound.simplify(original, { tolerance: 0.2, placement: 'subset' }).level;
  subset.sourceVertices.forEach((v, i) => assert.equal(subset.positions[3 * i], original.positions[3 * v]));
  const lines = meshbound.simplify(original, { tolerance: 0.2, lineTolerance: 0.01 }).level;
  assert.ok(lines.lineDistance.upper <= 0.01);
  assert.equal(meshbound.simplify(original, { tolerance: 9, targetFaces: 100 }).level.endedBy, 'target');
  const locked = meshbound.simplify(original, { tolerance: 9, lockedVertices: new Uint8Array(1600).fill(1) }).level;
  assert.equal(locked.indices.length, original.indices.length);
  const turned = original.indices.slice();
  for (let t = 0; t < turned.length / 3; t += 10) [turned[3 * t], turned[3 * t + 1]] = [turned[3 * t + 1], turned[3 * t]];
  const someTurned = { positions: original.positions, indices: turned };
  assert.ok(meshbound.simplify(someTurned, { tolerance: 0.2 }).level.turnedFaces > 0);
  assert.equal(meshbound.simplify(someTurned, { tolerance: 0.2, keepSides: true }).level.turnedFaces, 0);
});

test('what is no mesh and no option is refused', () => {
  const { positions, indices } = sheet(4, 0);
  const refused = (mesh, reason) => assert.throws(() => meshbound.describe(mesh), (error) => {
    assert.ok(error instanceof meshbound.InvalidInput);
    assert.match(error.message, reason);
    return true;
  });
  refused({ positions: [...positions], indices }, /Float32Array/);
  refused({ positions, indices: [...indices] }, /Uint32Array/);
  refused({ positions, indices: indices.subarray(1) }, /multiple of three/);
  refused({ positions, indices: indices.map((v) => v + 10) }, /there are only 16/);
  refused({ positions: positions.map((x, i) => (i === 15 ? NaN : x)), indices }, /vertex 5/);
  refused({ positions, indices, stride: 2 }, /stride/);
  refused({ positions, indices: new Uint32Array() }, /no triangles/);
  assert.throws(() => meshbound.simplify({ positions, indices }, {}), /tolerance/);
  assert.throws(() => meshbound.simplify({ positions, indices }, { tolerance: 1, effort: 'fast' }), /effort/);
  assert.throws(() => meshbound.simplify({ positions, indices }, { tolerance: 1, lockedVertices: [1] }), /each vertex/);
});

test('numbers that an option cannot have are refused, not taken for none', () => {
  const mesh = sheet(4, 0);
  const simplifies = (options) => meshbound.simplify(mesh, { tolerance: 1, ...options });
  const measures = (options) => meshbound.hausdorffDistance(mesh, mesh, options);
  const decides = (options) => meshbound.check(mesh, mesh, 1, options);
  const certifies = (options) => meshbound.buildCertificate(mesh, mesh, 1, options);
  for (const [call, name, values] of [
    [simplifies, 'lineTolerance', [-0.1, NaN, '0.1']],
    [simplifies, 'featureAngle', [-1, NaN]],
    [simplifies, 'targetRatio', [-0.5, NaN]],
    [simplifies, 'targetFaces', [-1, NaN, 10.5, Infinity, 2 ** 32]],
    [simplifies, 'timeLimit', [-1, NaN]],
    [simplifies, 'levels', [5, '0.01', [NaN], [-1], ['0.1'], [true], [null]]],
    [simplifies, 'lockedVertices', [0, NaN, 16, true, '1111111111111111']],
    [simplifies, 'prune', [1, 'no']],
    [simplifies, 'preserveBoundary', [0, 'no']],
    [simplifies, 'certificate', [1, 'no']],
    [simplifies, 'featureEdges', [5, '01', [0, 1, 2], [[0, 1], [1, 2]], [0, -1], [0, 0.5], [0, 2 ** 32 + 1]]],
    [measures, 'errorBound', [-1, NaN, '1']],
    [measures, 'tolerance', [-5, NaN]],
    [measures, 'timeLimit', [-1, NaN]],
    [measures, 'oneSided', [1, 'no']],
    [decides, 'oneSided', [1, 'no']],
    [decides, 'timeLimit', [-1, NaN]],
    [certifies, 'timeLimit', [-1, NaN]],
  ]) {
    for (const value of values) {
      const isRefusal = (error) =>
        error instanceof meshbound.InvalidInput && error.message.startsWith(`${name} must be`);
      assert.throws(() => call({ [name]: value }), isRefusal, `${name}: ${value}`);
    }
    for (const none of [undefined, null]) call({ [name]: none });
  }
  assert.equal(simplifies({ levels: new Set([0.1, 0.5]) }).levels.length, 3);
  assert.throws(() => simplifies({ featureEdges: [0, 16] }), meshbound.InvalidInput);
  assert.equal(simplifies({ featureEdges: [0, 1, 1, 2] }).level.verdict, 'within');
});

test('a tolerance must be given, as a number', () => {
  const mesh = sheet(4, 0);
  for (const tolerance of [undefined, null, true, '1', NaN, -1, 1n])
    for (const call of [
      () => meshbound.check(mesh, mesh, tolerance),
      () => meshbound.buildCertificate(mesh, mesh, tolerance),
      () => meshbound.simplify(mesh, { tolerance }),
    ])
      assert.throws(call, (error) => error instanceof meshbound.InvalidInput && /^tolerance must be/.test(error.message));
});

test('options that do not exist are named', () => {
  const mesh = sheet(4, 0);
  for (const call of [
    (options) => meshbound.simplify(mesh, { tolerance: 1, ...options }),
    (options) => meshbound.hausdorffDistance(mesh, mesh, options),
    (options) => meshbound.check(mesh, mesh, 1, options),
    (options) => meshbound.buildCertificate(mesh, mesh, 1, options),
    (options) => meshbound.writeMesh(mesh, 'ply', options),
  ])
    assert.throws(() => call({ faceTolerances: [1] }), (error) =>
      error instanceof meshbound.InvalidInput && /no option faceTolerances: .*(timeLimit|precision)/.test(error.message));
  for (const options of [null, 5, 'single'])
    assert.throws(() => meshbound.hausdorffDistance(mesh, mesh, options), /^Error: options must be an object/);
  assert.throws(() => meshbound.simplify(mesh), /tolerance must be given/);
});

/** A sheet that is cut into two charts: vertices along the cut are there twice. */
function cutSheet(side) {
  const { positions, indices } = sheet(side, 2);
  const column = Math.floor(side / 2);
  const all = Array.from(positions);
  const copy = new Map();
  const cut = indices.map((v, i) => {
    const corners = indices.subarray(i - (i % 3), i - (i % 3) + 3);
    const isRight = corners.some((c) => c % side > column);
    if (v % side !== column || !isRight) return v;
    if (!copy.has(v)) {
      copy.set(v, all.length / 3);
      all.push(...positions.subarray(3 * v, 3 * v + 3));
    }
    return copy.get(v);
  });
  return { positions: Float32Array.from(all), indices: cut, column, side, copies: copy.size };
}

test('it stands in for MeshoptSimplifier', async () => {
  const { MeshboundSimplifier } = meshbound;
  await MeshboundSimplifier.ready;
  const mesh = cutSheet(40);
  const scale = MeshboundSimplifier.getScale(mesh.positions, 3);
  assert.equal(scale, 39);
  const [indices, error] = MeshboundSimplifier.simplify(mesh.indices, mesh.positions, 3, 0, 0.005);
  assert.ok(indices instanceof Uint32Array);
  assert.ok(indices.length > 0 && indices.length < mesh.indices.length / 4);
  assert.ok(error <= 0.005);
  const distance = meshbound.hausdorffDistance(mesh, { positions: mesh.positions, indices });
  assert.ok(distance.lower <= error * scale);

  // Every triangle lies in one chart, and both charts have the same positions along the cut.
  const x = (v) => mesh.positions[3 * v];
  const along = [new Set(), new Set()];
  for (let i = 0; i < indices.length; i += 3) {
    const corners = Array.from(indices.subarray(i, i + 3));
    const isRight = corners.some((v) => x(v) > mesh.column);
    const isLeft = corners.some((v) => x(v) < mesh.column);
    assert.ok(isLeft !== isRight, 'a triangle crosses the cut');
    for (const v of corners.filter((c) => x(c) === mesh.column)) {
      assert.equal(v >= mesh.side * mesh.side, isRight, 'a corner has the copy of the other side');
      along[isRight ? 1 : 0].add(mesh.positions[3 * v + 1]);
    }
  }
  assert.deepEqual([...along[0]].sort(), [...along[1]].sort());

  const [half] = MeshboundSimplifier.simplify(mesh.indices, mesh.positions, 3, mesh.indices.length / 2, 1);
  assert.ok(half.length <= mesh.indices.length / 2 + 6);
  const [, absolute] = MeshboundSimplifier.simplify(mesh.indices, mesh.positions, 3, 0, 0.1, ['ErrorAbsolute']);
  assert.ok(absolute > 0.005 && absolute <= 0.1);
  assert.throws(() => MeshboundSimplifier.simplify(mesh.indices, mesh.positions, 3, 0, 0.1, ['Sloppy']), RangeError);
});

test('the error times the scale is not below what is proven', () => {
  const { MeshboundSimplifier } = meshbound;
  const { positions, indices } = sheet(12, 2);
  for (let i = 0; i < 20; ++i) {
    const stretched = positions.map((x) => x * (3 + i / 7));
    const target = 0.01 + i * 0.002;
    const scale = MeshboundSimplifier.getScale(stretched, 3);
    const [, error] = MeshboundSimplifier.simplify(indices, stretched, 3, 0, target);
    // The same run, whose bound is given in the unit of the mesh.
    const tolerance = target * scale * (1 - 4 * Number.EPSILON);
    const [, upper] = MeshboundSimplifier.simplify(indices, stretched, 3, 0, tolerance, ['ErrorAbsolute']);
    assert.ok(error * scale >= upper, `${error} * ${scale} < ${upper}`);
    assert.ok(error <= target);
  }
});

test('what is no mesh is refused in place of MeshoptSimplifier', () => {
  const { positions, indices } = sheet(6, 1);
  const refused = (changed, at, reason) => assert.throws(
    () => meshbound.MeshboundSimplifier.simplify(changed, at, 3, 0, 0.01),
    (error) => error instanceof meshbound.InvalidInput && reason.test(error.message));
  refused(indices.map((v, i) => (i === 5 ? 99999 : v)), positions, /no vertex 99999 for index 5: there are only 36/);
  refused(indices.subarray(1), positions, /multiple of three/);
  for (const stride of [0, 2, 3.5, NaN, undefined]) {
    const { simplify, getScale } = meshbound.MeshboundSimplifier;
    for (const flags of [[], ['ErrorAbsolute']])
      assert.throws(() => simplify(indices, positions, stride, 0, 0.01, flags), /stride must be/);
    assert.throws(() => getScale(positions, stride), /stride must be/);
  }
  refused(indices, Float64Array.from(positions, (x) => x + 0.1), /Float32Array/);
});
