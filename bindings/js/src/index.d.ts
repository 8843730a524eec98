// SPDX-License-Identifier: MIT
/**
 * Certified Hausdorff distances between triangle meshes, and simplification with a proven bound. For an original A, a
 * simplified mesh M and their symmetric Hausdorff distance H, lower <= H(A, M) <= upper <= tolerance holds in real
 * arithmetic: the rounding errors of the computation are included. Lengths are in the unit of the mesh. Functions may be
 * called once `ready` has resolved; they block until they are done, so call them from a worker in a page.
 */

/** Resolves when the engine is loaded. */
export const ready: Promise<void>;

/** A triangle soup. */
export interface Mesh {
  /** x, y, z of each vertex, `stride` numbers from one to the next. */
  positions: Float32Array | Float64Array;
  /** Three vertices of each triangle. */
  indices: Uint16Array | Uint32Array;
  /** In numbers; 3 where positions are packed, which is the default. */
  stride?: number;
}

/** Thrown for a mesh or an option that no bound can be given for, and for options of another type or name than here. */
export class InvalidInput extends Error {}

export interface MeshFacts {
  vertices: number;
  triangles: number;
  /** Sets of triangles connected through shared vertices. */
  components: number;
  /** Every edge has exactly two triangles. */
  closed: boolean;
  /** Of the bounding box of the vertices that triangles use. */
  bboxDiagonal: number;
}

export interface Bounds {
  /** Never above the distance. */
  lower: number;
  /** Never below the distance; Infinity where nothing is proven. */
  upper: number;
}

export interface SurfacePoint {
  position: [number, number, number];
  triangle: number;
}

/** How far one mesh is from another. `from` and `nearest`, its closest point on the other mesh, realise the lower bound. */
export interface Direction extends Bounds {
  outcome: 'converged' | 'exceeds' | 'budget' | 'precision' | 'not_searched';
  /** Absent where the direction was not searched. */
  from?: SurfacePoint;
  nearest?: SurfacePoint;
}

export interface Distance extends Bounds {
  aToB: Direction;
  bToA: Direction;
}

export interface DistanceOptions {
  /** Wanted width of the interval; default 1e-6 of the diagonal of the first mesh. */
  errorBound?: number;
  /** The upper bound is also refined until it is at most this, wherever the truth allows it. */
  tolerance?: number;
  /** Only from the first mesh to the second. */
  oneSided?: boolean;
  /** Seconds of the search. */
  timeLimit?: number;
}

export interface Check {
  /** "within" only where upper <= tolerance. */
  verdict: 'within' | 'exceeds' | 'undecided';
  tolerance: number;
  /** As narrow as the decision needed. */
  distance: Distance;
}

export interface SimplifyOptions {
  /** Largest symmetric Hausdorff distance to the original. */
  tolerance: number;
  /** Smaller tolerances at which the mesh is handed out as well. */
  levels?: Iterable<number>;
  /** Where to end, if the tolerance allows it. */
  targetFaces?: number;
  /** The same as a share of the triangles, 0 to 1. */
  targetRatio?: number;
  effort?: 'normal' | 'high';
  /** "subset": every vertex of the result is one of the original. */
  placement?: 'optimal' | 'subset';
  /** "single": coordinates are floats, and the bound is that of these. */
  precision?: 'double' | 'single';
  onExceed?: 'skip' | 'stop';
  /** Drop components whose every point is within the tolerance of the rest. */
  prune?: boolean;
  /** Edges with one triangle stay as they are. */
  preserveBoundary?: boolean;
  /**
   * Every triangle shows the side that its original shows, and edges between triangles of opposite winding are lines;
   * otherwise neighbours are turned over until they agree (`Level.turnedFaces`).
   */
  keepSides?: boolean;
  /** By vertex: true keeps it where it is. */
  lockedVertices?: ArrayLike<boolean | number>;
  /** Radians between normals from which on an edge is a crease, which stays as it is. */
  featureAngle?: number;
  /** Borders, creases and `featureEdges` stay within it of where they were, both ways. */
  lineTolerance?: number;
  /** Pairs of vertices whose edges are lines as well, one after the other: [a, b, c, d] are the edges a-b and c-d. */
  featureEdges?: ArrayLike<number>;
  /** Also make the certificate that verify_certificate checks. */
  certificate?: boolean;
  /** Seconds after which decimation ends. */
  timeLimit?: number;
}

export interface Level {
  tolerance: number;
  verdict: 'within' | 'exceeds' | 'undecided';
  endedBy: 'nothing_fits' | 'target' | 'tolerance' | 'time_limit' | 'rounding';
  /** x, y, z of each vertex. */
  positions: Float64Array;
  indices: Uint32Array;
  /** By vertex: the vertex of the original that it comes from. */
  sourceVertices: Uint32Array;
  /** By triangle: one of the triangles of the original that it stands for. */
  sourceTriangles: Uint32Array;
  /** How many triangles face the other way than their source triangle. */
  turnedFaces: number;
  certificate: Uint8Array | null;
  /** Between the feature lines, where there are any. */
  lineDistance: Bounds | null;
  /** From the original (a), measured afresh. */
  distance: Distance;
}

export interface Simplification {
  /** Ascending by tolerance. */
  levels: Level[];
  /** The last one: that of the tolerance itself. */
  level: Level;
}

/** "gltf" is one file whose buffers are data URIs. */
export type Format = 'off' | 'obj' | 'ply' | 'stl' | 'glb' | 'gltf';

/** Facts about a mesh. */
export function describe(mesh: Mesh): MeshFacts;
/** Measures the symmetric Hausdorff distance of two meshes. */
export function hausdorffDistance(a: Mesh, b: Mesh, options?: DistanceOptions): Distance;
/** Decides whether the distance is at most `tolerance`: faster than measuring it. */
export function check(a: Mesh, b: Mesh, tolerance: number, options?: Omit<DistanceOptions, 'errorBound' | 'tolerance'>): Check;
/** Simplifies a mesh while its symmetric Hausdorff distance to the original stays within the tolerance. */
export function simplify(mesh: Mesh, options: SimplifyOptions): Simplification;
/**
 * Proves that two meshes are within a tolerance: the bytes of a file that the tool verify_certificate checks, for files
 * that give back these vertices and triangles. STL and glTF weld and renumber vertices: prove what readMesh gives for
 * them. Throws where the tolerance does not hold, or no proof was found in time.
 */
export function buildCertificate(
  original: Mesh, simplified: Mesh, tolerance: number, options?: { timeLimit?: number }): Uint8Array;
/** The triangles of a mesh file. Polygons are split; of glTF the default scene is read, placed by its nodes. */
export function readMesh(bytes: Uint8Array | ArrayBuffer, format: Format): { positions: Float64Array; indices: Uint32Array };
/**
 * The bytes of a mesh file, which are those that the tools write. STL and glTF hold floats, and other formats do with
 * "single" precision: a bound that is to hold for the file must be one of the mesh as it reads.
 */
export function writeMesh(mesh: Mesh, format: Format, options?: { precision?: 'double' | 'single' }): Uint8Array;

/**
 * Stands in for MeshoptSimplifier, for instance in simplify() of gltf-transform. The error is a proven bound of the
 * symmetric Hausdorff distance, as a share of the largest extent of the mesh (rounded up: error * getScale(positions,
 * stride) is not below the bound), or absolute. Vertices of the result are vertices of the original; copies of a vertex
 * along a seam stay together.
 */
export const MeshboundSimplifier: {
  supported: boolean;
  ready: Promise<void>;
  getScale(positions: Float32Array, stride: number): number;
  simplify(
    indices: Uint16Array | Uint32Array,
    positions: Float32Array,
    stride: number,
    targetIndexCount: number,
    targetError: number,
    flags?: ('LockBorder' | 'ErrorAbsolute' | 'Prune' | 'Sparse')[],
  ): [Uint32Array, number];
};
