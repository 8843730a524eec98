// SPDX-License-Identifier: MIT
// Mesh files and certificates of the npm package are those of the native tools, byte for byte. Environment:
// MESHBOUND_NPM is the folder of the package; MESHBOUND_TOOLS and MESHBOUND_GENERATOR are the native tools, without
// which most of this is skipped.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const meshbound = await import(pathToFileURL(join(process.env.MESHBOUND_NPM, 'meshbound.js')).href);
before(() => meshbound.ready);

const folder = mkdtempSync(join(tmpdir(), 'meshbound-js-'));
after(() => rmSync(folder, { recursive: true }));

const { MESHBOUND_TOOLS: tools, MESHBOUND_GENERATOR: generator } = process.env;
const native = { skip: !tools && 'no native tools' };
const formats = ['off', 'obj', 'ply', 'stl', 'glb', 'gltf'];

/** The path of a mesh of known shape, written by the native generator. */
function generated(kind, size, format) {
  const path = join(folder, `${kind}-${size}.${format}`);
  execFileSync(generator, [kind, '--size', String(size), '-o', path]);
  return path;
}

const tool = (name, ...options) => execFileSync(join(tools, name), options);

test('files of every format are those of the native writer, byte for byte', native, () => {
  const mesh = meshbound.readMesh(readFileSync(generated('terrain', 2000, 'ply')), 'ply');
  for (const format of formats.filter((each) => each !== 'gltf'))
    assert.deepEqual(
      Buffer.from(meshbound.writeMesh(mesh, format)), readFileSync(generated('terrain', 2000, format)), format);
});

test('numbers in text have the digits of the native writer', native, () => {
  const numbers = [
    5e-324, 2.2250738585072014e-308, 2 ** -44, 9007199254740993, 123456789012345680, 1e22, 1.5e22, 1e5, 100001, 1e6, 123456.5,
    1e-4, 1.5e-4, 1.25e-5, 1e-5, 0.1, 1 / 3, 2 / 3e9, 7e17, 1e100, 2 ** 70, 2 ** 53, 4503599627370497.5, 1e-7, 12345e-12];
  for (let i = 0, bits = 1; i < 200; ++i) {
    bits = (bits * 48271) % 0x7fffffff;
    numbers.push((bits / 0x7fffffff - 0.5) * 10 ** ((bits % 40) - 20));
  }
  const lines = numbers.map((x, i) => `${x} ${-i} ${i % 7}`);
  const faces = numbers.map((_, i) => `3 ${i} ${(i + 1) % numbers.length} ${(i + 2) % numbers.length}`);
  const path = join(folder, 'numbers.off');
  writeFileSync(path, `OFF\n${numbers.length} ${faces.length} 0\n${lines.join('\n')}\n${faces.join('\n')}\n`);
  const written = join(folder, 'written.off');
  tool('simplify_with_bound', path, written, '--tolerance', '0', '--quiet', '--target-faces', String(faces.length));
  const ours = meshbound.writeMesh(meshbound.readMesh(readFileSync(path), 'off'), 'off');
  assert.equal(Buffer.from(ours).toString(), readFileSync(written, 'utf8'));
});

test('a mesh survives every format as far as the format holds it', () => {
  const positions = Float64Array.from([0, 0, 0, 1 / 3, 0, 0, 0, Math.PI, 1e-30, -5e-324, 1e22, 7]);
  const mesh = { positions, indices: Uint32Array.from([0, 1, 2, 0, 2, 3]) };
  for (const format of formats) {
    const isSingle = !['off', 'obj', 'ply'].includes(format);
    const read = meshbound.readMesh(meshbound.writeMesh(mesh, format), format);
    assert.deepEqual(read.indices, mesh.indices, format);
    assert.deepEqual(read.positions, isSingle ? positions.map(Math.fround) : positions, format);
    const single = meshbound.readMesh(meshbound.writeMesh(mesh, format, { precision: 'single' }), format);
    assert.deepEqual(single.positions, positions.map(Math.fround), format);
  }
});

test('certificates are those of the native tool, and it accepts them', native, () => {
  const paths = [generated('torus', 2000, 'ply'), generated('torus', 4000, 'ply')];
  const [a, b] = paths.map((path) => meshbound.readMesh(readFileSync(path), 'ply'));
  const tolerance = 1.01 * meshbound.hausdorffDistance(a, b).upper;
  const [ours, theirs] = ['ours.cert', 'theirs.cert'].map((name) => join(folder, name));
  writeFileSync(ours, meshbound.buildCertificate(a, b, tolerance));
  tool('hausdorff_distance', ...paths, '--tolerance', String(tolerance), '--certificate', theirs, '--quiet');
  assert.deepEqual(readFileSync(ours), readFileSync(theirs));
  tool('verify_certificate', ...paths, ours, '--quiet');
  assert.throws(() => meshbound.buildCertificate(a, b, tolerance / 2));
  assert.throws(() => meshbound.buildCertificate(a, b, tolerance, { timeLimit: 0 }), /time limit/);
});

test('a measurement with a tolerance decides it', native, () => {
  const paths = [generated('torus', 2000, 'ply'), generated('terrain', 2000, 'ply')];
  const [a, b] = paths.map((path) => meshbound.readMesh(readFileSync(path), 'ply'));
  const { upper } = meshbound.hausdorffDistance(a, b, { errorBound: 1e-9 });
  const ours = meshbound.hausdorffDistance(a, b, { errorBound: 0.3, tolerance: 1.000001 * upper });
  assert.ok(ours.upper <= 1.000001 * upper);
  const theirs = JSON.parse(tool('hausdorff_distance', ...paths, '--tolerance', String(1.000001 * upper),
    '--error-bound', '0.3', '--json')).distance;
  assert.deepEqual([ours.lower, ours.upper], [theirs.lower, theirs.upper]);
});

test('what is no file of the format is refused in one line', () => {
  const refused = (text, format, reason) =>
    assert.throws(() => meshbound.readMesh(new TextEncoder().encode(text), format), (error) => {
      assert.ok(error instanceof meshbound.InvalidInput);
      assert.match(error.message, reason);
      assert.ok(!error.message.includes('\n'));
      return true;
    });
  refused('', 'ply', /mesh\.ply: the file is empty/);
  refused('OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n', 'off', /mesh\.off: line 5/);
  refused('solid', 'blend', /format must be one of/);
  assert.throws(() => meshbound.writeMesh({ positions: new Float64Array(9), indices: new Uint32Array(3) }, 'x3d'), /one of/);
  assert.throws(() => meshbound.hausdorffDistance(
    { positions: new Float64Array(9), indices: new Uint32Array(3) },
    { positions: new Float64Array(9), indices: new Uint32Array(3) }, { tolerance: NaN }), /tolerance/);
});
