// SPDX-License-Identifier: MIT
// node engine.mjs NPM_PACKAGE OUT.js: the script of a worker that repeats a measurement, with the engine of the npm
// package in it, compressed. Run where node_modules has what package-lock.json names.
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';

const [, , folder, out] = process.argv;

/** Takes the place of engine.js in the package: the module comes from this script, not from a file beside it. */
const embedded = async () => `
import createEngine from ${JSON.stringify(join(folder, 'engine.js'))};
const packed = '${gzipSync(await readFile(join(folder, 'engine.wasm')), { level: 9 }).toString('base64')}';
export default async () => {
  const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return createEngine({ wasmBinary: await new Response(stream).arrayBuffer(), locateFile: (name) => name });
};
`;

const plugin = {
  name: 'npm package of this build',
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^meshbound$/ }, () => ({ path: join(folder, 'meshbound.js') }));
    onResolve({ filter: /^\.\/engine\.js$/ }, () => ({ path: 'engine', namespace: 'embedded' }));
    onLoad({ filter: /.*/, namespace: 'embedded' }, async () => ({ contents: await embedded(), resolveDir: folder }));
  },
};

const bundled = await build({
  entryPoints: ['worker.js'], bundle: true, minify: true, format: 'iife', write: false, charset: 'ascii',
  external: ['node:*'], plugins: [plugin], logOverride: { 'empty-import-meta': 'silent' },
});
await writeFile(out, bundled.outputFiles[0].text.replaceAll('</script', '<\\/script'));
