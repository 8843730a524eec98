// SPDX-License-Identifier: MIT
// meshbound in JavaScript: certified Hausdorff distances between triangle meshes, and simplification with a proven
// bound. The engine is WebAssembly on one thread; index.d.ts documents every function.
import createEngine from './engine.js';
import {
  arrayLike, chosen, flag, InvalidInput, isNotNegative, length, levelsOf, number, requiredTolerance, requireKnown,
  requireStride, timeLimitOf,
} from './options.js';

const OUTCOMES = ['converged', 'exceeds', 'budget', 'precision', 'not_searched'];
const VERDICTS = ['within', 'exceeds', 'undecided'];
const ENDS = ['nothing_fits', 'target', 'tolerance', 'time_limit', 'rounding'];
const FORMATS = ['off', 'obj', 'ply', 'stl', 'glb', 'gltf'];
const DIRECTION_SIZE = 11;
const DISTANCE_SIZE = 2 + 2 * DIRECTION_SIZE;
const LEVEL_SIZE = 14 + DISTANCE_SIZE;

let engine;

/** In Node the engine is read from its file; in a page it is fetched from where this module came from. */
async function loadEngine() {
  if (typeof process !== 'object' || !process.versions?.node) return createEngine();
  const { readFile } = await import(/* webpackIgnore: true */ 'node:fs/promises');
  return createEngine({ wasmBinary: await readFile(new URL('engine.wasm', import.meta.url)) });
}

/** Resolves when the functions may be called. */
export const ready = loadEngine().then((loaded) => {
  engine = loaded;
});

/** An address that a function of the engine returned: WebAssembly's numbers are signed, negative from 2 GB on. */
const addressOf = (signed) => signed >>> 0;

/** The number of vertices of a mesh; the last one need not fill its stride. */
const vertexCount = ({ positions, stride = 3 }) => Math.floor((positions.length + stride - 3) / stride);

/** Memory of the engine that is freed when `use` has returned. */
class Scratch {
  #addresses = [];

  static with(use) {
    if (!engine) throw new Error('meshbound is not loaded yet: await ready first');
    const scratch = new Scratch();
    try {
      return use(scratch);
    } finally {
      for (const free of scratch.#addresses.reverse()) free();
    }
  }

  room(bytes) {
    const address = addressOf(engine._malloc(Math.max(bytes, 8)));
    if (!address) throw new RangeError('meshbound has run out of memory');
    this.#addresses.push(() => engine._free(address));
    return address;
  }

  copy(array) {
    const address = this.room(array.byteLength);
    engine.HEAPU8.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), address);
    return address;
  }

  mesh(given) {
    const { positions, indices, stride = 3 } = given;
    if (!(positions instanceof Float32Array || positions instanceof Float64Array))
      throw new InvalidInput('positions must be a Float32Array or a Float64Array');
    if (!(indices instanceof Uint16Array || indices instanceof Uint32Array))
      throw new InvalidInput('indices must be a Uint16Array or a Uint32Array');
    requireStride(stride);
    if (indices.length % 3 !== 0) throw new InvalidInput('the number of indices must be a multiple of three');
    const mesh = addressOf(engine._js_mesh_new(
      this.copy(positions), positions instanceof Float64Array ? 1 : 0, stride * positions.BYTES_PER_ELEMENT,
      vertexCount(given), this.copy(indices), indices instanceof Uint32Array ? 1 : 0, indices.length / 3));
    this.#addresses.push(() => engine._js_mesh_free(mesh));
    return mesh;
  }

  simplifyOptions() {
    const options = addressOf(engine._js_simplify_options_new());
    this.#addresses.push(() => engine._js_simplify_options_free(options));
    return options;
  }

  freeAtEnd(free, address) {
    this.#addresses.push(() => free(address));
  }
}

const words = (address, count) => engine.HEAPU32.slice(address / 4, address / 4 + count);
const doubles = (address, count) => engine.HEAPF64.slice(address / 8, address / 8 + count);

function requireSuccess(status) {
  if (status === 0) return;
  const message = engine.UTF8ToString(addressOf(engine._mb_error_message()));
  if (status === 1) throw new InvalidInput(message);
  throw status === 3 ? new RangeError(`meshbound has run out of memory: ${message}`) : new Error(message);
}

function pointFrom(values) {
  return { position: Array.from(values.subarray(0, 3)), triangle: values[3] };
}

function directionFrom(values) {
  const outcome = OUTCOMES[values[10]];
  const bounds = { lower: values[0], upper: values[1], outcome };
  if (outcome === 'not_searched') return bounds;
  return { ...bounds, from: pointFrom(values.subarray(2, 6)), nearest: pointFrom(values.subarray(6, 10)) };
}

function distanceFrom(values) {
  return {
    lower: values[0],
    upper: values[1],
    aToB: directionFrom(values.subarray(2, 2 + DIRECTION_SIZE)),
    bToA: directionFrom(values.subarray(2 + DIRECTION_SIZE, DISTANCE_SIZE)),
  };
}

export function describe(mesh) {
  return Scratch.with((scratch) => {
    const out = scratch.room(5 * 8);
    requireSuccess(engine._js_describe(scratch.mesh(mesh), out));
    const [vertices, triangles, components, closed, bboxDiagonal] = doubles(out, 5);
    return { vertices, triangles, components, closed: closed === 1, bboxDiagonal };
  });
}

export function hausdorffDistance(a, b, options = {}) {
  requireKnown(options, ['errorBound', 'tolerance', 'oneSided', 'timeLimit']);
  return Scratch.with((scratch) => {
    const out = scratch.room(DISTANCE_SIZE * 8);
    requireSuccess(engine._js_measure(
      scratch.mesh(a), scratch.mesh(b), length(options, 'errorBound'), length(options, 'tolerance'),
      timeLimitOf(options), flag(options, 'oneSided'), out));
    return distanceFrom(doubles(out, DISTANCE_SIZE));
  });
}

export function check(a, b, tolerance, options = {}) {
  requireKnown(options, ['oneSided', 'timeLimit']);
  return Scratch.with((scratch) => {
    const out = scratch.room((1 + DISTANCE_SIZE) * 8);
    requireSuccess(engine._js_check(
      scratch.mesh(a), scratch.mesh(b), requiredTolerance({ tolerance }), timeLimitOf(options),
      flag(options, 'oneSided'), out));
    const values = doubles(out, 1 + DISTANCE_SIZE);
    return { verdict: VERDICTS[values[0]], tolerance, distance: distanceFrom(values.subarray(1)) };
  });
}

export function buildCertificate(original, simplified, tolerance, options = {}) {
  requireKnown(options, ['timeLimit']);
  return Scratch.with((scratch) => {
    const certificate = scratch.room(4);
    const out = scratch.room(2 * 8);
    requireSuccess(engine._js_certify(
      scratch.mesh(original), scratch.mesh(simplified), requiredTolerance({ tolerance }), timeLimitOf(options),
      certificate, out));
    scratch.freeAtEnd(engine._mb_certificate_free, engine.HEAPU32[certificate / 4]);
    const [address, size] = doubles(out, 2);
    return engine.HEAPU8.slice(address, address + size);
  });
}

/** A name in the memory of the engine for a file of this format, which is gone when `use` has returned. */
function withFile(format, use) {
  if (!FORMATS.includes(format)) throw new InvalidInput(`the format must be one of: ${FORMATS.join(', ')}`);
  return Scratch.with((scratch) => {
    const name = `mesh.${format}`;
    try {
      return use(scratch, name, scratch.copy(new TextEncoder().encode(`${name}\0`)));
    } finally {
      if (engine.FS.analyzePath(name).exists) engine.FS.unlink(name);
    }
  });
}

export function readMesh(bytes, format) {
  return withFile(format, (scratch, name, address) => {
    engine.FS.writeFile(name, bytes instanceof ArrayBuffer ? new Uint8Array(bytes) : bytes);
    const file = scratch.room(4);
    const out = scratch.room(4 * 8);
    requireSuccess(engine._js_read(address, file, out));
    scratch.freeAtEnd(engine._mb_mesh_file_free, engine.HEAPU32[file / 4]);
    const [vertices, triangles, positions, indices] = doubles(out, 4);
    return { positions: doubles(positions, 3 * vertices), indices: words(indices, 3 * triangles) };
  });
}

export function writeMesh(mesh, format, options = {}) {
  requireKnown(options, ['precision']);
  return withFile(format, (scratch, name, address) => {
    const single = chosen(options, 'precision', ['double', 'single']);
    requireSuccess(engine._js_write(address, scratch.mesh(mesh), single));
    return engine.FS.readFile(name);
  });
}

function levelFrom(scratch, simplification, index) {
  const out = scratch.room(LEVEL_SIZE * 8);
  requireSuccess(engine._js_level(simplification, index, out));
  const values = doubles(out, LEVEL_SIZE);
  const [tolerance, verdict, endedBy, vertices, triangles, positions, indices, sourceVertices, sourceTriangles] = values;
  if (!(triangles > 0)) throw new Error('internal error: the engine returned a level without triangles');
  const [certificate, certificateSize, lineLower, lineUpper, turnedFaces] = values.subarray(9);
  return {
    tolerance,
    verdict: VERDICTS[verdict],
    endedBy: ENDS[endedBy],
    positions: doubles(positions, 3 * vertices),
    indices: words(indices, 3 * triangles),
    sourceVertices: words(sourceVertices, vertices),
    sourceTriangles: words(sourceTriangles, triangles),
    turnedFaces,
    certificate: certificate === 0 ? null : engine.HEAPU8.slice(certificate, certificate + certificateSize),
    lineDistance: Number.isNaN(lineUpper) ? null : { lower: lineLower, upper: lineUpper },
    distance: distanceFrom(values.subarray(14)),
  };
}

const SIMPLIFY_OPTIONS = [
  'tolerance', 'levels', 'targetFaces', 'targetRatio', 'effort', 'placement', 'precision', 'onExceed', 'prune',
  'preserveBoundary', 'keepSides', 'lockedVertices', 'featureAngle', 'lineTolerance', 'featureEdges', 'certificate', 'timeLimit',
];
const isCount = (x) => Number.isInteger(x) && x >= 0 && x < 2 ** 32 - 1;

/** A byte for each vertex; 0, no address, where no vertex is locked. */
function copyLocks(scratch, lockedVertices) {
  if (lockedVertices === null) return 0;
  return scratch.copy(Uint8Array.from(lockedVertices, (locked) => (locked ? 1 : 0)));
}

/** Pairs of vertices as the engine reads them. */
function copyEdges(scratch, featureEdges) {
  const isIndex = (v) => Number.isInteger(v) && v >= 0 && v < 2 ** 32;
  if (featureEdges.length % 2 !== 0 || !Array.from(featureEdges).every(isIndex))
    throw new InvalidInput('featureEdges must be indices of vertices, two for each edge, one after the other');
  return scratch.copy(Uint32Array.from(featureEdges));
}

function setOptions(scratch, options, target) {
  const featureEdges = arrayLike(options, 'featureEdges') ?? [], levels = levelsOf(options);
  engine._js_set_lengths(
    target, requiredTolerance(options), length(options, 'lineTolerance'),
    number(options, 'featureAngle', -1, isNotNegative, 'an angle in radians, 0 to pi'), timeLimitOf(options));
  engine._js_set_targets(
    target, number(options, 'targetFaces', -1, isCount, 'a whole number, 0 or more'),
    number(options, 'targetRatio', -1, isNotNegative, 'a share, 0 to 1'));
  engine._js_set_choices(
    target, chosen(options, 'effort', ['normal', 'high']), chosen(options, 'placement', ['optimal', 'subset']),
    chosen(options, 'precision', ['double', 'single']), chosen(options, 'onExceed', ['skip', 'stop']),
    flag(options, 'prune'), flag(options, 'preserveBoundary'), flag(options, 'keepSides'), flag(options, 'certificate'));
  engine._js_set_arrays(
    target, scratch.copy(levels), levels.length, copyLocks(scratch, arrayLike(options, 'lockedVertices')),
    copyEdges(scratch, featureEdges), featureEdges.length / 2);
}

export function simplify(mesh, options = {}) {
  requireKnown(options, SIMPLIFY_OPTIONS);
  return Scratch.with((scratch) => {
    const target = scratch.simplifyOptions();
    setOptions(scratch, options, target);
    const original = scratch.mesh(mesh);
    if ((options.lockedVertices ?? null) !== null && options.lockedVertices.length !== vertexCount(mesh))
      throw new InvalidInput('lockedVertices must have a value for each vertex');
    const result = scratch.room(4);
    requireSuccess(engine._js_simplify(original, target, result));
    const simplification = engine.HEAPU32[result / 4];
    scratch.freeAtEnd(engine._mb_simplification_free, simplification);
    const count = engine._mb_simplification_level_count(simplification);
    const levels = Array.from({ length: count }, (_, index) => levelFrom(scratch, simplification, index));
    return { levels, level: levels[count - 1] };
  });
}

export { InvalidInput } from './options.js';
export { MeshboundSimplifier } from './simplifier.js';
