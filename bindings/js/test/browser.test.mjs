// SPDX-License-Identifier: MIT
// The npm package in a browser: 30 pairs have the intervals that they have in Node, bit for bit. Skipped where there is
// no Chromium. Environment: MESHBOUND_NPM is the folder of the package.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = process.env.MESHBOUND_NPM;
const types = { '.js': 'text/javascript', '.wasm': 'application/wasm' };

/** Runs in Node and in the page: the intervals of 30 pairs of sheets with different waves. */
async function intervalsOf30Pairs(meshbound) {
  await meshbound.ready;
  const sheet = (side, height, lift) => {
    const positions = new Float64Array(3 * side * side);
    const indices = [];
    for (let i = 0; i < side * side; ++i) {
      const [x, y] = [(i % side) / (side - 1), Math.floor(i / side) / (side - 1)];
      positions.set([x, y, lift + height * x * (1 - x) * (y * y - 0.3 * x)], 3 * i);
      if (i % side < side - 1 && i < side * (side - 1)) indices.push(i, i + 1, i + side + 1, i, i + side + 1, i + side);
    }
    return { positions, indices: Uint32Array.from(indices) };
  };
  return Array.from({ length: 30 }, (_, i) => {
    const { lower, upper } = meshbound.hausdorffDistance(sheet(12 + i, 0.7, 0), sheet(11 + (i % 7), 0.9, i / 300));
    return [lower, upper];
  });
}

const page = `<!doctype html><script type="module">
${intervalsOf30Pairs}
const report = (text) => fetch('/result', { method: 'POST', body: text });
try {
  report(JSON.stringify(await intervalsOf30Pairs(await import('/meshbound.js'))));
} catch (error) {
  report('failed: ' + (error?.stack ?? error));
}
</script>`;

function serve(onResult) {
  return createServer((request, response) => {
    if (request.method === 'POST') {
      let body = '';
      request.on('data', (part) => (body += part)).on('end', () => onResult(body));
      response.end();
    } else if (request.url === '/') {
      response.setHeader('Content-Type', 'text/html').end(page);
    } else {
      const path = join(folder, basename(request.url));
      if (!existsSync(path)) return response.writeHead(404).end();
      response.setHeader('Content-Type', types[path.slice(path.lastIndexOf('.'))] ?? 'text/plain');
      createReadStream(path).pipe(response);
    }
  });
}

/** Without a window, and without anything that looks for a network. */
const flags = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-sync',
  '--disable-background-networking', '--disable-component-update'];
const hasChromium = spawnSync('chromium', ['--version']).status === 0;

test('30 pairs have the same intervals in Chromium', { skip: !hasChromium && 'chromium is not installed', timeout: 120000 }, async () => {
  const expected = await intervalsOf30Pairs(await import(pathToFileURL(join(folder, 'meshbound.js')).href));
  const profile = mkdtempSync(join(tmpdir(), 'meshbound-chromium-'));
  let browser;
  let server;
  try {
    const result = await new Promise((resolve, reject) => {
      server = serve(resolve).listen(0, '127.0.0.1', () => {
        const url = `http://127.0.0.1:${server.address().port}/`;
        browser = spawn('chromium', [...flags, `--user-data-dir=${profile}`, url], { stdio: 'ignore' });
        browser.on('error', reject).on('exit', (code) => reject(new Error(`chromium ended with ${code}`)));
      });
    });
    assert.ok(!result.startsWith('failed'), result);
    assert.deepEqual(JSON.parse(result), expected);
  } finally {
    browser?.removeAllListeners('exit');
    browser?.kill();
    server?.close();
    server?.closeAllConnections();
    await new Promise((resolve) => setTimeout(resolve, 500));
    rmSync(profile, { recursive: true, force: true });
  }
});
