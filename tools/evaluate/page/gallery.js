// The accuracy gallery: one state object, and functions that draw each section from it.
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const REFERENCE = ' reference';  // name of the reference among the pictures
  const state = {
    shot: 0,
    falloff: '',
    reference: '',
    left: REFERENCE,
    right: '',
    range: data.errorRange,
    thumbs: 'pictures',
    sort: 'eA',
    descending: false,
    only: false,
    filter: '',
  };

  const shot = () => data.shots[state.shot];
  const shotTitle = s => `${s.scene}, ${s.camera}${s.time ? ` at ${+s.time.toFixed(2)} s` : ''}`;
  const methodIndex = id => Math.max(0, data.methods.findIndex(m => m.id === id));
  const colour = id => `var(--c${methodIndex(id) % 10})`;

  // ---- selection ----
  const reference = () => shot().references.find(r => r.kind === state.reference && r.falloff === state.falloff);
  const drawnOf = label => shot().drawn.find(d => d.label === label && d.falloff === state.falloff);
  const pictureOf = name => (name === REFERENCE ? reference() : drawnOf(name))?.picture;
  const titleOf = name => name === REFERENCE ? `${state.reference} reference` : name;
  const rowOf = label => shot().rows.find(r => r.label === label && r.falloff === state.falloff && r.reference === state.reference);
  const rowsHere = () => shot().rows.filter(r => r.falloff === state.falloff && r.reference === state.reference);
  const measured = rows => rows.filter(r => r.pixels);  // a view of sky alone has rows without errors
  const shownMethod = () => state.right !== REFERENCE ? state.right : state.left;  // the method whose error is shown
  const everyRow = data.shots.flatMap((s, index) => s.rows.map(row => ({...row, shot: index, all: row.milliseconds.all})));

  // ---- pictures as numbers ----
  const greys = new Map();
  function grey(uri) {
    if (!greys.has(uri))
      greys.set(uri, new Promise((resolve, reject) => {
                  const image = new Image();
                  image.onload = () => {
                    const canvas = element('canvas', {width: image.naturalWidth, height: image.naturalHeight});
                    const context = canvas.getContext('2d', {willReadFrequently: true});
                    context.drawImage(image, 0, 0);
                    const rgba = context.getImageData(0, 0, canvas.width, canvas.height).data, values = new Uint8Array(rgba.length / 4);
                    for (let i = 0; i < values.length; ++i) values[i] = rgba[4 * i];
                    resolve({width: canvas.width, height: canvas.height, values});
                  };
                  image.onerror = reject;
                  image.src = uri;
                }));
    return greys.get(uri);
  }
  // The ramp of false_colour.cpp.
  const DARK = [[12, 12, 16], [32, 96, 200], [190, 225, 255]], BRIGHT = [[12, 12, 16], [208, 88, 16], [255, 226, 170]];
  function errorColour(error, range) {
    const t = Math.min(Math.abs(error) / range, 1) * 2, stops = error < 0 ? DARK : BRIGHT, i = t < 1 ? 0 : 1, s = t - i;
    return stops[i].map((a, c) => a + s * (stops[i + 1][c] - a));
  }
  async function paintError(canvas, picture, against) {
    const wanted = canvas.wanted = {};  // a later call for the same canvas cancels this one
    const [a, r] = await Promise.all([grey(picture), grey(against)]);
    if (canvas.wanted !== wanted) return;
    const table = Array.from({length: 511}, (_, i) => errorColour((i - 255) / 255, state.range));
    canvas.width = a.width;
    canvas.height = a.height;
    const context = canvas.getContext('2d'), image = context.createImageData(a.width, a.height);
    for (let i = 0; i < a.values.length; ++i) {
      const c = table[a.values[i] - r.values[i] + 255];
      image.data[4 * i] = c[0];
      image.data[4 * i + 1] = c[1];
      image.data[4 * i + 2] = c[2];
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }

  // ---- the bar ----
  function choose(change) {
    Object.assign(state, change);
    const s = shot(), falloffs = unique(s.references.map(r => r.falloff));
    const kinds = falloff => unique(s.references.filter(r => r.falloff === falloff).map(r => r.kind));
    if (!falloffs.includes(state.falloff)) state.falloff = falloffs[0];
    if (!kinds(state.falloff).includes(state.reference)) state.reference = kinds(state.falloff)[0];
    const labels = unique(s.drawn.map(d => d.label));
    for (const side of ['left', 'right'])
      if (state[side] !== REFERENCE && !labels.includes(state[side])) state[side] = labels[labels.length - 1];
    fill($('shot'), data.shots.map((each, i) => [String(i), shotTitle(each)]), String(state.shot));
    fill($('falloff'), falloffs.map(f => [f, f]), state.falloff);
    fill($('reference'), kinds(state.falloff).map(k => [k, k]), state.reference);
    const names = [[REFERENCE, 'reference'], ...labels.map(l => [l, l])];
    fill($('left'), names, state.left);
    fill($('right'), names, state.right);
    drawCompare();
    drawGrid();
    drawCharts();
    drawTable();
  }

  // ---- comparison ----
  function drawCompare() {
    for (const side of ['left', 'right']) {
      const image = $(`picture-${side}`);
      image.src = pictureOf(state[side]) ?? '';
      image.alt = `Visibility: ${titleOf(state[side])}, ${shotTitle(shot())}, ${state.falloff}`;
      image.width = shot().size[0];
      image.height = shot().size[1];
      $(`tag-${side}`).textContent = titleOf(state[side]);
    }
    const label = shownMethod(), row = label === REFERENCE ? undefined : rowOf(label);
    $('error-title').textContent = row ? `${label} minus ${state.reference} reference` : 'Choose a method on either side';
    $('error').setAttribute('aria-label', `Error picture of ${titleOf(label)}`);
    if (pictureOf(label)) paintError($('error'), pictureOf(label), reference().picture);
    const numbers = row ?
        [
          ['eA', fixed(row.eA, 4)],
          ['e<5%', row.pixels ? `${fixed(100 * row.e5, 1)} %` : ''],
          ['bias', signed(row.bias, 4)],
          ['rmse', fixed(row.rmse, 4)],
          ['p99', fixed(row.p99, 3)],
          ['SSIM', fixed(row.ssim, 4)],
          ['FLIP', fixed(row.flip, 4)],
          ['g*', fixed(row.gamma, 2)],
          ['ms', milliseconds(row.milliseconds.all)],
        ] :
        [];
    $('numbers').replaceChildren(...numbers.map(([name, value]) => element('div', {}, element('dt', {}, name), element('dd', {}, value))));
    const ramp = $('ramp').getContext('2d');
    for (let i = 0; i < 256; ++i) {
      ramp.fillStyle = `rgb(${errorColour(i / 127.5 - 1, 1).map(Math.round)})`;
      ramp.fillRect(i, 0, 1, 1);
    }
  }

  // ---- small pictures ----
  function drawGrid() {
    const errors = state.thumbs === 'errors';
    $('show-pictures').setAttribute('aria-pressed', String(!errors));
    $('show-errors').setAttribute('aria-pressed', String(errors));
    const card = (name, picture, what) => {
      const [width, height] = shot().size, painted = errors && name !== REFERENCE;
      const view = painted ? element('canvas', {width, height}) : element('img', {src: picture, alt: '', loading: 'lazy', width, height});
      if (painted) paintError(view, picture, reference().picture);
      const onclick = () => choose({right: name, left: name === REFERENCE ? state.left : REFERENCE});
      return element(
          'button', {type: 'button', 'aria-pressed': String(state.right === name), 'data-name': name, onclick}, view,
          element('span', {class: 'name'}, titleOf(name)), element('span', {class: 'what'}, what));
    };
    const r = reference();
    const cards = [card(REFERENCE, r.picture, r.rays ? `${r.rays.toFixed(0)} rays, ±${fixed(r.error, 4)}` : 'from a file')];
    for (const row of rowsHere()) {
      const what = `eA ${fixed(row.eA, 4)} · SSIM ${fixed(row.ssim, 3)} · ${milliseconds(row.milliseconds.all)}\u00a0ms`;
      cards.push(card(row.label, drawnOf(row.label).picture, what));
    }
    $('grid').replaceChildren(...cards);
  }

  // ---- charts ----
  const WIDTH = 640, LEFT = 150, LINE = 24;
  function axis(maximum, scale, unit) {
    const step = [1, 2, 5, 10].map(f => f * 10 ** Math.floor(Math.log10(maximum / 4))).find(s => maximum / s <= 5) || maximum;
    const ticks = [];
    for (let v = 0; v <= maximum * 1.0001; v += step) ticks.push(v);
    return {ticks, text: v => `${+v.toPrecision(3)}${unit}`, x: scale};
  }
  function rowsChart(rows, maximum, unit, drawRow) {
    const height = rows.length * LINE + 30, x = v => LEFT + (WIDTH - LEFT - 64) * v / maximum, scale = axis(maximum, x, unit);
    const root = svg('svg', {viewBox: `0 0 ${WIDTH} ${height}`, role: 'img'});
    for (const v of scale.ticks)
      root.append(
          svg('line', {class: 'axis', x1: x(v), x2: x(v), y1: 0, y2: height - 24}),
          svg('text', {class: 'soft', x: x(v), y: height - 8, 'text-anchor': 'middle'}, scale.text(v)));
    rows.forEach((row, i) => {
      const y = i * LINE;
      const chosen = row.label === state.right ? 'mark chosen' : 'mark';
      const name =
          svg('text', {x: LEFT - 8, y: y + 16, 'text-anchor': 'end', class: chosen, onclick: () => choose({right: row.label})},
              short(row.label));
      name.append(svg('title', {}, row.label));
      root.append(name);
      drawRow(root, row, y, x);
    });
    return root;
  }
  function bar(x, y, width, fillColour, title, opacity = 1) {
    const rect = svg('rect', {x, y: y + 4, width: Math.max(width, 0.5), height: LINE - 8, fill: fillColour, opacity, rx: 2});
    rect.append(svg('title', {}, title));
    return rect;
  }
  function errorChart(rows) {
    const sorted = [...rows].sort((a, b) => a.eA - b.eA);
    return rowsChart(sorted, Math.max(...sorted.map(r => r.eA), 1e-4), '', (root, row, y, x) => {
      root.append(
          bar(x(0), y, x(row.eA) - x(0), colour(row.method), `${row.label}: eA ${fixed(row.eA, 4)}`),
          svg('text', {x: x(row.eA) + 6, y: y + 16}, fixed(row.eA, 4)));
    });
  }
  function framesChart(rows) {
    const all = measured(everyRow).filter(r => r.falloff === state.falloff && r.reference === state.reference);
    const lines = rows.map(row => ({...row, values: all.filter(r => r.label === row.label)}));
    for (const line of lines) line.mean = line.values.reduce((sum, r) => sum + r.eA, 0) / line.values.length;
    lines.sort((a, b) => a.mean - b.mean);
    return rowsChart(lines, Math.max(...all.map(r => r.eA), 1e-4), '', (root, line, y, x) => {
      const title = `${line.label}: mean eA ${fixed(line.mean, 4)} over ${line.values.length} frames`;
      root.append(bar(x(0), y, x(line.mean) - x(0), colour(line.method), title, 0.35));
      for (const value of line.values) {
        const onclick = () => choose({shot: value.shot, right: line.label}), r = value.shot === state.shot ? 5.5 : 3.5;
        const dot = svg('circle', {cx: x(value.eA), cy: y + LINE / 2, r, fill: colour(line.method), class: 'mark', onclick});
        dot.append(svg('title', {}, `${shotTitle(data.shots[value.shot])}: eA ${fixed(value.eA, 4)}`));
        root.append(dot);
      }
      root.append(svg('text', {class: 'soft', x: WIDTH - 4, y: y + 16, 'text-anchor': 'end'}, fixed(line.mean, 4)));
    });
  }
  function passesChart(rows) {
    const sorted = [...rows].sort((a, b) => a.milliseconds.all - b.milliseconds.all);
    return rowsChart(sorted, Math.max(...sorted.map(r => r.milliseconds.all), 1e-3), ' ms', (root, row, y, x) => {
      let at = 0;
      Object.entries(row.milliseconds.passes).forEach(([name, time], i) => {
        root.append(bar(x(at), y, x(at + time) - x(at) - 1, colour(row.method), `${name}: ${milliseconds(time)} ms`, i % 2 ? 0.55 : 1));
        at += time;
      });
      root.append(svg('text', {x: x(at) + 6, y: y + 16}, milliseconds(row.milliseconds.all)));
    });
  }
  function timeChart(all) {
    const rows = all.filter(r => r.milliseconds.all > 0 && r.method !== 'none');  // `none` takes no time
    if (!rows.length) return element('p', {class: 'empty'}, 'No times were measured.');
    const height = 360, bounds = {left: 54, right: WIDTH - 12, top: 14, bottom: height - 40};
    const times = rows.map(r => Math.log10(r.milliseconds.all)), errors = rows.map(r => r.eA);
    const low = Math.min(...times) - 0.2, high = Math.max(...times, low + 0.4) + 0.25;
    const spread = Math.max(Math.max(...errors) - Math.min(...errors), 0.004);
    const least = Math.max(0, Math.min(...errors) - 0.25 * spread), most = Math.max(...errors) + 0.25 * spread;
    const x = ms => bounds.left + (bounds.right - bounds.left) * (Math.log10(ms) - low) / (high - low);
    const y = e => bounds.bottom - (bounds.bottom - bounds.top) * (e - least) / (most - least);
    const root = svg('svg', {viewBox: `0 0 ${WIDTH} ${height}`, role: 'img'});
    const step = [1, 2, 5, 10].map(f => f * 10 ** Math.floor(Math.log10((most - least) / 4))).find(s => (most - least) / s <= 6);
    for (let v = Math.ceil(least / step) * step; v <= most; v += step)
      root.append(
          svg('line', {class: 'axis', x1: bounds.left, x2: bounds.right, y1: y(v), y2: y(v)}),
          svg('text', {class: 'soft', x: bounds.left - 6, y: y(v) + 4, 'text-anchor': 'end'}, String(+v.toPrecision(3))));
    for (let e = Math.floor(low); e <= high; ++e)
      for (const f of [1, 2, 5]) {
        const v = f * 10 ** e;
        if (Math.log10(v) >= low && Math.log10(v) <= high)
          root.append(
              svg('line', {class: 'axis', x1: x(v), x2: x(v), y1: bounds.top, y2: bounds.bottom}),
              svg('text', {class: 'soft', x: x(v), y: bounds.bottom + 16, 'text-anchor': 'middle'}, String(+v.toPrecision(3))));
      }
    root.append(
        svg('text', {class: 'soft', x: (bounds.left + bounds.right) / 2, y: height - 6, 'text-anchor': 'middle'},
            'milliseconds (logarithmic)'),
        svg('text', {class: 'soft', x: 4, y: bounds.top}, 'eA'));
    const dots = rows.map(row => ({row, x: x(row.milliseconds.all), y: y(row.eA)})), taken = [];
    for (const dot of [...dots].sort((a, b) => (b.row.label === state.right) - (a.row.label === state.right) || a.x - b.x)) {
      const {row} = dot, text = short(row.label, 26), box = place(dot, text.length * 6.8, taken, dots, bounds);
      const onclick = () => choose({right: row.label});
      const mark =
          svg('circle', {cx: dot.x, cy: dot.y, r: row.label === state.right ? 7 : 5, fill: colour(row.method), class: 'mark', onclick});
      mark.append(svg('title', {}, `${row.label}: eA ${fixed(row.eA, 4)}, ${milliseconds(row.milliseconds.all)} ms`));
      if (box) {
        taken.push(box);
        const end = box.x > dot.x ? box.x - 2 : box.x + box.width + 2;
        if (box.far) root.append(svg('line', {class: 'axis', x1: dot.x, y1: dot.y, x2: end, y2: box.y - 4}));
        root.append(svg('text', {x: box.x, y: box.y, class: row.label === state.right ? 'chosen' : ''}, text));
      }
      root.append(mark);
    }
    return root;
  }
  function drawCharts() {
    const rows = measured(rowsHere());
    const charts = {'chart-error': errorChart, 'chart-time': timeChart, 'chart-frames': framesChart, 'chart-passes': passesChart};
    for (const [id, make] of Object.entries(charts))
      $(id).replaceChildren(rows.length ? make(rows) : element('p', {class: 'empty'}, shot().remark || 'Nothing was measured here.'));
  }

  // ---- table ----
  const COLUMNS = [
    ['label', 'method', 'text'],
    ['scene', 'scene', 'text'],
    ['camera', 'camera', 'text'],
    ['falloff', 'falloff', 'text'],
    ['reference', 'reference', 'text'],
    ['eA', 'eA', 4],
    ['e5', 'e<5%', 3],
    ['bias', 'bias', 4],
    ['rmse', 'rmse', 4],
    ['p99', 'p99', 3],
    ['ssim', 'SSIM', 4],
    ['flip', 'FLIP', 4],
    ['gamma', 'g*', 2],
    ['all', 'ms', 2],
  ];
  function shownRows() {
    const words = state.filter.toLowerCase().split(/\s+/).filter(Boolean);
    const rows =
        everyRow.filter(r => !state.only || (r.shot === state.shot && r.falloff === state.falloff && r.reference === state.reference))
            .filter(
                r => words.every(
                    w => `${r.label} ${r.preset} ${r.scene} ${r.camera} ${r.falloff} ${r.reference}`.toLowerCase().includes(w)));
    return sorted(rows, state);
  }
  function show(row) {
    choose({shot: row.shot, falloff: row.falloff, reference: row.reference, left: REFERENCE, right: row.label});
    $('compare').scrollIntoView();
  }
  function drawTable() {
    const head = sortingHead(COLUMNS, state, key => sortTable($('table'), state, key, drawTable));
    const rows = shownRows(), worst = Math.max(...measured(rows).map(r => r.eA), 1e-6);
    const cell = (row, [key, , kind], i) => {
      if (i === 0) return element('td', {class: 'text first'}, element('button', {type: 'button', onclick: () => show(row)}, row.label));
      if (kind === 'text') return element('td', {class: 'text'}, row[key]);
      const value = key === 'bias' ? signed(row.bias, kind) : fixed(row[key], kind);
      return key === 'eA' ? element('td', {class: 'bar-cell', style: `--share:${(100 * (row.eA ?? 0) / worst).toFixed(1)}%`}, value) :
                            element('td', {}, value);
    };
    const chosen = row =>
        row.shot === state.shot && row.falloff === state.falloff && row.reference === state.reference && row.label === state.right;
    $('table').tHead.replaceChildren(head);
    const lines = rows.map(row => element('tr', {class: chosen(row) ? 'chosen' : ''}, ...COLUMNS.map((column, i) => cell(row, column, i))));
    $('table').tBodies[0].replaceChildren(...lines);
    $('count').textContent = `${rows.length} of ${everyRow.length} rows`;
  }

  // ---- events ----
  $('bar').addEventListener('submit', event => event.preventDefault());
  $('shot').addEventListener('change', event => choose({shot: +event.target.value}));
  for (const key of ['falloff', 'reference', 'left', 'right'])
    $(key).addEventListener('change', event => choose({[key]: event.target.value}));
  $('range').addEventListener('change', event => choose({range: +event.target.value}));
  $('split').addEventListener('input', event => $('slider').style.setProperty('--split', `${event.target.value}%`));
  $('show-pictures').addEventListener('click', () => {
    state.thumbs = 'pictures';
    drawGrid();
  });
  $('show-errors').addEventListener('click', () => {
    state.thumbs = 'errors';
    drawGrid();
  });
  $('only').addEventListener('change', event => {
    state.only = event.target.checked;
    drawTable();
  });
  $('filter').addEventListener('input', event => {
    state.filter = event.target.value;
    drawTable();
  });

  if (data.shots.length && everyRow.length) {
    const count = (number, noun) => `${number} ${noun}${number === 1 ? '' : 's'}`;
    const number = key => unique(everyRow.map(r => r[key])).length;
    $('about').textContent =
        `${count(number('method'), 'method')} (${count(number('label'), 'preset')}) on ${count(data.shots.length, 'frame')} ` +
        `of ${count(number('scene'), 'scene')} at ${data.shots[0].size.join(' × ')} px. Times: medians of ${data.frames} frames on ${
            data.device}.`;
    $('range').value = String(data.errorRange);
    choose({right: bestOf(data.shots[0])});
  } else {
    $('about').textContent = 'Nothing was measured.';
  }
  // The method with the least error on a frame; shown first.
  function bestOf(s) {
    const rows = s.rows.filter(r => r.falloff === s.references[0].falloff && r.reference === s.references[0].kind);
    return rows.reduce((best, row) => row.eA < (best.eA ?? Infinity) ? row : best, rows[0]).label;
  }
})();
