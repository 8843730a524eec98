// SPDX-License-Identifier: MIT
// The same mesh with about as many faces by meshoptimizer's simplifyWithAttributes.
import { MeshoptSimplifier } from 'meshoptimizer';

import { faceCount } from './obj.mjs';

/** Weight of each component of a normal: what meshoptimizer's own tool, gltfpack, takes. */
const normalWeight = 0.5;

/**
 * Normals and texture coordinates are the attributes, the latter with `weight`. Each material is simplified by itself to
 * its share of `faces`; where there are several, their borders are locked, as the surface would tear there otherwise.
 */
export async function simplifyByMeshopt(mesh, faces, weight) {
  await MeshoptSimplifier.ready;
  const positions = new Float32Array(mesh.positions);
  const attributes = new Float32Array((mesh.positions.length / 3) * 5);
  for (let v = 0; v < mesh.positions.length / 3; ++v) {
    attributes.set(mesh.normals.slice(3 * v, 3 * v + 3), 5 * v);
    attributes.set(mesh.coordinates.slice(2 * v, 2 * v + 2), 5 * v + 3);
  }
  const weights = [normalWeight, normalWeight, normalWeight, weight, weight];
  const share = faces / faceCount(mesh);
  const flags = mesh.parts.length > 1 ? ['LockBorder'] : [];
  const parts = mesh.parts.map(({ name, indices }) => {
    const target = 3 * Math.round((share * indices.length) / 3);
    const simplified = MeshoptSimplifier.simplifyWithAttributes(new Uint32Array(indices), positions, 3, attributes, 5,
      weights, null, target, 1, flags);
    return { name, indices: simplified[0] };
  });
  return { ...mesh, parts };
}
