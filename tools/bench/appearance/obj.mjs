// SPDX-License-Identifier: MIT
// Wavefront OBJ with texture coordinates, normals and materials, as buffers of an engine: a vertex for each combination.
import { readFile, writeFile } from 'node:fs/promises';

/** The mesh of a file: `positions`, `coordinates`, `normals` (numbers per vertex: 3, 2, 3) and `parts` {name, indices}. */
export async function readObj(path) {
  const lists = { v: [], vt: [], vn: [] };
  const mesh = { positions: [], coordinates: [], normals: [], parts: [] };
  const vertexOf = new Map();
  let part;
  const partOf = (name) => {
    part = mesh.parts.find((other) => other.name === name);
    if (!part) mesh.parts.push((part = { name, indices: [] }));
  };
  const vertex = (key) => {
    const known = vertexOf.get(key);
    if (known !== undefined) return known;
    const at = key.split('/').map((text) => Number(text || 0));
    const resolve = (list, index) => list[index < 0 ? list.length + index : index - 1];
    mesh.positions.push(...resolve(lists.v, at[0]).slice(0, 3)); // a colour may follow
    mesh.coordinates.push(...(resolve(lists.vt, at[1] || 0) ?? [0, 0]).slice(0, 2));
    mesh.normals.push(...(resolve(lists.vn, at[2] || 0) ?? [0, 0, 0]));
    vertexOf.set(key, vertexOf.size);
    return vertexOf.size - 1;
  };
  for (const line of (await readFile(path, 'utf8')).split('\n')) {
    const [kind, ...words] = line.trim().split(/\s+/);
    if (kind in lists) lists[kind].push(words.map(Number));
    else if (kind === 'usemtl') partOf(words.join(' '));
    else if (kind === 'f') {
      if (!part) partOf('');
      const corners = words.map(vertex);
      for (let i = 2; i < corners.length; ++i) part.indices.push(corners[0], corners[i - 1], corners[i]);
    }
  }
  return mesh;
}

export async function writeObj(path, mesh) {
  const lines = [];
  const put = (kind, numbers, width) => {
    for (let i = 0; i < numbers.length; i += width) lines.push(`${kind} ${numbers.slice(i, i + width).join(' ')}`);
  };
  put('v', mesh.positions, 3);
  put('vt', mesh.coordinates, 2);
  put('vn', mesh.normals, 3);
  for (const { name, indices } of mesh.parts) {
    if (name) lines.push(`usemtl ${name}`);
    for (let i = 0; i < indices.length; i += 3)
      lines.push(`f ${Array.from(indices.slice(i, i + 3), (k) => `${k + 1}/${k + 1}/${k + 1}`).join(' ')}`);
  }
  await writeFile(path, `${lines.join('\n')}\n`);
}

/**
 * The lines of a mesh, as pairs of vertices: edges that do not have exactly two triangles of one material with the same
 * texture coordinates at both ends.
 */
export function linesOf(mesh) {
  const numbers = (list, width, vertex) => list.slice(width * vertex, width * (vertex + 1)).join(' ');
  const place = (vertex) => numbers(mesh.positions, 3, vertex);
  const edges = new Map();
  for (const { name, indices } of mesh.parts) {
    for (let corner = 0; corner < indices.length; ++corner) {
      const next = corner % 3 === 2 ? corner - 2 : corner + 1;
      const ends = [indices[corner], indices[next]].sort((a, b) => (place(a) < place(b) ? -1 : 1));
      const key = ends.map(place).join('/');
      const side = [name, ...ends.map((vertex) => numbers(mesh.coordinates, 2, vertex))].join('/');
      edges.set(key, { ends, sides: [...(edges.get(key)?.sides ?? []), side] });
    }
  }
  return [...edges.values()]
    .filter(({ sides }) => sides.length !== 2 || sides[0] !== sides[1])
    .map(({ ends }) => ends);
}

/** Writes pairs of vertices as triangles without area, of which the distance is that of the lines. */
export async function writeLines(path, mesh, lines) {
  const text = [];
  lines.flat().forEach((vertex) => text.push(`v ${mesh.positions.slice(3 * vertex, 3 * vertex + 3).join(' ')}`));
  lines.forEach((_, i) => text.push(`f ${2 * i + 1} ${2 * i + 2} ${2 * i + 2}`));
  await writeFile(path, `${text.join('\n')}\n`);
}

export const faceCount = (mesh) => mesh.parts.reduce((sum, part) => sum + part.indices.length / 3, 0);
