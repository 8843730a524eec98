// SPDX-License-Identifier: MIT
// The two documents inside the page, and one view of them for both tools.

/** A JSON document inside the page. */
export const read = (id) => JSON.parse(document.getElementById(id).textContent);

/** The document as `--json` writes it. */
export const document_ = read('document');

/** What is drawn: meshes, scale, colours, names. */
export const scene = read('scene');

const isSimplify = document_.schema.startsWith('meshbound/simplify/');

/** Whether the document is of `lod_chain`. */
export const isChain = document_.schema.startsWith('meshbound/lod/');

/** Of a chain the coarsest level; its distance and tolerance are those at the top of the page. */
const coarsest = isChain ? document_.levels.at(-1) : null;

export const distance = isChain ? coarsest.distance : document_.distance;

/** In model units; undefined where there is none. */
export const tolerance = isChain ? coarsest.tolerance : document_.tolerance?.absolute;

const first = isSimplify || isChain ? 'original_to_simplified' : 'a_to_b';
const second = isSimplify || isChain ? 'simplified_to_original' : 'b_to_a';

/** "original to simplified": from the first mesh to the second; and the other way round. */
export const directions = [first, second].map((key) => ({
  key,
  name: key.replaceAll('_', ' ').replace(/^a to b$/, 'A to B').replace(/^b to a$/, 'B to A'),
  distance: distance[key],
  statistics: document_.deviation?.[key],
}));

/** The two meshes of the 3D view: how they are called there, and what the document says of them. */
export const meshNames = isSimplify || isChain ? ['original', 'simplified'] : ['A', 'B'];
export const meshReports = isSimplify || isChain ? [document_.original, coarsest ?? document_.simplified] : [document_.a, document_.b];

/** The rows of the table of meshes. */
export const files = isChain
  ? [{ name: 'original', mesh: document_.original }, ...document_.levels.map((mesh, i) => ({ name: `level ${i}`, mesh }))]
  : meshNames.map((name, i) => ({ name, mesh: meshReports[i] }));

function levelsOf() {
  const all = (document_.levels ?? []).map((level, i) => ({ ...level, name: `level ${i}` }));
  if (isSimplify && all.length > 0) all.push({ ...document_.simplified, name: 'result', tolerance, distance });
  return all;
}

/** Levels from the finest on, in a document of one result that result last; empty where there is none but the result. */
export const levels = levelsOf();

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
