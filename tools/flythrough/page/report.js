// The flythrough report: a table of all runs, a chart over time, and the frames of the selected run.
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const parts = data.parts, $ = id => document.getElementById(id);
const kColours = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#b58900', '#56b4e9', '#7a4fbf', '#b3363e', '#4f7a1e', '#6b7280'];
const kColumns = [
  ['flythrough', 'flythrough'], ['label', 'method'], ['filter', 'filter'], ['eA', 'eA', 4], ['bias', 'bias', 4], ['difference', 'D_A', 4],
  ['excessFlicker', 'excess', 4], ['flickerOfError', 'F_e', 4], ['referenceFlicker', 'F_R', 4], ['noiseMean', 'noise', 5],
  ['noiseP99', 'noise p99', 4], ['t90', 'T90', 0], ['ghost', 'ghost', 3], ['milliseconds', 'ms', 2]
];
const kMeasures = [
  ['flickerOfError', 'flicker of error'], ['eA', 'mean absolute error'], ['excessFlicker', 'excess flicker'],
  ['difference', 'change along motion']
];
const kDash = {
  raw: '1 3',
  spatial: '5 3',
  temporal: ''
};
const make = (tag, text, parent) => {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (parent) parent.append(e);
  return e;
};
const drawn = (tag, attributes, parent) => {
  const e = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const k in attributes) e.setAttribute(k, attributes[k]);
  parent.append(e);
  return e;
};
let chosen = parts[0], sortBy = null, descending = false;

const sizes = new Set(parts.map(p => `${p.width} x ${p.height} px, ${p.rays} rays`));
$('about').textContent = [data.device, ...sizes].filter(Boolean).join(', ');
const labels = [...new Set(parts.map(p => p.label))];
const colour = part => kColours[labels.indexOf(part.label) % kColours.length];

function summary() {
  const table = $('summary');
  table.textContent = '';
  const head = make('tr', undefined, make('thead', undefined, table));
  kColumns.forEach(([key, title]) => {
    const th = make('th', title, head);
    if (key === sortBy) th.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    th.onclick = () => {
      descending = sortBy === key ? !descending : false;
      sortBy = key;
      summary();
    };
  });
  const rows = [...parts];
  if (sortBy)
    rows.sort((a, b) => {
      const x = a[sortBy] ?? Infinity, y = b[sortBy] ?? Infinity;
      return (x < y ? -1 : x > y ? 1 : 0) * (descending ? -1 : 1);
    });
  const best = {};
  for (const p of parts)
    for (const key of ['eA', 'flickerOfError']) {
      const k = p.flythrough + key;
      best[k] = Math.min(best[k] ?? Infinity, p[key] ?? Infinity);
    }
  const body = make('tbody', undefined, table);
  for (const part of rows) {
    const tr = make('tr', undefined, body);
    if (part === chosen) tr.className = 'chosen';
    for (const [key, , digits] of kColumns) {
      const td = make('td', digits === undefined ? part[key] : part[key] === undefined ? '' : part[key].toFixed(digits), tr);
      if (best[part.flythrough + key] === part[key]) td.className = 'best';
    }
    tr.onclick = () => {
      chosen = part;
      $('flythrough').value = part.flythrough;
      summary();
      chart();
      show(part.worstFrame);
    };
  }
}

function chart() {
  const svg = $('chart'), name = $('flythrough').value, key = $('measure').value, list = parts.filter(p => p.flythrough === name);
  svg.textContent = '';
  $('legend').textContent = '';
  const w = svg.clientWidth || 900, h = 320, left = 52, right = 12, top = 12, bottom = 26;
  svg.setAttribute('viewBox', `0 0 ${w} ${h}`);
  // Frames of sky alone have no numbers.
  const skip = key === 'eA' ? 0 : 1, rows = p => p.frames.filter(f => f.frame >= skip && f[key] !== undefined);
  const all = list.flatMap(rows), low = Math.min(0, ...all.map(f => f[key])), high = Math.max(1e-6, ...all.map(f => f[key]));
  if (!all.length) return;
  const first = Math.min(...all.map(f => f.frame)), last = Math.max(...all.map(f => f.frame));
  const x = f => left + (w - left - right) * (f - first) / Math.max(1, last - first),
        y = v => h - bottom - (h - top - bottom) * (v - low) / (high - low);
  for (let i = 0; i <= 4; ++i) {
    const v = low + (high - low) * i / 4;
    drawn('line', {x1: left, x2: w - right, y1: y(v), y2: y(v), class: 'grid'}, svg);
    drawn('text', {x: left - 6, y: y(v) + 4, 'text-anchor': 'end'}, svg).textContent = v.toFixed(4);
  }
  for (let i = 0; i <= 8; ++i)
    drawn('text', {x: x(first + (last - first) * i / 8), y: h - 8, 'text-anchor': 'middle'}, svg).textContent =
        Math.round(first + (last - first) * i / 8);
  for (const event of list[0]?.events ?? [])
    drawn('line', {x1: x(event.frame), x2: x(event.frame), y1: top, y2: h - bottom, class: 'event'}, svg);
  for (const part of list) {
    const line = drawn(
        'polyline', {
          fill: 'none',
          stroke: colour(part),
          'stroke-width': part === chosen ? 3 : 1.5,
          'stroke-dasharray': kDash[part.filter] ?? '',
          points: rows(part).map(f => `${x(f.frame)},${y(f[key])}`).join(' ')
        },
        svg);
    drawn('title', {}, line).textContent = `${part.label}, ${part.filter}`;
    const item = make('span', `${part.label}, ${part.filter}`, $('legend'));
    item.style.setProperty('--c', colour(part));
  }
}

function show(frame) {
  const frames = chosen.frames.map(f => f.frame), row = chosen.frames.find(f => f.frame === frame) ?? chosen.frames[0];
  $('shown').textContent = `${chosen.label}, ${chosen.filter}, ${chosen.flythrough}`;
  $('frame').min = Math.min(...frames);
  $('frame').max = Math.max(...frames);
  $('frame').value = row.frame;
  $('number').textContent = row.frame;
  $('caption').textContent = row.eA === undefined ?
      `frame ${row.frame}: no surface, so no numbers` :
      `frame ${row.frame}: eA ${row.eA.toFixed(4)}, flicker of error ${row.flickerOfError.toFixed(4)}`;
  const file = String(row.frame).padStart(4, '0') + '.png';
  $('picture').src = chosen.pictures ? `${chosen.pictures}/${file}` : '';
  $('reference').src = chosen.pictures ? `frames/${chosen.flythrough}.reference/${file}` : '';
  $('passes').textContent = '';
  const head = make('tr', undefined, $('passes'));
  for (const t of ['pass', 'median, ms', 'p95, ms']) make('th', t, head);
  for (const pass of chosen.passes) {
    const tr = make('tr', undefined, $('passes'));
    make('td', pass.name, tr);
    make('td', pass.median.toFixed(3), tr);
    make('td', pass.p95.toFixed(3), tr);
  }
}

for (const name of new Set(parts.map(p => p.flythrough))) make('option', name, $('flythrough'));
for (const [key, title] of kMeasures) make('option', title, $('measure')).value = key;
$('flythrough').onchange = () => {
  chosen = parts.find(p => p.flythrough === $('flythrough').value);
  summary();
  chart();
  show(chosen.worstFrame);
};
$('measure').onchange = chart;
$('frame').oninput = () => show(Number($('frame').value));
$('worst').onclick = () => show(chosen.worstFrame);
addEventListener('resize', chart);
summary();
chart();
if (chosen) show(chosen.worstFrame);
