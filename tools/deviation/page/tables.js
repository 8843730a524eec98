// SPDX-License-Identifier: MIT
// What is written: the sentence at the top and the tables. Every number stands in a <data> element whose value is that
// of the document.
import { directions, distance, document_, exact, files, isChain, levels, meshReports, scene, short, tolerance } from './data.js';

const byId = (id) => document.getElementById(id);

function number(value, text = short(value)) {
  const node = document.createElement('data');
  node.value = String(value);
  node.textContent = text;
  return node;
}

function row(cells, kind = 'td') {
  const line = document.createElement('tr');
  for (const content of cells) {
    const cell = document.createElement(kind);
    cell.append(content);
    if (typeof content === 'string' && content.length > 40) cell.className = 'text';
    line.append(cell);
  }
  return line;
}

const percent = (value) => {
  const diagonal = meshReports[0].bbox_diagonal;
  return diagonal > 0 && value !== null ? `${Number((100 * value / diagonal).toPrecision(6))}%` : 'unknown';
};

function sentence() {
  const { lower, upper } = distance;
  const parts = [`The distance between the surfaces, both ways, is proven to be in this interval: ${percent(lower)} to ` +
    `${percent(upper)} of the diagonal`];
  if (directions[1].distance === undefined)
    parts[0] = `The distance from A to B, one way, is proven to be in this interval: ${percent(lower)} to ${percent(upper)} of the diagonal`;
  if (tolerance !== undefined) parts.push(`; the tolerance is ${short(tolerance)} (${percent(tolerance)})`);
  const which = isChain ? `Of ${levels.length} levels this is the coarsest. ` : '';
  return `${which}${parts.join('')}.`;
}

function writeTexture() {
  const { texture } = document_;
  if (!texture) return;
  const tolerance = texture.tolerance ? `, the tolerance is ${short(texture.tolerance.absolute)}` : '';
  byId('sentence-texture').hidden = false;
  byId('sentence-texture').textContent = `Texture: how far it moves on the surface, both ways, is in ${exact(texture)}${tolerance}.`;
}

export function writeHeader() {
  const { provenance, verdict } = document_;
  byId('tool').textContent = `${provenance.tool} ${provenance.version}, ${provenance.date}`;
  byId('verdict').textContent = verdict;
  byId('verdict').className = verdict;
  byId('interval').textContent = exact(distance);
  byId('sentence').textContent = sentence();
  document.title = `${verdict}: ${meshReports[1].path || meshReports[0].path}`;
  writeTexture();
  if (!document_.lines) return;
  const { lines } = document_;
  byId('sentence-lines').hidden = false;
  byId('sentence-lines').textContent = `Feature lines: ${lines.original_edges} edges became ${lines.edges}; their distance, ` +
    `both ways, is in ${exact(lines.distance)}, the tolerance is ${short(lines.tolerance.absolute)}.`;
}

export function writeDistances() {
  const table = byId('distances');
  table.append(row(['', 'proven maximum at least', 'at most', 'mean', 'RMS', '95% of the area within', 'largest sample'], 'th'));
  for (const { name, distance, statistics } of directions) {
    const searched = distance?.searched;
    table.append(row([name, ...(searched ? [number(distance.lower), number(distance.upper)] : ['not searched', 'not searched']),
      ...(statistics ? [statistics.mean, statistics.root_mean_square, statistics.percentile_95, statistics.largest_sample]
        .map((value) => number(value)) : ['', '', '', ''])]));
  }
  const samples = directions.map(({ statistics }) => statistics?.samples ?? 0);
  byId('sampling-note').textContent = `Mean, RMS and percentile are estimates, weighted by area, from ${samples[0]} and ` +
    `${samples[1]} points at equal steps of area; the maximum is proven.`;
}

export function writeLevels(chosen) {
  if (levels.length === 0) return;
  const table = byId('levels');
  table.replaceChildren(row(['level', 'triangles', 'tolerance', 'distance at least', 'at most'], 'th'));
  levels.forEach((level, i) => {
    const line = row([level.name.replace('level ', ''), number(level.faces, String(level.faces)), number(level.tolerance),
      number(level.distance.lower), number(level.distance.upper)]);
    if (i === chosen) line.className = 'chosen';
    table.append(line);
  });
}

export function writeMeshes() {
  const table = byId('meshes');
  table.append(row(['', 'file', 'vertices', 'triangles', 'components', 'closed', 'diagonal', 'SHA-256'], 'th'));
  const known = (value, text) => (value === undefined ? '' : number(value, text));
  for (const { name, mesh } of files) {
    const isClosed = mesh.closed === undefined ? '' : mesh.closed ? 'yes' : 'no';
    table.append(row([name, mesh.path, number(mesh.vertices, String(mesh.vertices)), number(mesh.faces, String(mesh.faces)),
      String(mesh.components ?? ''), isClosed, known(mesh.bbox_diagonal), mesh.sha256 ?? '']));
  }
}

export function writeSettings() {
  const { provenance } = document_;
  const settings = {
    command: provenance.command.join(' '),
    program: `${provenance.tool} ${provenance.version}`,
    date: provenance.date,
    'scale of colours': `0 to ${short(scene.scale.end)}, the ${scene.scale.meaning}`,
    unit: scene.unit || 'that of the files',
    'error bound': document_.error_bound === undefined || document_.error_bound === null ? undefined : short(document_.error_bound),
    driver: document_.driver,
    effort: document_.effort,
    'ended by': document_.stopped_by,
    'decided by': document_.decided_by?.replaceAll('_', ' '),
    outcome: document_.outcome,
    reason: document_.reason,
    threads: String(document_.threads),
    seconds: Object.entries(document_.seconds).map(([key, value]) => `${key} ${Number(value.toPrecision(3))}`).join(', '),
  };
  for (const [name, value] of Object.entries(settings)) if (value !== undefined) byId('settings').append(row([name, value]));
  byId('json').textContent = JSON.stringify(document_, null, 2);
}
