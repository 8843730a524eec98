// SPDX-License-Identifier: MIT
// Charts as SVG: histogram with cumulative curve, and error against triangles.
import { colourOf, css } from './colours.js';
import { scene, short } from './data.js';

const width = 460, height = 230, left = 46, right = 14, top = 12, bottom = 34;
const inner = { width: width - left - right, height: height - top - bottom };

const SVG = 'http://www.w3.org/2000/svg';

function element(name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

function figure(caption, nodes) {
  const chart = element('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': caption });
  chart.append(...nodes);
  const box = document.createElement('figure');
  const below = document.createElement('figcaption');
  below.textContent = caption;
  box.append(chart, below);
  return box;
}

const x = (share) => left + share * inner.width;
const y = (share) => top + (1 - share) * inner.height;

function axes(bottomLabels, leftLabels) {
  return [
    element('path', { class: 'axis', d: `M${left} ${top}V${y(0)}H${width - right}` }),
    ...bottomLabels.map(([share, text]) => element('text', {
      x: x(share), y: height - 12, 'text-anchor': share === 0 ? 'start' : share === 1 ? 'end' : 'middle' }, text)),
    ...leftLabels.map(([share, text]) => element('text', { x: left - 5, y: y(share) + 4, 'text-anchor': 'end' }, text)),
  ];
}

/** Bars for the share of the area in each bin, a curve for the share up to there, and marks for p95 and the maximum. */
export function histogram(direction) {
  const { histogram: bins, beyond_scale: beyond, samples, percentile_95: p95 } = direction.statistics;
  const largest = Math.max(1, ...bins, beyond);
  const step = inner.width / (bins.length + (beyond > 0 ? 4 : 0));
  const nodes = bins.map((count, i) => element('rect', {
    x: left + i * step, width: Math.max(0.5, step - 0.4), y: y(count / largest),
    height: (count / largest) * inner.height, fill: css(colourOf((i + 0.5) / bins.length)) }));
  if (beyond > 0) nodes.push(element('rect', { x: left + (bins.length + 1) * step, width: 3 * step, y: y(beyond / largest),
    height: (beyond / largest) * inner.height, fill: css(scene.beyond) }));
  let sum = 0;
  const curve = bins.map((count, i) => {
    sum += count;
    return `${left + (i + 1) * step} ${y(sum / samples)}`;
  });
  nodes.push(element('path', { class: 'curve', d: `M${left} ${y(0)}L${curve.join('L')}` }));
  const span = bins.length * step;
  for (const [value, name, line] of [[p95, '95%', 1], [direction.distance?.upper ?? null, 'proven maximum', 2]]) {
    if (value === null || value > scene.scale.end) continue;
    const mark = left + (value / scene.scale.end) * span;
    nodes.push(element('path', { class: 'mark', d: `M${mark} ${top}V${y(0)}` }));
    nodes.push(element('text', { x: mark - 4, y: top + 14 * line + 22, 'text-anchor': 'end' }, name));
  }
  const end = (bins.length * step) / inner.width;
  return figure(
    `${direction.name}: bars for the share of the area (highest ${Number((100 * largest / samples).toPrecision(3))}%), ` +
    'the line for all up to there',
    [...nodes, ...axes([[0, '0'], [end, short(scene.scale.end)]], [[0, '0'], [0.5, '50%'], [1, '100%']])]);
}

/** The proven upper bound of each level over its triangles, both on logarithmic axes. */
export function levelCurve(levels, chosen) {
  const faces = levels.map((level) => Math.log(Math.max(1, level.faces)));
  const errors = levels.map((level) => Math.log(Math.max(Number.MIN_VALUE, level.distance.upper ?? level.distance.lower)));
  const share = (values, i) => {
    const low = Math.min(...values), high = Math.max(...values);
    return high > low ? 0.05 + 0.9 * (values[i] - low) / (high - low) : 0.5;
  };
  const points = levels.map((_, i) => [x(share(faces, i)), y(share(errors, i))]);
  const ends = [faces, errors].map((values) => [values.indexOf(Math.min(...values)), values.indexOf(Math.max(...values))]);
  return figure('Largest proven distance against triangles, both axes logarithmic', [
    ...axes(ends[0].map((i) => [share(faces, i), String(levels[i].faces)]),
      ends[1].map((i) => [share(errors, i), Number((levels[i].distance.upper ?? levels[i].distance.lower).toPrecision(2))])),
    element('path', { class: 'curve', d: `M${points.map((point) => point.join(' ')).join('L')}` }),
    ...points.map(([px, py], i) => element('circle', { cx: px, cy: py, r: i === chosen ? 6 : 4,
      class: i === chosen ? 'chosen' : 'point' })),
  ]);
}
