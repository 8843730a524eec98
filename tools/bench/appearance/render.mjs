// SPDX-License-Identifier: MIT
// Pictures by three.js in headless Chromium: eight views of each mesh, and how far those of levels are from the
// original's.
import { readFile } from 'node:fs/promises';
import { chromium } from 'playwright-core';

const size = 1024; // pixels, of each side of a picture

/** Runs in the page. A checkerboard in the colours of u and v, lit from the camera with the normals of the mesh. */
async function drawAll({ meshes, size }) {
  const THREE = await import('/three.module.js');
  const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  renderer.setSize(size, size, false);
  const texels = new Uint8Array(256 * 256 * 4);
  for (let y = 0; y < 256; ++y)
    for (let x = 0; x < 256; ++x) {
      const light = ((x >> 3) + (y >> 3)) % 2 === 0 ? 1 : 0.45;
      texels.set([light * (80 + 0.68 * x), light * (80 + 0.68 * y), light * 160, 255], 4 * (256 * y + x));
    }
  const texture = new THREE.DataTexture(texels, 256, 256);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  const camera = new THREE.PerspectiveCamera(35, 1, 0.1, 100);
  const light = new THREE.DirectionalLight(0xffffff, 2);
  let frame;
  const pictures = meshes.map(({ positions, coordinates, normals, indices }) => {
    const geometry = new THREE.BufferGeometry();
    const attribute = (name, numbers, width) =>
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(numbers), width));
    attribute('position', positions, 3);
    attribute('uv', coordinates, 2);
    attribute('normal', normals, 3);
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(indices), 1));
    if (!frame) {
      geometry.computeBoundingSphere();
      frame = geometry.boundingSphere;
    }
    const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ map: texture, side: THREE.DoubleSide }));
    const scene = new THREE.Scene();
    scene.add(mesh, new THREE.AmbientLight(0xffffff, 1), light, light.target);
    light.target.position.copy(frame.center);
    return [0, 1, 2, 3, 4, 5, 6, 7].map((view) => {
      const way = new THREE.Vector3(view & 1 ? 1 : -1, view & 2 ? 0.6 : -0.6, view & 4 ? 1 : -1).normalize();
      camera.near = frame.radius / 10;
      camera.far = frame.radius * 10;
      camera.position.copy(frame.center).addScaledVector(way, frame.radius * 3.4);
      camera.lookAt(frame.center);
      camera.updateProjectionMatrix();
      light.position.copy(camera.position);
      renderer.render(scene, camera);
      const gl = renderer.getContext();
      const pixels = new Uint8Array(4 * size * size);
      gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return pixels;
    });
  });
  const [original, ...levels] = pictures;
  return levels.map((views) => {
    let difference = 0;
    let covered = 0;
    views.forEach((pixels, view) => {
      for (let i = 0; i < pixels.length; i += 4) {
        const [r, g, b] = [0, 1, 2].map((k) => Math.abs(pixels[i + k] - original[view][i + k]));
        difference += (r + g + b) / 3;
        const isCovered = pixels[i] + pixels[i + 1] + pixels[i + 2] + original[view][i] + original[view][i + 1] + original[view][i + 2] > 0;
        if (isCovered) ++covered;
      }
    });
    return difference / covered;
  });
}

const buffersOf = (mesh) => ({
  positions: Array.from(mesh.positions),
  coordinates: Array.from(mesh.coordinates),
  normals: Array.from(mesh.normals),
  indices: mesh.parts.flatMap((part) => Array.from(part.indices)),
});

/**
 * For each level the mean difference from the original, of 255 steps of a colour, over the pixels of eight views that
 * show either of the two.
 */
export async function pictureErrors(executablePath, original, levels) {
  const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--use-gl=angle',
      '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  try {
    const page = await browser.newPage();
    await page.route('http://bench.invalid/**', async (route) => {
      const name = new URL(route.request().url()).pathname.slice(1);
      if (!name) return route.fulfill({ contentType: 'text/html', body: '<!doctype html>' });
      const file = new URL(`./node_modules/three/build/${name}`, import.meta.url);
      return route.fulfill({ contentType: 'text/javascript', body: await readFile(file) });
    });
    await page.goto('http://bench.invalid/');
    return await page.evaluate(drawAll, { meshes: [original, ...levels].map(buffersOf), size });
  } finally {
    await browser.close();
  }
}
