// Shared code of the report pages: elements, numbers as text, labels in charts, theme. Precedes each page's own script.
'use strict';
const $ = id => document.getElementById(id);
function element(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) e.addEventListener(key.slice(2), value);
    else if (value !== false && value !== undefined) e.setAttribute(key, value);
  }
  e.append(...children);
  return e;
}
function svg(tag, attributes = {}, ...children) {
  const e = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [key, value] of Object.entries(attributes))
    key === 'onclick' ? e.addEventListener('click', value) : e.setAttribute(key, value);
  e.append(...children);
  return e;
}
const unique = list => [...new Set(list)];
const fixed = (value, digits) => Number.isFinite(value) ? value.toFixed(digits) : '';
const signed = (value, digits) => (value >= 0 ? '+' : '') + fixed(value, digits);
const milliseconds = value => value >= 100 ? value.toFixed(0) :
    value >= 10                            ? value.toFixed(1) :
    value >= 0.1                           ? value.toFixed(2) :
                                             value.toPrecision(2);
function fill(select, options, chosen) {
  select.replaceChildren(...options.map(([value, text]) => element('option', {value}, text)));
  select.value = chosen;
  select.disabled = options.length < 2;
}
function short(text, limit = 22) { return text.length > limit ? text.slice(0, limit - 1) + '…' : text; }
// Position of a label near its dot, overlapping neither labels nor dots; `far` labels need a line to their dot. Null if there is no room.
function place(dot, width, taken, dots, bounds) {
  const near = [[9, 4], [-9 - width, 4], [-width / 2, -10], [-width / 2, 20]];
  const far = [1, 2, 3, 4, 5, 6].flatMap(k => [[12, 4 - 14 * k], [-12 - width, 4 - 14 * k], [12, 4 + 14 * k], [-12 - width, 4 + 14 * k]]);
  const hits = b => taken.some(t => b.x < t.x + t.width + 4 && t.x < b.x + b.width + 4 && Math.abs(b.y - t.y) < 13) ||
      dots.some(d => d.x > b.x - 5 && d.x < b.x + b.width + 5 && d.y > b.y - 15 && d.y < b.y + 6);
  for (const [i, [dx, dy]] of [...near, ...far].entries()) {
    const box = {x: dot.x + dx, y: dot.y + dy, width, far: i >= near.length};
    if (box.x >= bounds.left && box.x + width <= bounds.right && box.y - 12 >= bounds.top && box.y <= bounds.bottom && !hits(box))
      return box;
  }
  return null;
}
// Table head with sort buttons. Columns: [key, title, "text" or number of digits]; state: {sort, descending}.
function sortingHead(columns, state, sortBy) {
  return element(
      'tr', {},
      ...columns.map(
          ([key, title, kind], i) => element(
              'th', {
                scope: 'col',
                class: `${kind === 'text' ? 'text' : ''}${i ? '' : ' first'}`,
                'aria-sort': state.sort === key ? (state.descending ? 'descending' : 'ascending') : 'none',
              },
              element('button', {type: 'button', 'data-key': key, onclick: () => sortBy(key)}, title))));
}
function sorted(rows, {sort, descending}) {
  const order = (a, b) => typeof a === 'string' ? a.localeCompare(b, 'en', {numeric: true}) : (a ?? Infinity) - (b ?? Infinity) || 0;
  return rows.map((row, i) => [row, i])
      .sort(([a, i], [b, j]) => (descending ? -1 : 1) * order(a[sort], b[sort]) || i - j)
      .map(([row]) => row);
}
// Sorts by a key, or reverses the order if it is already the key. The pressed button keeps the focus.
function sortTable(table, state, key, redraw) {
  const had = document.activeElement?.dataset?.key === key;
  state.descending = state.sort === key && !state.descending;
  state.sort = key;
  redraw();
  if (had) table.querySelector(`button[data-key="${key}"]`).focus();
}
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  $('theme').textContent = theme === 'dark' ? 'Light' : 'Dark';
  $('theme').setAttribute('aria-label', theme === 'dark' ? 'Switch to light colours' : 'Switch to dark colours');
}
$('theme').addEventListener('click', () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
setTheme(matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
