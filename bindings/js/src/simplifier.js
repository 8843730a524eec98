// SPDX-License-Identifier: MIT
// What stands in for MeshoptSimplifier, for instance in simplify() of gltf-transform: the same arguments, with a bound
// that is proven.
import { ready, simplify } from './meshbound.js';
import { InvalidInput, requireStride } from './options.js';

/** Positions where vertices stand, one vertex for each: copies of a vertex along a seam become one. */
function weld(positions, stride) {
  requireStride(stride);
  const count = Math.floor((positions.length + stride - 3) / stride);
  const bits = new Uint32Array(3 * count);
  const packed = new Float32Array(bits.buffer);
  for (let v = 0; v < count; ++v)
    for (let k = 0; k < 3; ++k) packed[3 * v + k] = positions[v * stride + k] + 0; // -0 is 0
  const isRounded = (x, i) => !Number.isNaN(x) && x !== positions[Math.floor(i / 3) * stride + (i % 3)];
  if (packed.some(isRounded))
    throw new InvalidInput('positions must be numbers that a Float32Array can hold');
  const welded = new Uint32Array(count);
  const first = new Map();
  for (let v = 0; v < count; ++v) {
    const key = `${bits[3 * v]},${bits[3 * v + 1]},${bits[3 * v + 2]}`;
    if (!first.has(key)) first.set(key, v);
    welded[v] = first.get(key);
  }
  return { positions: packed, welded };
}

/** The indices of the welded vertices. */
function weldedIndices(indices, welded) {
  const outside = indices.findIndex((v) => welded[v] === undefined);
  if (outside !== -1)
    throw new InvalidInput(
      `there is no vertex ${indices[outside]} for index ${outside}: there are only ${welded.length}`);
  return Uint32Array.from(indices, (v) => welded[v]);
}

/** Pairs of welded vertices whose edge has different copies on its two sides: vertices there move along the seam only. */
function seamEdges(indices, welded) {
  const copies = new Map();
  const seams = [];
  for (let i = 0; i < indices.length; ++i) {
    const next = i % 3 === 2 ? i - 2 : i + 1;
    const [a, b] = [indices[i], indices[next]];
    const [wa, wb] = [welded[a], welded[b]];
    const key = wa < wb ? `${wa},${wb}` : `${wb},${wa}`;
    const ends = wa < wb ? `${a},${b}` : `${b},${a}`;
    if (!copies.has(key)) copies.set(key, ends);
    else if (copies.get(key) !== ends) seams.push(wa, wb);
  }
  return seams;
}

/** By vertex: the number of its chart, vertices of one triangle having the same. */
function charts(indices, vertexCount) {
  const parent = Uint32Array.from({ length: vertexCount }, (_, v) => v);
  const root = (v) => {
    while (parent[v] !== v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (let i = 0; i < indices.length; i += 3)
    for (const k of [1, 2]) parent[root(indices[i + k])] = root(indices[i]);
  return parent.map((_, v) => root(v));
}

/** By welded vertex that has several: its copies. */
function copiesOf(indices, welded) {
  const copies = new Map();
  for (const v of new Set(indices)) {
    if (!copies.has(welded[v])) copies.set(welded[v], []);
    copies.get(welded[v]).push(v);
  }
  return copies;
}

/** Unit normal of the triangle of three vertices. */
function normal(positions, [a, b, c]) {
  const p = (v, k) => positions[3 * v + k];
  const u = [0, 1, 2].map((k) => p(b, k) - p(a, k));
  const w = [0, 1, 2].map((k) => p(c, k) - p(a, k));
  const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
  const length = Math.hypot(...n) || 1;
  return n.map((x) => x / length);
}

/** Chooses among the copies of a vertex that which its side of the seam has. */
class CopyChooser {
  constructor(indices, positions, welded) {
    Object.assign(this, { indices, positions, welded });
    this.copies = copiesOf(indices, welded);
    this.chart = charts(indices, welded.length);
    this.triangles = new Map();
    for (let i = 0; i < indices.length; ++i) {
      if (this.copies.get(welded[indices[i]]).length === 1) continue;
      if (!this.triangles.has(indices[i])) this.triangles.set(indices[i], []);
      this.triangles.get(indices[i]).push(Math.floor(i / 3));
    }
  }

  /** The copy of welded vertex `w` in the chart of triangle `source`; of several there, the one most like `facing`. */
  choose(w, source, facing) {
    const copies = this.copies.get(w);
    if (copies.length === 1) return copies[0];
    const chart = this.chart[this.indices[3 * source]];
    const near = copies.filter((v) => this.chart[v] === chart);
    if (near.length === 1) return near[0];
    let best = copies[0], most = -Infinity;
    for (const v of near.length > 0 ? near : copies) {
      for (const t of this.triangles.get(v)) {
        const n = normal(this.positions, this.indices.subarray(3 * t, 3 * t + 3).map((i) => this.welded[i]));
        const likeness = n[0] * facing[0] + n[1] * facing[1] + n[2] * facing[2];
        if (likeness > most) [best, most] = [v, likeness];
      }
    }
    return best;
  }
}

/** Indices of the original vertices for the triangles of a level of the welded mesh. */
function originalIndices(level, chooser) {
  const result = new Uint32Array(level.indices.length);
  for (let i = 0; i < result.length; i += 3) {
    const corners = level.indices.subarray(i, i + 3).map((v) => level.sourceVertices[v]);
    const facing = normal(chooser.positions, corners);
    for (let k = 0; k < 3; ++k) result[i + k] = chooser.choose(corners[k], level.sourceTriangles[i / 3], facing);
  }
  return result;
}

function largestExtent(positions, stride) {
  requireStride(stride);
  let extent = 0;
  for (let k = 0; k < 3; ++k) {
    let low = Infinity, high = -Infinity;
    for (let i = k; i < positions.length; i += stride) {
      low = Math.min(low, positions[i]);
      high = Math.max(high, positions[i]);
    }
    if (high > low) extent = Math.max(extent, high - low);
  }
  return extent;
}

/** The next larger double of a positive one. */
function nextUp(x) {
  const bits = new BigUint64Array(1);
  const value = new Float64Array(bits.buffer);
  value[0] = x;
  if (x < Infinity) ++bits[0];
  return value[0];
}

/** A share of `scale` that is not below `bound`, in real arithmetic and as a product of doubles. */
function shareOf(bound, scale) {
  if (bound === 0 || scale === 1) return bound;
  return nextUp(bound / scale);
}

export const MeshboundSimplifier = {
  supported: typeof WebAssembly === 'object',
  get ready() {
    return ready;
  },

  getScale: largestExtent,

  simplify(indices, positions, stride, targetIndexCount, targetError, flags = []) {
    const known = ['LockBorder', 'ErrorAbsolute', 'Prune', 'Sparse'];
    const unknown = flags.find((flag) => !known.includes(flag));
    if (unknown !== undefined) throw new RangeError(`the flag ${unknown} is not known`);
    const scale = flags.includes('ErrorAbsolute') ? 1 : largestExtent(positions, stride);
    const { positions: packed, welded } = weld(positions, stride);
    const weldedMesh = { positions: packed, indices: weldedIndices(indices, welded) };
    const seams = seamEdges(indices, welded);
    // Less by a few units of the last place, so that the share of a bound, rounded up, is not above the target.
    const tolerance = scale === 1 ? targetError : targetError * scale * (1 - 4 * Number.EPSILON);
    const { level } = simplify(
      weldedMesh,
      {
        tolerance,
        placement: 'subset',
        precision: 'single',
        targetFaces: Math.floor(targetIndexCount / 3),
        preserveBoundary: flags.includes('LockBorder'),
        prune: flags.includes('Prune'),
        ...(seams.length > 0 ? { featureEdges: seams, lineTolerance: tolerance } : {}),
      });
    const chooser = new CopyChooser(indices, packed, welded);
    return [originalIndices(level, chooser), shareOf(level.distance.upper, scale)];
  },
};
