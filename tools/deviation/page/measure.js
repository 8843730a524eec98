// SPDX-License-Identifier: MIT
// The button that repeats the measurement in this browser: the engine runs in a worker, on both meshes, which the page
// holds whole.
import { decoded, distance, exact, read } from './data.js';

const byId = (id) => document.getElementById(id);
const measurement = read('measurement');

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

function measure() {
  const button = byId('measure');
  button.disabled = true;
  byId('measured').textContent = 'Measuring …';
  const worker = engineWorker();
  const end = (act) => {
    act();
    worker.terminate();
    button.disabled = false;
  };
  worker.onmessage = ({ data }) =>
    end(() => (data.fault ? (byId('measured').textContent = `It failed: ${data.fault}`) : show(data)));
  worker.onerror = ({ message }) => end(() => { byId('measured').textContent = `It failed: ${message}`; });
  const { first, second, ...options } = measurement;
  worker.postMessage({ ...options, first: mesh(first), second: mesh(second) });
}

export function connectMeasurement() {
  byId('measure').hidden = measurement.reason !== undefined;
  byId('measure-note').textContent = measurement.reason ??
    'Both meshes are in this page whole, and so is the engine: it measures them again in this browser, without a network.';
  byId('measure').addEventListener('click', measure);
}
