// SPDX-License-Identifier: GPL-3.0-or-later
// The page around the picture: which mesh, which findings, what they mean.
'use strict';

const PRINTED_PLACES = 20;      // of each finding, on paper
const SEVERITIES = ['error', 'warning', 'note'];
const SIGN = {error: '\u25cf', warning: '\u25b2', note: '\u25a0'};

const page = JSON.parse(document.getElementById('page-data').textContent);
const state = {mesh: null, number: 0, view: null, open: new Set(), hidden: new Set(),
               severities: new Set(SEVERITIES), words: '', chosen: null};

// A limit may have ended the search for more.
const count_of = (finding) => (finding.lower ? 'at least ' : '') + whole(finding.count);

function to_page(point) {
  const {centre, exponent} = state.mesh.frame;
  return point.map((value, axis) => times_power(value - centre[axis], -exponent));
}
function to_model(point) {
  const {centre, exponent} = state.mesh.frame;
  return point.map((value, axis) => centre[axis] + times_power(value, exponent));
}

function colour_name(rule) {
  return '--rule-' + page.rules[rule].hue;
}
function swatch(rule, hidden) {
  const element = make('span', {class: 'swatch' + (hidden ? ' off' : ''), 'aria-hidden': 'true'});
  element.style.setProperty('--mark', 'var(' + colour_name(rule) + ')');
  return element;
}
function severity_sign(severity) {
  return make('span', {class: 'sign ' + severity, title: severity, role: 'img', 'aria-label': severity},
              SIGN[severity]);
}

// ---- Meshes

function open_mesh(index) {
  if (state.mesh && state.number === index) return;
  state.number = index;
  state.mesh = JSON.parse($('mesh-' + index).textContent);
  state.chosen = null;
  state.open = new Set();
  state.hidden = new Set(state.mesh.findings.filter((f) => f.severity === 'note').map((f) => f.rule));
  if (state.mesh.findings.length === 1) state.open.add(state.mesh.findings[0].rule);
  $('mesh-choice').value = String(index);
  $('earlier').disabled = index === 0;
  $('later').disabled = index === page.meshes.length - 1;
  draw_mesh(index);
  write_summary();
  write_verdict();
  write_severities();
  write_rows();
  write_detail();
}

function draw_mesh(index) {
  const mesh = state.mesh;
  const drawable = mesh.drawn !== null;
  $('nothing').hidden = drawable && state.view !== null;
  $('nothing-text').textContent = mesh.error ? mesh.error : drawable
      ? 'The mesh cannot be drawn, because this browser has no WebGL. The list still shows all ' +
        'findings.'
      : 'There is no triangle to draw.';
  $('tools').hidden = !drawable || !state.view;
  $('partial').hidden = !drawable || mesh.drawn.whole || !state.view;
  if (!state.view) return;
  if (!drawable) {
    state.view.clear();
    state.view.half.set(1, 1, 1);
      state.view.restyle();
    return;
  }
  const part = (name, Kind) => unpack($('mesh-' + index + '-' + name).textContent, Kind);
  state.view.set_mesh({
    positions: part('positions', Float32Array), indices: part('indices', Uint32Array),
    ghost_positions: part('ghost-positions', Float32Array),
    ghost_indices: part('ghost-indices', Uint32Array),
    half: mesh.drawn.half, whole: mesh.drawn.whole});
  state.view.canvas.setAttribute('aria-label', 'The mesh ' + mesh.name + ' with its findings marked');
  $('partial').textContent = 'Too large to draw completely: ' + whole(mesh.drawn.triangles) + ' of ' +
      whole(mesh.triangles) + ' triangles, around the findings, are drawn exactly. ' +
      'The faint surface is a coarse approximation of the rest.';
  for (const finding of mesh.findings) {
    state.view.set_marks(finding.rule, new Marks(finding.marks), colour_name(finding.rule));
  }
  show_marks();
  press('edges', state.view.showing.edges);
  press('glass', state.view.showing.glass);
}

function show_marks() {
  if (!state.view) return;
  for (const finding of state.mesh.findings) {
    const shown = passes(finding) && !state.hidden.has(finding.rule);
    state.view.show_marks(finding.rule, shown);
  }
}

// ---- Findings

function passes(finding) {
  return state.severities.has(finding.severity) &&
      (!state.words || state.words.split(/\s+/).every((word) => rule_text(finding).includes(word)) ||
       finding.places.some((place) => place_passes(finding, place)));
}
function rule_text(finding) {
  const rule = page.rules[finding.rule];
  return (finding.rule + ' ' + rule.name + ' ' + rule.title).toLowerCase();
}
function place_passes(finding, place) {
  if (!state.words) return true;
  const text = rule_text(finding) + ' ' + node_of(place).toLowerCase();
  return state.words.split(/\s+/).every((word) => text.includes(word));
}
function node_of(place) {
  return place.n === undefined ? '' : state.mesh.nodes[place.n];
}

function write_rows() {
  const rows = [];
  for (const finding of state.mesh.findings) {
    if (!passes(finding)) continue;
    rows.push({finding});
    if (!state.open.has(finding.rule)) continue;
    finding.places.forEach((place, index) => {
      if (place_passes(finding, place)) rows.push({finding, place, index});
    });
    if (finding.places.length < finding.count) rows.push({finding, rest: true});
  }
  list.set_rows(rows);
  $('found-nothing').hidden = rows.length > 0;
  $('found-nothing').textContent = state.mesh.error ? 'The file could not be read: ' + state.mesh.error
      : state.mesh.findings.length ? 'No finding passes the filter.' : 'Nothing was found.';
}

function paint_row(row, element) {
  const {finding, place} = row;
  const chosen = state.chosen && state.chosen.rule === finding.rule && place &&
      state.chosen.index === row.index;
  element.setAttribute('aria-selected', chosen ? 'true' : 'false');
  element.setAttribute('aria-level', place || row.rest ? '2' : '1');
  if (row.rest) {
    element.classList.add('rest');
    element.append('and ' + whole(finding.count - finding.places.length) + ' more, not listed');
  } else if (place) {
    element.classList.add('place');
    element.append(make('span', {class: 'ordinal'}, String(row.index + 1)),
                   make('span', {class: 'where'}, place_words(place)),
                   make('span', {class: 'measure'}, has_measure(finding) ? number(place.m) : ''));
  } else {
    paint_rule(finding, element);
  }
}

function paint_rule(finding, element) {
  const hidden = state.hidden.has(finding.rule);
  element.classList.add('rule');
  element.setAttribute('aria-expanded', state.open.has(finding.rule) ? 'true' : 'false');
  const shows = make('button', {class: 'shows', type: 'button', tabindex: '-1',
    'aria-pressed': hidden ? 'false' : 'true', title: hidden ? 'Show its marks' : 'Hide its marks',
    onclick: (event) => { event.stopPropagation(); toggle_marks(finding.rule); }},
    swatch(finding.rule, hidden));
  element.append(make('span', {class: 'twist', 'aria-hidden': 'true'}), shows,
                 severity_sign(finding.severity),
                 make('span', {class: 'title'}, page.rules[finding.rule].title),
                 make('span', {class: 'id'}, finding.rule),
                 make('span', {class: 'count'}, count_of(finding)));
}

function toggle_marks(rule) {
  if (state.hidden.has(rule)) state.hidden.delete(rule);
  else state.hidden.add(rule);
  show_marks();
  list.draw();
}

function has_measure(finding) {
  return page.rules[finding.rule].measure !== '';
}
function some(numbers, total, one, many) {
  if (!total) return '';
  const shown = numbers.slice(0, 3).map(String).join(', ');
  return (total === 1 ? one : many) + ' ' + shown + (total > 3 ? ', \u2026 (' + whole(total) + ')' : '');
}
function place_words(place) {
  const words = [some(place.t, place.nt, 'triangle', 'triangles'),
                 some(place.v, place.nv, 'vertex', 'vertices')].filter((text) => text);
  return words.join(' \u00b7 ') || 'the whole mesh';
}

function act(row) {
  if (row.place) return choose(row.finding.rule, row.index);
  if (!row.rest) fold(row, !state.open.has(row.finding.rule));
  state.chosen = {rule: row.finding.rule, index: null};
  if (state.view) state.view.choose(null, 0);
  write_detail();
  list.draw();
}

function fold(row, open) {
  if (open) state.open.add(row.finding.rule);
  else state.open.delete(row.finding.rule);
  if (!open && row.place) {
    list.active = list.rows.findIndex((other) => other.finding === row.finding && !other.place);
  }
  write_rows();
  list.activate(list.active);
}

// Goes to a place: the row, the camera, the words and the address.
function choose(rule, index, fly = true) {
  const finding = state.mesh.findings.find((other) => other.rule === rule);
  if (!finding || !finding.places[index]) return;
  if (!passes(finding) || !place_passes(finding, finding.places[index])) forget_filter();
  state.chosen = {rule, index};
  state.open.add(rule);
  write_detail();  // takes room from the list
  write_rows();
  list.activate(list.rows.findIndex((row) => row.finding === finding && row.index === index), true);
  if (state.view) {
    state.view.choose(rule, index);
    if (fly) state.view.fly_to(rule, index);
  }
  write_address(false);
}

function step_place(by) {
  const places = list.rows.filter((row) => row.place);
  if (!places.length) {
    for (const finding of state.mesh.findings) if (passes(finding)) state.open.add(finding.rule);
    write_rows();
  }
  const open = list.rows.filter((row) => row.place);
  if (!open.length) return;
  const at = state.chosen
      ? open.findIndex((row) => row.finding.rule === state.chosen.rule && row.index === state.chosen.index)
      : -1;
  const next = open[at < 0 ? 0 : (at + by + open.length) % open.length];
  choose(next.finding.rule, next.index);
}

function forget_filter() {
  state.words = '';
  $('words').value = '';
  state.severities = new Set(SEVERITIES);
  write_severities();
  show_marks();
}

function write_severities() {
  $('severities').replaceChildren(...SEVERITIES.map((severity) => {
    const count = page.meshes[state.number][severity];
    return make('button', {type: 'button', class: 'severity ' + severity, disabled: !count,
      'aria-pressed': state.severities.has(severity) ? 'true' : 'false',
      title: 'Show or hide ' + severity + 's',
      onclick: () => {
        if (state.severities.has(severity)) state.severities.delete(severity);
        else state.severities.add(severity);
        write_severities();
        write_rows();
        show_marks();
      }}, make('span', {class: 'sign ' + severity, 'aria-hidden': 'true'}, SIGN[severity]),
          ' ' + plural(count, severity, severity + 's'));
  }));
}

// ---- Words about what is chosen

function write_detail() {
  const holder = $('detail');
  holder.hidden = !state.chosen;
  if (!state.chosen) return holder.replaceChildren();
  const finding = state.mesh.findings.find((other) => other.rule === state.chosen.rule);
  const rule = page.rules[finding.rule];
  const place = state.chosen.index === null ? null : finding.places[state.chosen.index];
  const facts = make('dl', {});
  const fact = (name, text) => {
    if (text) facts.append(make('dt', {}, name), make('dd', {}, text));
  };
  if (place) {
    fact('Triangles', all_of(place.t, place.nt));
    fact('Vertices', all_of(place.v, place.nv));
    fact('Position', place.p.map(number).join(', '));
    fact('Node', node_of(place));
    if (has_measure(finding)) fact('Measure', number(place.m) + ' (' + rule.measure + ')');
  }
  const explained = make('dl', {class: 'explained'});
  for (const [name, text] of [['What it is', rule.meaning], ['Why it matters', rule.why],
                              ['Remedy', rule.remedy], ['Decided', rule.decided]]) {
    explained.append(make('dt', {}, name), make('dd', {}, text));
  }
  holder.replaceChildren(
      make('h3', {}, swatch(finding.rule, false), severity_sign(finding.severity), rule.title,
           make('span', {class: 'id'}, finding.rule + (place ? ' / ' + (state.chosen.index + 1) : ''))),
      facts, explained);
  holder.scrollTop = 0;
}
function all_of(numbers, total) {
  if (!total) return '';
  return numbers.slice(0, 60).join(', ') + (total > Math.min(60, numbers.length)
      ? ', \u2026 (' + whole(total) + ' in all)' : '');
}

// ---- Verdict

const UNDEFINED = 'not defined';
const FACT = {closed: 1, two_manifold: 2, oriented: 4, orientable: 8, balanced: 16, inverted: 32,
              examined: 64, crossing: 128};
const PROMISES = [
  [1, 'Collide, overlap, distance, within, ray and closest point are exact on its surface.', ''],
  [2, 'Inside is decided exactly, by a winding number.',
   'Inside is not defined everywhere: there are edges whose windings do not cancel.'],
  [4, 'It is a simple solid: the winding number is 0 or 1, and the volume is what it encloses.',
   'It is not proven to be a simple solid: the volume may count parts twice or miss some.'],
  [8, 'Convex pieces of its surface can lie inside it.',
   'It is not guaranteed that convex pieces stay inside it.'],
];

function facts_of(verdict) {
  const has = (name) => (verdict.facts & FACT[name]) !== 0;
  // Open without a boundary: of no triangles there is nothing to say.
  if ((verdict.facts & ~FACT.examined) === 0 && verdict.loops === 0) return [[false, '', 'no triangles']];
  return [
    [has('closed'), 'closed', 'open'],
    [has('two_manifold'), '2-manifold', 'not 2-manifold'],
    [has('oriented'), 'oriented', has('orientable') ? 'not oriented' : 'not orientable'],
    has('examined') ? [!has('crossing'), 'no crossing', 'crosses itself'] : [null, '', 'crossings not examined'],
    ...(has('inverted') ? [[false, '', 'inside out']] : []),
  ];
}
function chips(verdict) {
  return facts_of(verdict).map(([good, yes, no]) =>
    make('span', {class: 'chip ' + (good ? 'yes' : good === null ? 'unknown' : 'no')},
         (good ? '\u2713 ' : good === null ? '? ' : '\u2717 ') + (good ? yes : no)));
}
function verdict_values(verdict) {
  return {Triangles: whole(verdict.triangles), 'Boundary loops': whole(verdict.loops),
          'Euler characteristic': whole(verdict.euler),
          Genus: verdict.genus < 0 ? UNDEFINED : whole(verdict.genus),
          Area: number(verdict.area),
          Volume: verdict.facts & FACT.balanced ? number(verdict.volume) : UNDEFINED};
}

function write_summary() {
  const mesh = state.mesh;
  $('mesh-name').textContent = mesh.name;
  $('mesh-name').title = mesh.name;
  $('sizes').textContent = mesh.error ? 'could not be read'
      : plural(mesh.triangles, 'triangle', 'triangles') + ', ' + plural(mesh.vertices, 'vertex', 'vertices') +
        (mesh.components > 1 ? ', ' + whole(mesh.components) + ' components' : '');
  $('chips').replaceChildren(...(mesh.verdicts.length ? chips(mesh.verdicts[0]) : []));
}

function write_verdict() {
  const mesh = state.mesh;
  const parts = [];
  if (!mesh.verdicts.length) parts.push(make('p', {}, 'There is no verdict.'));
  else {
    const verdict = mesh.verdicts[0];
    parts.push(make('h3', {}, 'The whole mesh'), make('div', {class: 'chips'}, ...chips(verdict)),
               make('ul', {class: 'promises'}, ...PROMISES.map(([bit, yes, no]) => {
                 const kept = (verdict.promises & bit) !== 0;
                 return make('li', {class: kept ? 'yes' : 'no'}, kept || !no ? yes : no);
               })), value_table(verdict));
    if (mesh.components > 1) parts.push(...component_table(mesh));
  }
  $('verdict').replaceChildren(...parts);
}
function value_table(verdict) {
  return make('table', {class: 'values'}, make('tbody', {}, ...Object.entries(verdict_values(verdict)).map(
    ([name, value]) => make('tr', {}, make('th', {scope: 'row'}, name), make('td', {}, value)))));
}
function component_table(mesh) {
  const components = mesh.verdicts.slice(1);
  const heading = make('h3', {}, plural(mesh.components, 'component', 'components'));
  const note = components.length < mesh.components
      ? make('p', {class: 'note'}, 'The first ' + whole(components.length) + ' of ' +
             whole(mesh.components) + ', in the order of their lowest triangle.') : null;
  const names = ['', 'First', 'Triangles', 'Loops', 'Euler', 'Genus', 'Area', 'Volume'];
  const head = make('tr', {}, ...names.map((name) => make('th', {scope: 'col'}, name)), make('th', {scope: 'col'}, 'Facts'));
  const body = components.map((verdict, index) => make('tr', {},
    make('td', {}, make('button', {type: 'button', class: 'go', 'aria-label': 'Go to component ' + (index + 1),
      onclick: () => go_to_component(verdict)}, String(index + 1))),
    make('td', {}, whole(verdict.first)),
    ...Object.values(verdict_values(verdict)).map((value) => value === UNDEFINED
        ? make('td', {title: value}, '\u2013') : make('td', {}, value)),
    make('td', {}, facts_of(verdict).map(([good, yes, no]) => good ? yes : no).join(', '))));
  return [heading, note, make('div', {class: 'wide'}, make('table', {class: 'components'},
          make('thead', {}, head), make('tbody', {}, ...body)))].filter((part) => part);
}
function go_to_component(verdict) {
  if (!state.view || !verdict.at) return;
  state.chosen = null;
  state.view.choose_spot(to_page(verdict.at));
  write_detail();
  list.draw();
}

// ---- The address: #mesh=2&CDP0301/3&camera=eye x,y,z,target x,y,z

function write_address(with_camera) {
  const terms = [];
  if (state.number > 0) terms.push('mesh=' + (state.number + 1));
  if (state.chosen && state.chosen.index !== null) {
    terms.push(state.chosen.rule + '/' + (state.chosen.index + 1));
  }
  if (with_camera && state.view) {
    const {camera, controls} = state.view;
    terms.push('camera=' + [...to_model(camera.position.toArray()), ...to_model(controls.target.toArray())]
        .map((value) => Number(value.toPrecision(9))).join(','));
  }
  const address = '#' + terms.join('&');
  if (address !== location.hash) history.replaceState(null, '', address);
}

function read_address() {
  const terms = decodeURIComponent(location.hash.slice(1)).split('&');
  const value = (name) => {
    const term = terms.find((other) => other.startsWith(name + '='));
    return term === undefined ? null : term.slice(name.length + 1);
  };
  const place = terms.map((term) => /^(CDP\d{4})(?:\/(\d+))?$/i.exec(term)).find((match) => match);
  const rule = place && place[1].toUpperCase();
  let index = Number(value('mesh')) - 1;
  if (!(index >= 0 && index < page.meshes.length)) {
    index = rule ? Math.max(0, page.meshes.findIndex((mesh) => mesh.rules.includes(rule))) : state.number;
  }
  open_mesh(index);
  const camera = (value('camera') || '').split(',').map(Number);
  const fixed = camera.length === 6 && camera.every(isFinite);
  if (place) choose(rule, Number(place[2] || 1) - 1, !fixed);
  if (fixed && state.view) {
    const eye = new THREE.Vector3().fromArray(to_page(camera.slice(0, 3)));
    state.view.move(eye, new THREE.Vector3().fromArray(to_page(camera.slice(3))), false);
  }
}

// ---- The label over the chosen place

function place_label() {
  const label = $('label');
  const chosen = state.view.chosen;
  const seen = chosen && state.view.project(chosen.at);
  label.hidden = !seen;
  if (!seen) return;
  label.style.transform = 'translate(' + seen[0] + 'px,' + seen[1] + 'px)';
  label.dataset.x = seen[0];
  label.dataset.y = seen[1];
  const rule = chosen.key;
  $('label-text').textContent = rule ? page.rules[rule].title + '  ' + rule + '/' + (chosen.place + 1)
                                     : 'component';
  label.style.setProperty('--mark', rule ? 'var(' + colour_name(rule) + ')' : 'var(--accent)');
  label.classList.toggle('left', seen[0] > $('view').clientWidth * 0.6);
}

// ---- Paper

function write_paper() {
  const picture = $('paper-picture');
  picture.hidden = !state.view || !state.mesh.drawn;
  if (!picture.hidden) picture.src = state.view.picture();
  const rows = [];
  for (const finding of state.mesh.findings) {
    const rule = page.rules[finding.rule];
    rows.push(make('h3', {}, swatch(finding.rule, false), severity_sign(finding.severity),
                   finding.rule + ' ' + rule.title + ': ' + count_of(finding)));
    rows.push(make('p', {}, rule.meaning));
    const places = finding.places.slice(0, PRINTED_PLACES);
    rows.push(make('ol', {}, ...places.map((place) => make('li', {}, place_words(place) + ' at ' +
        place.p.map(number).join(', ') + (has_measure(finding) ? '; ' + number(place.m) : '')))));
    if (finding.count > places.length) {
      rows.push(make('p', {}, 'and ' + whole(finding.count - places.length) + ' more.'));
    }
  }
  $('paper').replaceChildren(...rows);
}

// ---- Start

function use_keys(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (/^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  const keys = {n: () => step_place(1), p: () => step_place(-1), f: () => $('fit').click(),
                e: () => $('edges').click(), x: () => $('glass').click(), u: () => $('up').click(),
                '/': () => $('words').focus()};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
}

function start_view() {
  if (!has_webgl()) return document.body.classList.add('no-webgl');
  try {
    state.view = new View($('view'), (rule, index) => choose(rule, index, false));
  } catch (_) {
    return document.body.classList.add('no-webgl');
  }
  state.view.on_draw = place_label;
  $('fit').onclick = () => { state.view.choose(null, 0); state.view.fit(true); };
  $('edges').onclick = () => press('edges', state.view.toggle('edges'));
  $('glass').onclick = () => press('glass', state.view.toggle('glass'));
  $('up').onclick = () => {
    state.view.set_up(!state.view.z_up);
    $('up').textContent = state.view.z_up ? 'Z is up' : 'Y is up';
    state.view.fit(true);
  };
  $('link').onclick = () => write_address(true);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => state.view.restyle());
}

function start_choice() {
  const choice = $('mesh-choice');
  page.meshes.forEach((mesh, index) => {
    const found = mesh.failed ? 'could not be read'
        : SEVERITIES.filter((s) => mesh[s]).map((s) => plural(mesh[s], s, s + 's')).join(', ') || 'nothing found';
    choice.append(make('option', {value: index}, mesh.name + ' \u2014 ' + found));
  });
  const go = (index) => {
    open_mesh(index);
    write_address(false);
  };
  choice.onchange = () => go(Number(choice.value));
  $('earlier').onclick = () => go(state.number - 1);
  $('later').onclick = () => go(state.number + 1);
  $('choice').hidden = page.meshes.length < 2;
  $('mesh-name').hidden = page.meshes.length > 1;
}

const list = new RowList($('list'), paint_row, act, fold);

function start() {
  start_view();
  start_choice();
  $('words').oninput = () => {
    state.words = $('words').value.trim().toLowerCase();
    write_rows();
    show_marks();
  };
  new Tabs(['findings', 'verdict', 'about'], (name) => { if (name === 'findings') list.draw(); });
  document.addEventListener('keydown', use_keys);
  addEventListener('hashchange', read_address);
  addEventListener('beforeprint', write_paper);
  if (page.meshes.length) read_address();
  else $('found-nothing').textContent = 'No file was validated.';
}

start();
