// The benchmark's page: one state object, and functions that draw each section from it.
(() => {
  const data = JSON.parse($('data').textContent);
  const state = {
    falloff: '',
    reference: '',
    size: '',
    cost: data.gpu ? 'cycles' : 'ms',
    quality: 'error',
    names: true,
    hidden: new Set(),
    marked: '',
    axis: '',
    sort: data.gpu ? 'cycles' : 'median',
    descending: false,
    filter: '',
    row: -1
  };

  const sizeOf = r => r.size ? r.size.join('x') : `${r.width}x${r.height}`;
  const methods = unique(data.rows.map(r => r.method));
  const colour = id => `var(--c${(1 + methods.indexOf(id)) % 10})`;
  const errorOf = (row, kind) => row.errors.find(e => e.reference === kind);
  // What the charts' axes can show.
  const COSTS = {
    cycles: {of: r => r.gpu?.cycles, text: `cycles for 64 pixels, ${data.gpu}`, name: 'GPU cycles'},
    ms: {of: r => r.milliseconds.median, text: `milliseconds, ${data.device}`, name: 'milliseconds'}
  };
  const QUALITIES = {
    error: {of: (r, kind) => errorOf(r, kind)?.eA, text: 'eA', name: 'error'},
    flicker: {of: r => r.flicker?.ofError, text: 'F_e', name: 'flicker'}
  };
  const ours = row => !row.baseline;
  const megabytes = bytes => (bytes * 1e-6).toFixed(1);

  // ---- marks and their tip ----
  function mark(row, x, y, radius = 5.5) {
    const common = {
      class: `dot${row.label === state.marked ? ' marked' : ''}`,
      fill: colour(row.method),
      tabindex: 0,
      role: 'button',
      'aria-label': tellOf(row).join(', ')
    };
    const dot = ours(row) ? svg('circle', {...common, cx: x, cy: y, r: radius}) :
                            svg('rect', {...common, x: x - radius, y: y - radius, width: 2 * radius, height: 2 * radius});
    for (const event of ['pointerenter', 'focus']) dot.addEventListener(event, () => tell(dot, tellOf(row)));
    for (const event of ['pointerleave', 'blur']) dot.addEventListener(event, () => $('tip').hidden = true);
    const choose = () => {
      state.row = data.rows.indexOf(row);
      state.marked = state.marked === row.label ? '' : row.label;
      draw();
    };
    dot.addEventListener('click', choose);
    dot.addEventListener('keydown', event => {
      if (event.key === 'Enter' || event.key === ' ') {
        event.preventDefault();
        choose();
      }
    });
    return dot;
  }
  function tellOf(row) {
    const errors = row.errors.map(e => `eA ${fixed(e.eA, 4)} ${e.reference}`).join(', ');
    return [
      `${row.label}${row.baseline ? ' (baseline)' : ''}`,
      row.gpu ? `${row.gpu.guessed ? '~' : ''}${row.gpu.cycles.toFixed(0)} cycles, ${row.gpu.waves} waves, at least ${
                    milliseconds(Math.max(row.gpu.ms_arithmetic, row.gpu.ms_memory))} ms at 1920x1080 on ${data.gpu}` :
                '',
      `${milliseconds(row.milliseconds.median)} ms, 95 % within ${milliseconds(row.milliseconds.p95)} ms`, errors,
      `${megabytes(row.bytes)} MB${row.flicker ? `, flicker of error ${fixed(row.flicker.ofError, 4)}` : ''}`
    ].filter(Boolean);
  }
  function tell(dot, [title, ...lines]) {
    const tip = $('tip'), at = dot.getBoundingClientRect();
    tip.replaceChildren(element('strong', {}, title), ...lines.flatMap(line => [line, element('br')]).slice(0, -1));
    tip.hidden = false;
    const most = document.documentElement.clientWidth - tip.offsetWidth - 8;
    tip.style.left = `${Math.max(8, Math.min(at.left + at.width / 2 - tip.offsetWidth / 2, most)) + scrollX}px`;
    tip.style.top = `${(at.top > tip.offsetHeight + 12 ? at.top - tip.offsetHeight - 8 : at.bottom + 8) + scrollY}px`;
  }

  // ---- charts with two logarithmic axes ----
  const WIDTH = 640, HEIGHT = 400, BOX = {left: 58, right: WIDTH - 14, top: 22, bottom: HEIGHT - 42};
  function axisOf(values, from, to) {
    const logs = values.map(Math.log10), middle = (Math.min(...logs) + Math.max(...logs)) / 2;
    const half = Math.max((Math.max(...logs) - Math.min(...logs)) * 0.56, 0.12), low = middle - half, high = middle + half;
    const at = v => from + (to - from) * (Math.log10(v) - low) / (high - low), ticks = [];
    const factors = high - low > 2.5 ? [1] :
        high - low > 1.2             ? [1, 2, 5] :
        high - low > 0.5             ? [1, 1.5, 2, 3, 4, 5, 7] :
                                       [1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9];
    for (let e = Math.floor(low); e <= high; ++e)
      for (const f of factors)
        if (Math.log10(f) + e >= low && Math.log10(f) + e <= high) ticks.push(f * 10 ** e);
    const gap = ticks.length > 9 ? 2 : 1;
    return {at, ticks: ticks.filter((_, i) => i % gap === 0)};
  }
  const tickText = v => v >= 1e6 ? `${+(v / 1e6).toPrecision(3)} M` :
      v >= 1e4 ? `${+(v / 1e3).toPrecision(3)} k` :
                 String(+v.toPrecision(3));
  function frame(x, y, across, up) {
    const root = svg('svg', {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'group'});
    for (const v of y.ticks)
      root.append(
          svg('line', {class: 'axis', x1: BOX.left, x2: BOX.right, y1: y.at(v), y2: y.at(v)}),
          svg('text', {class: 'soft', x: BOX.left - 6, y: y.at(v) + 4, 'text-anchor': 'end'}, tickText(v)));
    for (const v of x.ticks)
      root.append(
          svg('line', {class: 'axis', x1: x.at(v), x2: x.at(v), y1: BOX.top, y2: BOX.bottom}),
          svg('text', {class: 'soft', x: x.at(v), y: BOX.bottom + 16, 'text-anchor': 'middle'}, tickText(v)));
    root.append(
        svg('text', {class: 'soft', x: (BOX.left + BOX.right) / 2, y: HEIGHT - 6, 'text-anchor': 'middle'}, across),
        svg('text', {class: 'soft', x: 4, y: 12}, up));
    return root;
  }
  function names(root, dots) {
    const taken = [];
    for (const dot of dots.filter(d => d.named).sort((a, b) => a.x - b.x)) {
      const text = short(dot.row.label, 30), box = place({x: dot.x, y: dot.y - 9}, text.length * 6.6, taken, dots, BOX);
      if (!box) continue;
      taken.push(box);
      if (box.far)
        root.append(
            svg('line', {class: 'axis', x1: dot.x, y1: dot.y, x2: box.x > dot.x ? box.x - 2 : box.x + box.width + 2, y2: box.y - 4}));
      root.append(svg('text', {class: `halo${dot.row.label === state.marked ? ' chosen' : ''}`, x: box.x, y: box.y}, text));
    }
  }

  // ---- fronts ----
  function frontChart(front) {
    const cost = COSTS[state.cost], quality = QUALITIES[state.quality], kind = front.reference;
    const time = cost.of, error = r => Math.max(quality.of(r, kind), 1e-5);
    const all = front.rows.map(i => data.rows[i]).filter(r => time(r) > 0 && quality.of(r, kind) !== undefined);
    const shown = all.filter(r => !state.hidden.has(r.method));
    if (!shown.length) return element('p', {class: 'empty'}, all.length ? 'All methods are hidden.' : 'Not measured here.');
    const x = axisOf(shown.map(time), BOX.left, BOX.right), y = axisOf(shown.map(error), BOX.bottom, BOX.top);
    const root = frame(x, y, cost.text, quality.text), steps = [];
    let best = Infinity;  // builds the front of the shown rows
    for (const row of [...shown].sort((a, b) => time(a) - time(b) || error(a) - error(b)))
      if (error(row) < best) {
        best = error(row);
        steps.push(row);
      }
    const points = steps.flatMap((row, i) => (i ? [[time(row), error(steps[i - 1])]] : []).concat([[time(row), error(row)]]))
                       .map(([a, b]) => [x.at(a), y.at(b)]);
    root.append(
        svg('polyline', {class: 'front', points: [...points, [BOX.right, points[points.length - 1][1]]].map(p => p.join(',')).join(' ')}));
    const dots = shown.map(
        row => ({row, x: x.at(time(row)), y: y.at(error(row)), named: row.label === state.marked || (state.names && steps.includes(row))}));
    names(root, dots);
    for (const dot of dots.sort((a, b) => (a.row.label === state.marked) - (b.row.label === state.marked)))
      root.append(mark(dot.row, dot.x, dot.y));
    return root;
  }
  function drawFronts() {
    const list = data.fronts.filter(f => f.falloff === state.falloff && f.reference === state.reference && sizeOf(f) === state.size);
    $('fronts').replaceChildren(...list.map(front => {
      const caption = element(
          'figcaption', {}, element('strong', {}, front.scene),
          `${front.camera === 'own' ? '' : front.camera + ', '}${front.falloff}, ${front.reference}, ${sizeOf(front)}`);
      const verdict = !front.both || state.cost !== 'ms' || state.quality !== 'error' ?
          [] :
          front.gaps.length ?
          [element('ul', {class: 'gaps'}, ...front.gaps.map(g => element('li', {}, g)))] :
          [element(
              'ul', {class: 'gaps ahead'}, element('li', {}, 'One of ours has less error than every baseline method at every budget.'))];
      return element('figure', {}, caption, frontChart(front), ...verdict);
    }));
    if (!list.length) $('fronts').append(element('p', {class: 'empty'}, 'No errors were measured here.'));
  }
  const drawn = unique(data.fronts.flatMap(f => f.rows).map(i => data.rows[i].method));
  function drawMethods() {
    $('methods').replaceChildren(...drawn.map(id => {
      const isBaseline = data.rows.find(r => r.method === id).baseline,
            shape =
                isBaseline ? svg('rect', {width: 12, height: 12, fill: colour(id)}) : svg('circle', {cx: 6, cy: 6, r: 6, fill: colour(id)});
      const onclick = () => {
        state.hidden.has(id) ? state.hidden.delete(id) : state.hidden.add(id);
        draw();
        $('methods').querySelector(`[data-id="${id}"]`).focus();
      };
      return element(
          'button', {type: 'button', 'data-id': id, 'aria-pressed': String(!state.hidden.has(id)), onclick},
          svg('svg', {viewBox: '0 0 12 12', 'aria-hidden': 'true'}, shape), id);
    }));
  }

  // ---- scaling ----
  const UNITS = {pixels: 'pixels', radius: 'reach of the falloff, m', triangles: 'triangles'};
  function growthChart(lines) {
    const x = axisOf(lines.flatMap(l => l.x), BOX.left, BOX.right), y = axisOf(lines.flatMap(l => l.y), BOX.bottom, BOX.top);
    const root = frame(x, y, UNITS[state.axis] ?? state.axis, 'ms');
    lines.forEach((line, i) => {
      const stroke = `var(--c${(1 + i) % 10})`,
            ends = [line.x[0], line.x[line.x.length - 1]].map(v => `${x.at(v)},${y.at(line.factor * v ** line.exponent)}`);
      root.append(svg('polyline', {class: 'fit', stroke, points: ends.join(' ')}));
      line.x.forEach(
          (v, k) => root.append(
              svg('circle', {cx: x.at(v), cy: y.at(line.y[k]), r: 4, fill: stroke},
                  svg('title', {}, `${line.label}: ${milliseconds(line.y[k])} ms at ${tickText(v)}`))));
    });
    return root;
  }
  function drawGrowth() {
    const lines = data.fits.filter(f => f.axis === state.axis && !state.hidden.has(f.label.split(' ')[0]));
    $('growth').replaceChildren(...unique(lines.map(l => l.where)).map(where => {
      const here = lines.filter(l => l.where === where);
      const list = element(
          'table', {class: 'exponents'},
          element(
              'tbody', {},
              ...here.map(
                  (l, i) => element(
                      'tr', {}, element('td', {class: 'text', style: `--c: var(--c${(1 + i) % 10})`}, l.label),
                      element('td', {}, `${l.exponent.toFixed(2)} ± ${l.error.toFixed(2)}`)))));
      return element('figure', {}, element('figcaption', {}, where), growthChart(here), list);
    }));
    $('scaling').hidden = !data.fits.length;
  }

  // ---- tables ----
  const COLUMNS = [
    ['label', 'method', 'text'],
    ['scene', 'scene', 'text'],
    ['camera', 'camera', 'text'],
    ['size', 'size', 'text'],
    ['falloff', 'falloff', 'text'],
    ['cycles', 'cycles', 0],
    ['floor', 'floor, ms', 2],
    ['waves', 'waves', 0],
    ['median', 'ms', 2],
    ['p95', 'p95', 2],
    ['frame', 'frame', 2],
    ['mb', 'MB', 1],
    ['world', 'eA world', 4],
    ['screen', 'eA screen', 4],
    ['bias', 'bias', 4],
    ['ssim', 'SSIM', 3],
    ['flicker', 'F_e', 4],
  ];
  const flat = data.rows.map((r, index) => ({
                               index,
                               label: r.label,
                               scene: r.scene,
                               camera: r.camera,
                               size: sizeOf(r),
                               falloff: r.falloff,
                               cycles: r.gpu?.cycles,
                               floor: r.gpu && Math.max(r.gpu.ms_arithmetic, r.gpu.ms_memory),
                               waves: r.gpu?.waves,
                               median: r.milliseconds.median,
                               p95: r.milliseconds.p95,
                               frame: r.milliseconds.frame,
                               mb: r.bytes * 1e-6,
                               world: errorOf(r, 'world')?.eA,
                               screen: errorOf(r, 'screen')?.eA,
                               bias: errorOf(r, 'world')?.bias,
                               ssim: errorOf(r, 'world')?.ssim,
                               flicker: r.flicker?.ofError,
                             }));
  function drawTable() {
    const words = state.filter.toLowerCase().split(/\s+/).filter(Boolean);
    const rows = sorted(
        flat.filter(r => words.every(w => `${r.label} ${r.scene} ${r.camera} ${r.size} ${r.falloff}`.toLowerCase().includes(w))), state);
    $('table').tHead.replaceChildren(sortingHead(COLUMNS, state, key => sortTable($('table'), state, key, drawTable)));
    const show = row => {
      state.row = row.index;
      state.marked = row.label;
      draw();
    };
    const cell = (row, [key, , kind], i) => i === 0 ?
        element('td', {class: 'text first'}, element('button', {type: 'button', onclick: () => show(row)}, row.label)) :
        kind === 'text' ? element('td', {class: 'text'}, row[key]) :
                          element('td', {}, fixed(row[key], kind));
    $('table').tBodies[0].replaceChildren(
        ...rows.map(row => element('tr', {class: row.label === state.marked ? 'chosen' : ''}, ...COLUMNS.map((c, i) => cell(row, c, i)))));
    $('count').textContent = `${rows.length} of ${flat.length} rows`;
  }
  function drawPasses() {
    const row = data.rows[state.row];
    if (!row) return;
    $('passes-of').textContent = `${row.label}, ${row.scene} ${row.camera} ${sizeOf(row)} ${row.falloff}`;
    $('passes').tHead.replaceChildren(
        element('tr', {}, element('th', {class: 'text'}, 'pass'), element('th', {}, 'median, ms'), element('th', {}, 'p95, ms')));
    $('passes').tBodies[0].replaceChildren(...row.milliseconds.passes.map(
        p => element(
            'tr', {}, element('td', {class: 'text'}, p.name), element('td', {}, fixed(p.median, 3)), element('td', {}, fixed(p.p95, 3)))));
  }

  // ---- all of it ----
  function draw() {
    $('tip').hidden = true;
    drawMethods();
    drawFronts();
    drawGrowth();
    drawTable();
    drawPasses();
  }
  const choices = {
    falloff: unique(data.fronts.map(f => f.falloff)),
    reference: unique(data.fronts.map(f => f.reference)),
    size: unique(data.fronts.map(sizeOf)),
    axis: unique(data.fits.map(f => f.axis))
  };
  for (const [key, list] of Object.entries({cost: COSTS, quality: QUALITIES})) {
    const measured = Object.keys(list).filter(k => k !== 'cycles' || data.gpu);
    fill($(key), measured.map(k => [k, list[k].name]), state[key]);
    $(key).addEventListener('change', event => {
      state[key] = event.target.value;
      drawFronts();
    });
  }
  for (const [key, list] of Object.entries(choices)) {
    state[key] = list[0] ?? '';
    fill($(key), list.map(v => [v, v]), state[key]);
    $(key).addEventListener('change', event => {
      state[key] = event.target.value;
      draw();
    });
  }
  $('names').addEventListener('change', event => {
    state.names = event.target.checked;
    drawFronts();
  });
  $('filter').addEventListener('input', event => {
    state.filter = event.target.value;
    drawTable();
  });
  $('bar').addEventListener('submit', event => event.preventDefault());
  state.row = data.rows.findIndex(r => r.milliseconds.passes.length);
  $('command').textContent = data.command;
  $('about').textContent = data.rows.length ? `${unique(data.rows.map(r => r.label)).length} settings of ${methods.length} methods on ${
                                                  unique(data.rows.map(r => r.scene)).join(', ')}; ${data.rounds} rounds of ` +
          `${data.frames} frames, methods in turns, on ${data.device}.` :
                                              'Nothing was measured.';
  draw();
})();
