// SPDX-License-Identifier: MIT
// node report.mjs CHROMIUM REPORT.html JSON SCREENSHOT_FOLDER repeats|chooses|refuses [alone]: opens a report in headless Chromium at desktop and narrow
// width, light and dark, and holds it against the JSON document. Exit code 0 when everything is as it should be; each
// fault is a line on stdout. With "alone" nothing but the measurement in the page is looked at.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [, , executablePath, report, json, screenshots, measurement, alone] = process.argv;
const document_ = JSON.parse(await readFile(json, 'utf8'));
const isChain = document_.schema.startsWith('meshbound/lod');
const isSimplify = document_.schema.startsWith('meshbound/simplify');
const keys = isSimplify || isChain ? ['original_to_simplified', 'simplified_to_original'] : ['a_to_b', 'b_to_a'];

const measured = isChain ? document_.levels.at(-1) : document_;
const inputs = isChain ? [document_.original, ...document_.levels]
  : isSimplify ? [document_.original, document_.simplified] : [document_.a, document_.b];

const faults = [];
const expect = (condition, what) => { if (!condition) faults.push(what); };
const equal = (found, wanted, what) => expect(found === wanted, `${what}: ${found} instead of ${wanted}`);

const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader'],
});

/** How many colours a smaller copy of the canvas has, the share of pixels unlike the first one, and a checksum. */
const look = (page) => page.evaluate(() => {
  const canvas = document.getElementById('canvas');
  const copy = document.createElement('canvas');
  copy.width = 300;
  copy.height = Math.round((300 * canvas.height) / canvas.width);
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0, copy.width, copy.height);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  const colours = new Set();
  let different = 0, hash = 0;
  for (let i = 0; i < data.length; i += 4) {
    const colour = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
    colours.add(colour);
    if (colour !== ((data[0] << 16) | (data[1] << 8) | data[2])) ++different;
    hash = (Math.imul(hash, 31) + colour) | 0;
  }
  return { colours: colours.size, share: different / (data.length / 4), hash };
});

async function checkNumbers(page) {
  const text = (id) => page.locator(`#${id}`).innerText();
  equal(await text('verdict'), document_.verdict, 'verdict');
  const [lower, upper] = (await text('interval')).replace(/[[\]]/g, '').split(', ').map(Number.parseFloat);
  equal(lower, measured.distance.lower, 'lower bound');
  equal(upper, measured.distance.upper, 'upper bound');
  const values = await page.locator('#distances data').evaluateAll((nodes) => nodes.map((node) => Number(node.value)));
  const wanted = keys.flatMap((key) => {
    const { lower: low, upper: high } = measured.distance[key];
    const s = document_.deviation[key];
    return [low, high, s.mean, s.root_mean_square, s.percentile_95, s.largest_sample];
  });
  equal(values.join(), wanted.join(), 'numbers of the table of distances');
  equal(await page.locator('#charts svg').count(), 2, 'histograms');
  equal(JSON.stringify(JSON.parse(await page.locator('#json').textContent())), JSON.stringify(document_), 'document');
  const settings = await text('settings');
  for (const word of [document_.provenance.date, document_.provenance.version, document_.provenance.command[1]])
    expect(settings.includes(word), `the settings do not name ${word}`);
  const meshes = await text('meshes');
  for (const mesh of inputs)
    expect(meshes.includes(mesh.sha256), `no checksum of ${mesh.path}`);
}

/** The button measures the same interval again, or is not there and a sentence says why. */
async function checkMeasurement(page, where) {
  const isVisible = await page.locator('#measure').isVisible();
  equal(isVisible, measurement !== 'refuses', `${where}: the button that measures is visible`);
  expect((await page.locator('#measure-note').innerText()).length > 40, `${where}: no note on measuring here`);
  if (!isVisible) return;
  const answered = async (pattern) => {
    await page.click('#measure');
    await page.locator('#measured').filter({ hasText: pattern }).waitFor({ timeout: 60000 });
  };
  if (measurement === 'chooses') {
    await page.setInputFiles('#measure-first', inputs[1].path);
    await page.setInputFiles('#measure-second', inputs[1].path);
    await answered(/another file/);
    await page.setInputFiles('#measure-first', inputs[0].path);
  }
  await answered(/\[|at least|failed/);
  const { lower, upper } = await page.locator('#measured').evaluate((node) => ({ ...node.dataset }));
  equal(Number(lower), measured.distance.lower, `${where}: lower bound measured in the browser`);
  equal(Number(upper), measured.distance.upper ?? Infinity, `${where}: upper bound measured in the browser`);
  expect((await page.locator('#measured').innerText()).includes('to the last bit'), `${where}: the bounds are not said to be equal`);
}

/** Every control changes what is drawn. */
async function checkControls(page, where) {
  let before = await look(page);
  const changed = async (what) => {
    let now = await look(page);
    for (let i = 0; i < 50 && now.hash === before.hash; ++i) {
      await page.waitForTimeout(100);
      now = await look(page);
    }
    expect(now.hash !== before.hash, `${where}: ${what} changes nothing in the view`);
    expect(now.colours > 1, `${where}: ${what} leaves the view blank`);
    before = now;
  };
  for (const [id, value] of [['shading', 'edges'], ['shading', 'wireframe'], ['shading', 'shaded'], ['colour', 'plain'],
    ['colour', 'deviation'], ['show', 'first'], ['show', 'second'], ['show', 'split']]) {
    await page.selectOption(`#${id}`, value);
    await changed(`${id} ${value}`);
  }
  await page.locator('#divider').fill('20');
  await changed('divider');
  for (const id of ['worst-first', 'worst-second']) {
    await page.click(`#${id}`);
    await changed(id);
    const near = await page.evaluate(() => window.meshboundReport.viewer.witness.visible);
    expect(near, `${id} marks no witness`);
  }
  await page.click('#whole');
  await changed('whole');
  await page.evaluate(() => document.getElementById('stage').scrollIntoView({ block: 'center' }));
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 30, { steps: 4 });
  await page.mouse.up();
  await changed('dragging');
  await page.mouse.wheel(0, -400);
  await changed('the wheel');
  if ((document_.levels ?? []).length === 0) return;
  await page.selectOption('#show', 'second');
  before = await look(page);
  const coarsest = document_.levels.length - 1;
  for (let level = isChain ? coarsest - 1 : coarsest; level >= 0; --level) {
    await page.locator('#level').fill(String(level));
    await changed(`level ${level}`);
    expect((await page.locator('#level-name').innerText()).includes(String(document_.levels[level].faces)),
      `level ${level} does not say its triangles`);
    const row = await page.locator('#levels tr.chosen data').evaluateAll((nodes) => nodes.map((node) => Number(node.value)));
    const { faces, tolerance, distance } = document_.levels[level];
    equal(row.join(), [faces, tolerance, distance.lower, distance.upper].join(), `row of level ${level}`);
  }
}

if (alone) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(report).href);
  await checkMeasurement(page, 'alone');
}
for (const [name, viewport] of alone ? [] : [['desktop', { width: 1280, height: 900 }], ['narrow', { width: 390, height: 844 }]]) {
  for (const colorScheme of ['light', 'dark']) {
    const where = `${name}, ${colorScheme}`;
    const context = await browser.newContext({ viewport, colorScheme });
    const page = await context.newPage();
    page.on('pageerror', (error) => faults.push(`${where}: ${error}`));
    page.on('console', (message) => { if (message.type() === 'error') faults.push(`${where}: ${message.text()}`); });
    page.on('request', (request) => {
      if (!/^(file|data|blob):/.test(request.url())) faults.push(`${where}: the page asked for ${request.url()}`);
    });
    await page.goto(pathToFileURL(report).href);
    await page.waitForSelector('body[data-ready=yes]');
    await page.waitForTimeout(300);
    const seen = await look(page);
    expect(seen.colours > 50 && seen.share > 0.05, `${where}: the canvas is blank (${seen.colours} colours)`);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    expect(overflow <= 0, `${where}: the page is ${overflow} pixels wider than the window`);
    await checkNumbers(page);
    await checkMeasurement(page, where);
    await page.screenshot({ path: join(screenshots, `${name}-${colorScheme}.png`), fullPage: true });
    if ((name === 'narrow') === (colorScheme === 'dark')) await checkControls(page, where);
    await context.close();
  }
}
await browser.close();
for (const fault of faults) console.log(fault);
process.exit(faults.length > 0 ? 1 : 0);
