// SPDX-License-Identifier: MIT
// The button that repeats the measurement in this browser: the engine runs in a worker, on both meshes, which the page
// holds whole, or else on files that its reader chooses.
import { decoded, distance, exact, meshNames, meshReports, read } from './data.js';

const byId = (id) => document.getElementById(id);
const measurement = read('measurement');
const sides = ['first', 'second'];
const hasMeshes = measurement.first !== null;

function mesh({ type, positions, triangles }) {
  return {
    positions: decoded(positions, type === 'float32' ? Float32Array : Float64Array),
    indices: decoded(triangles, Uint32Array),
  };
}

const isSame = (found) => found.lower === distance.lower && found.upper === (distance.upper ?? Infinity);

function show(found) {
  byId('measured').dataset.lower = String(found.lower);
  byId('measured').dataset.upper = String(found.upper);
  byId('measured').textContent = `${exact({ ...found, upper: Number.isFinite(found.upper) ? found.upper : null })} in ` +
    `${found.seconds.toFixed(2)} s: ${isSame(found) ? 'the interval at the top of this page, to the last bit.'
      : 'it differs from the interval at the top of this page.'}`;
}

/** A worker of the script in this page; the address of the script is needed until the worker has it. */
function engineWorker() {
  const address = URL.createObjectURL(new Blob([byId('engine').textContent], { type: 'text/javascript' }));
  const worker = new Worker(address);
  worker.addEventListener('message', () => URL.revokeObjectURL(address), { once: true });
  return worker;
}

/** The file that was chosen for a mesh, when it is the one that the report is about. */
async function chosenFile(side, index) {
  const [file] = byId(`measure-${side}`).files;
  if (!file) throw new Error(`choose the file of ${meshNames[index]} first`);
  const bytes = await file.arrayBuffer();
  const digest = Array.from(new Uint8Array(await crypto.subtle.digest('SHA-256', bytes)));
  const checksum = digest.map((byte) => byte.toString(16).padStart(2, '0')).join('');
  if (checksum !== meshReports[index].sha256)
    throw new Error(`${file.name} is another file than ${meshNames[index]} of this report: its SHA-256 is ${checksum}`);
  return { bytes, format: file.name.split('.').pop().toLowerCase() };
}

const meshes = () => Promise.all(sides.map(hasMeshes ? (side) => mesh(measurement[side]) : chosenFile));

/** What the worker answers; it ends with the answer. */
function answer(message) {
  const worker = engineWorker();
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => (data.fault ? reject(new Error(data.fault)) : resolve(data));
    worker.onerror = ({ message: fault }) => reject(new Error(fault));
    worker.postMessage(message);
  }).finally(() => worker.terminate());
}

async function measure() {
  byId('measure').disabled = true;
  byId('measured').textContent = 'Measuring …';
  try {
    const [first, second] = await meshes();
    show(await answer({ options: measurement.options, first, second }));
  } catch (error) {
    byId('measured').textContent = `This failed: ${error.message}`;
  }
  byId('measure').disabled = false;
}

const note = hasMeshes
  ? 'Both meshes are in this page whole, and so is the engine: it measures them again in this browser, without a network.'
  : 'The engine is in this page, but the meshes are too large to be: choose their files, and it measures them again in this ' +
    'browser, without a network.';

export function connectMeasurement() {
  const { reason } = measurement.options;
  byId('measure').hidden = reason !== undefined;
  byId('measure-files').hidden = reason !== undefined || hasMeshes;
  sides.forEach((side, i) => { byId(`measure-${side}`).previousElementSibling.textContent = meshNames[i]; });
  byId('measure-note').textContent = reason ?? note;
  byId('measure').addEventListener('click', measure);
}
