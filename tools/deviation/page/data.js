// SPDX-License-Identifier: MIT
// The two documents inside the page, and one view of them for both tools.

const read = (id) => JSON.parse(document.getElementById(id).textContent);

/** The document as `--json` writes it. */
export const document_ = read('document');

/** What is drawn: meshes, scale, colours, names. */
export const scene = read('scene');

const isSimplify = document_.schema.startsWith('meshbound/simplify/');

const first = isSimplify ? 'original_to_simplified' : 'a_to_b';
const second = isSimplify ? 'simplified_to_original' : 'b_to_a';

/** "original to simplified": from the first mesh to the second; and the other way round. */
export const directions = [first, second].map((key) => ({
  key,
  name: key.replaceAll('_', ' ').replace(/^a to b$/, 'A to B').replace(/^b to a$/, 'B to A'),
  distance: document_.distance[key],
  statistics: document_.deviation?.[key],
}));

export const meshNames = isSimplify ? ['original', 'simplified'] : ['A', 'B'];
export const meshReports = isSimplify ? [document_.original, document_.simplified] : [document_.a, document_.b];

/** Levels from the finest on, the result last; empty where there is none but the result. */
export const levels = (isSimplify && document_.levels.length > 0)
  ? [...document_.levels.map((level) => ({
      faces: level.faces, tolerance: level.tolerance, distance: level.distance, path: level.path })),
    { faces: document_.simplified.faces, tolerance: document_.tolerance.absolute, distance: document_.distance,
      path: document_.simplified.path }]
  : [];

/** The view has each level, or where there are too many the result alone. */
export const showsLevels = scene.meshes.filter((mesh) => mesh.role === 'second').length === levels.length;

const unit = scene.unit ? ` ${scene.unit}` : '';

/** Six digits and the unit. */
export const short = (value) => (value === null || value === undefined ? 'unknown' : `${Number(value.toPrecision(6))}${unit}`);

/** All digits: what reads back as the number of the document. */
export const exact = (bounds) =>
  (bounds.upper === null ? `at least ${bounds.lower}${unit}` : `[${bounds.lower}, ${bounds.upper}]${unit}`);

/** An array that the page holds in base64, little-endian. */
export function decoded(text, Type) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Type(bytes.buffer);
}
