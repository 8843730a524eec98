// SPDX-License-Identifier: MIT
// Answers one message, options with two meshes or files, by the interval that the tools find for them.
import { check, hausdorffDistance, readMesh, ready } from 'meshbound';

/** A mesh as it comes, or the one that the bytes of a file hold. */
const meshOf = (mesh) => (mesh.bytes ? readMesh(mesh.bytes, mesh.format) : mesh);

const unbounded = { lower: 0, upper: Infinity };

/** What is proven by the decision, and by the measurement that may follow it. */
function interval({ decides, error_bound: errorBound, tolerance, one_sided: oneSided }, first, second) {
  const decided = decides ? check(first, second, tolerance, { oneSided }).distance : unbounded;
  const measured = errorBound === null ? unbounded
    : hausdorffDistance(first, second, { errorBound, oneSided, ...(tolerance === null ? {} : { tolerance }) });
  return { lower: Math.max(decided.lower, measured.lower), upper: Math.min(decided.upper, measured.upper) };
}

self.onmessage = async ({ data }) => {
  try {
    await ready;
    const [first, second] = [meshOf(data.first), meshOf(data.second)];
    const start = performance.now();
    self.postMessage({ ...interval(data.options, first, second), seconds: (performance.now() - start) / 1000 });
  } catch (error) {
    self.postMessage({ fault: String(error) });
  }
};
