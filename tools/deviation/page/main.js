// SPDX-License-Identifier: MIT
// Fills the page and connects its controls.
import { histogram, levelCurve } from './charts.js';
import { drawLegend } from './colours.js';
import { directions, distance, levels, meshNames, meshReports, scene, short, showsLevels } from './data.js';
import { connectMeasurement } from './measure.js';
import { writeDistances, writeHeader, writeLevels, writeMeshes, writeSettings } from './tables.js';
import { Viewer } from './viewer.js';

const byId = (id) => document.getElementById(id);
const state = { show: 'split', shading: 'shaded', colour: 'deviation', divider: 0.5, level: Math.max(0, levels.length - 1) };

function makeViewer() {
  try {
    return new Viewer(byId('canvas'), state);
  } catch (error) {
    byId('no-webgl').hidden = false;
    byId('controls').hidden = true;
    return null;
  }
}

function describeDisplay() {
  const reduced = scene.meshes.filter((mesh) => mesh.reduced);
  const notes = ['Colours: distance of each point to the other mesh; drag to turn, wheel to zoom, right button to move.'];
  for (const mesh of reduced)
    notes.push(`The view shows ${mesh.name} with ${mesh.shown} triangles in place of ${mesh.faces}; every number is of the whole mesh.`);
  byId('display-note').textContent = notes.join(' ');
}

function labels() {
  const faces = levels.length > 0 ? levels[state.level].faces : meshReports[1].faces;
  byId('label-first').textContent = `${meshNames[0]}, ${meshReports[0].faces} triangles`;
  byId('label-second').textContent = `${meshNames[1]}, ${faces} triangles`;
  byId('label-first').hidden = state.show === 'second';
  byId('label-second').hidden = state.show === 'first';
  byId('divider-label').hidden = state.show !== 'split';
  byId('divider-line').hidden = state.show !== 'split';
  byId('divider-line').style.left = `${100 * state.divider}%`;
}

function showLevel() {
  if (levels.length === 0) return;
  const level = levels[state.level];
  byId('level-name').textContent = `${level.name}: ${level.faces} triangles, at most ${short(level.distance.upper)}`;
  byId('level-chart').replaceChildren(levelCurve(levels, state.level));
  writeLevels(state.level);
}

function connect(viewer) {
  const update = () => {
    labels();
    showLevel();
    viewer?.draw();
  };
  for (const id of ['show', 'shading', 'colour'])
    byId(id).addEventListener('change', (event) => { state[id] = event.target.value; update(); });
  byId('divider').addEventListener('input', (event) => { state.divider = event.target.value / 100; update(); });
  byId('level').addEventListener('input', (event) => { state.level = Number(event.target.value); update(); });
  byId('whole').addEventListener('click', () => viewer?.showAll());
  ['worst-first', 'worst-second'].forEach((id, i) => {
    const witness = () => (levels[state.level]?.distance ?? distance)[directions[i].key]?.witness;
    byId(id).textContent = `Worst spot ${directions[i].name}`;
    byId(id).hidden = !witness();
    byId(id).addEventListener('click', () => viewer?.showWitness(witness()));
  });
  update();
}

byId('show').options[1].textContent = meshNames[0];
byId('show').options[2].textContent = meshNames[1];
byId('scale-end').textContent = `${short(scene.scale.end)} (${scene.scale.meaning})`;
if (levels.length > 0) {
  byId('level-label').hidden = !showsLevels;
  byId('level-section').hidden = false;
  byId('level').max = levels.length - 1;
  byId('level').value = levels.length - 1;
}
writeHeader();
writeDistances();
writeMeshes();
writeSettings();
drawLegend();
connectMeasurement();
describeDisplay();
byId('charts').append(...directions.filter(({ statistics }) => statistics?.samples > 0).map(histogram));
const viewer = makeViewer();
connect(viewer);
window.meshboundReport = { state, viewer };
document.body.dataset.ready = 'yes';
