// SPDX-License-Identifier: GPL-3.0-or-later
// The page around the picture: playback, what holds now, events, objects and the plan.
'use strict';

const LISTED_PAIRS = 60;
const SHORTEST_S = 2, LONGEST_S = 120, PLAYED_S = 10;  // of a run in real time; else played in 10 s
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10];

const run = new SceneRun(read_json('scene-data'), read_json('model-data'), read_json('frame-data'));
const plan = read_json('plan-data');
const state = {view: null, playing: false, loop: true, speed: 1, base: 1, position: 0, last: 0,
               chosen: null, event: null};
const asked = run.effects.filter((effect) => effect.asked);

function effect_swatch(effect) {
  const element = make('span', {class: 'swatch', 'aria-hidden': 'true'});
  element.style.setProperty('--mark', effect_colour(effect));
  return element;
}
function layer_swatch(layer) {
  const element = make('span', {class: 'swatch', 'aria-hidden': 'true'});
  element.style.setProperty('--mark', 'var(' + layer_colour(layer) + ')');
  return element;
}
const seconds = (frame) => number_s(run.time_s(frame)) + ' s';
function in_bytes(bytes) {
  if (bytes < 1e4) return whole(bytes) + ' B';
  const [unit, name] = bytes < 1e6 ? [1e3, ' kB'] : [1e6, ' MB'];
  return Number((bytes / unit).toPrecision(3)) + name;
}

// ---- Going to a frame

// Goes to a shown frame.
function go_to(index) {
  run.seek(Math.min(run.shown.length - 1, Math.max(0, index)));
  state.position = run.frame;
  show_frame();
}
function go_to_frame(frame) {
  go_to(run.nearest(frame));
  write_address();
}

function show_frame() {
  const bar = $('bar');
  bar.value = run.frame;
  const words = 'frame ' + whole(run.frame) + ' of 0 to ' + whole(run.frames - 1) + ', ' + seconds(run.frame);
  bar.setAttribute('aria-valuetext', words);
  $('clock').textContent = words;
  if (state.view) state.view.show();
  lanes.show(run.frame);
  if (!$('panel-frame').hidden) write_frame();
}

// ---- Playback

function play(on) {
  state.playing = on;
  $('play').textContent = on ? 'Pause' : 'Play';
  $('clock').setAttribute('role', on ? 'presentation' : 'status');
  if (!on) return write_address();
  if (run.at === run.shown.length - 1) go_to(0);
  state.last = performance.now();
  requestAnimationFrame(tick);
}

function tick(now) {
  if (!state.playing) return;
  // A tab that was hidden does not jump.
  const passed = Math.min(250, Math.max(0, now - state.last)) / 1000;
  state.last = now;
  state.position += passed * state.speed * state.base / run.step_s;
  const last = run.frames - 1;
  if (state.position > last + 1) {
    if (!state.loop) {
      go_to(run.shown.length - 1);
      return play(false);
    }
    state.position = 0;
  }
  let index = run.at;
  if (state.position < run.frame) index = 0;
  while (index + 1 < run.shown.length && run.shown[index + 1].frame <= state.position) ++index;
  if (index !== run.at) {
    const {position} = state;
    go_to(index);
    state.position = position;
  }
  requestAnimationFrame(tick);
}

function step(by) {
  if (state.playing) play(false);
  go_to(run.at + by);
  write_address();
}

function step_event(by) {
  let i = by > 0 ? run.event_at(run.frame + 1) : run.event_at(run.frame) - 1;
  // An event between shown frames may lead to the present one.
  while (i >= 0 && i < run.event_count && run.nearest(run.event(i).frame) === run.at) i += by;
  if (i < 0 || i >= run.event_count) return;
  if (state.playing) play(false);
  go_to_frame(run.event(i).frame);
}

function start_playback() {
  const real = run.frames * run.step_s;
  state.base = real >= SHORTEST_S && real <= LONGEST_S ? 1 : real / PLAYED_S;
  for (const speed of SPEEDS) {
    const times = Number((speed * state.base).toPrecision(2));
    $('speed').append(make('option', {value: speed, selected: speed === 1},
                           times === 1 ? 'real time' : times + ' \u00d7 real time'));
  }
  $('speed').onchange = () => { state.speed = Number($('speed').value); };
  $('play').onclick = () => play(!state.playing);
  $('previous').onclick = () => step(-1);
  $('next').onclick = () => step(1);
  $('loop').onclick = () => {
    state.loop = !state.loop;
    press('loop', state.loop);
  };
  $('earlier-event').onclick = () => step_event(-1);
  $('later-event').onclick = () => step_event(1);
  const bar = $('bar');
  bar.max = run.frames - 1;
  bar.oninput = () => go_to_frame(Number(bar.value));
  bar.addEventListener('keydown', (event) => {
    const by = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10,
                Home: -Infinity, End: Infinity}[event.key];
    if (by === undefined) return;
    event.preventDefault();
    step(by);
  });
}

// ---- The tab of the present frame

function names_of_bits(bits) {
  return run.effects.filter((_, i) => bits >> i & 1);
}

function effect_table() {
  const now = run.now;
  const {spans} = run;
  const i = run.span_of(run.frame);
  const exact = spans.frames[0] === 1;
  const cell = (rows, effect) => exact ? whole(rows[i][effect]) : '\u2013';
  const rows = run.effects.map((effect, k) => effect.asked
      ? make('tr', {}, make('td', {}, effect_swatch(effect), effect.name),
             make('td', {class: 'holds'}, cell(spans.holds, k)),
             make('td', {}, cell(spans.begins, k)),
             make('td', {}, cell(spans.ends, k)),
             make('td', {}, whole(now.calls[k])))
      : make('tr', {class: 'off'}, make('td', {}, effect.name),
             make('td', {colspan: 4}, effect.is_replayed ? 'not computed: the poses are from the recording'
                                   : effect.is_dropped ? 'left out by --drop'
                                                       : 'not requested by any pair of layers')));
  const head = ['Effect', 'Pairs', 'Begin', 'End', 'Calls'].map((name) => make('th', {scope: 'col'}, name));
  return make('table', {class: 'plain', id: 'effect-table'}, make('thead', {}, make('tr', {}, ...head)),
              make('tbody', {}, ...rows));
}

function work_table() {
  const {counts, us, contacts, awake} = run.now;
  const rows = [['Objects that moved', whole(counts.moved)],
                ['Pairs whose boxes meet', whole(counts.candidates)],
                ['Of these, results kept', whole(counts.kept)],
                ['Of these, root boxes apart', whole(counts.apart)]];
  if (counts.unknown) rows.push(['Pairs for which it is unknown whether they collide', whole(counts.unknown)]);
  const asks = (name) => asked.some((effect) => effect.name === name);
  if (asks('overlap')) rows.push(['Pairs of triangles that touch', whole(counts.triangle_pairs)]);
  if (asks('contacts')) rows.push(['Contacts', whole(counts.contacts)]);
  if (awake !== undefined) rows.push(['Bodies awake', whole(awake)]);
  let least = Infinity;
  for (let i = 6; i < contacts.length; i += CONTACT) least = Math.min(least, contacts[i]);
  if (least < 0) rows.push(['Greatest depth, at most', number(Number((-least).toPrecision(5)))]);
  rows.push(['Time of the frame', in_time(us)]);
  return make('table', {class: 'values', id: 'work-table'}, make('tbody', {}, ...rows.map(([name, value]) =>
      make('tr', {}, make('th', {scope: 'row'}, name), make('td', {}, value)))));
}

function pair_list() {
  const {hits, distances, distance_objects} = run.now;
  const apart = new Map();
  for (let i = 0; i < distance_objects.length; i += 2) {
    apart.set(distance_objects[i] + ',' + distance_objects[i + 1], distances[i / 2 * DISTANCE + 7]);
  }
  const items = [];
  for (let i = 0; i < hits.length && items.length < LISTED_PAIRS; i += 3) {
    const [a, b, bits] = hits.subarray(i, i + 3);
    const upper = apart.get(a + ',' + b);
    items.push(make('li', {}, make('button', {type: 'button', onclick: () => choose(a, true)}, run.object_name(a)),
        ' \u2013 ', make('button', {type: 'button', onclick: () => choose(b, true)}, run.object_name(b)), ': ',
        names_of_bits(bits).map((effect) => effect.name).join(', ') +
        (upper === undefined ? '' : ', ' + number(Number(upper.toPrecision(5))) + ' apart')));
  }
  const rest = hits.length / 3 - items.length;
  if (rest > 0) items.push(make('li', {class: 'none'}, 'and ' + plural(rest, 'pair', 'pairs') + ' more'));
  return items.length ? make('ul', {class: 'pairs', id: 'pairs'}, ...items)
                      : make('p', {class: 'none', id: 'pairs'}, 'No effect holds for any pair of objects.');
}

function write_frame() {
  $('panel-frame').replaceChildren(
      make('h3', {}, 'Frame ' + whole(run.frame) + ', ' + seconds(run.frame)), effect_table(),
      make('h3', {}, 'Work'), work_table(), make('h3', {}, 'Pairs of objects'), pair_list());
}

// ---- Events

const KIND_SIGN = {begins: '\u25bc', ends: '\u25b3'};

function paint_event({i}, element) {
  const event = run.event(i);
  const effect = run.effects[event.effect];
  const sign = make('span', {class: 'mark', 'aria-hidden': 'true'}, KIND_SIGN[event.kind]);
  sign.style.color = effect_colour(effect);
  element.setAttribute('aria-selected', state.event === i ? 'true' : 'false');
  element.append(make('span', {class: 'when'}, whole(event.frame) + ' \u00b7 ' + seconds(event.frame)),
                 make('span', {class: 'kind'}, sign, effect.name + ' ' + event.kind),
                 make('span', {class: 'name wide'}, run.object_name(event.a) + ' \u2013 ' + run.object_name(event.b)));
  element.title = run.object_name(event.a) + ' \u2013 ' + run.object_name(event.b) + ': ' + event.reason;
}

function open_event({i}) {
  const event = run.event(i);
  state.event = i;
  if (state.playing) play(false);
  go_to_frame(event.frame);
  // The smaller one: the other may be the ground.
  const shown = [event.a, event.b].filter((object) => object < run.objects.length);
  const size = (object) => Math.hypot(...run.models[run.objects[object][1]].half);
  if (shown.length) choose(shown.reduce((x, y) => size(y) < size(x) ? y : x), false);
  events.draw();
}

function write_events() {
  const words = $('event-words').value.trim().toLowerCase();
  const rows = [];
  for (let i = 0; i < run.event_count; ++i) {
    const event = run.event(i);
    const text = run.object_name(event.a) + ' ' + run.object_name(event.b) + ' ' + run.effects[event.effect].name;
    if (!words || text.toLowerCase().includes(words)) rows.push({i});
  }
  $('event-count').textContent = words ? whole(rows.length) + ' of ' + plural(run.event_count, 'event', 'events')
      : plural(run.event_count, 'event', 'events') + ', all frames';
  events.set_rows(rows);
}

// ---- Objects

function paint_object({i}, element) {
  const [name, model, layer, is_asked] = run.objects[i];
  element.setAttribute('aria-selected', state.chosen === i ? 'true' : 'false');
  element.append(layer_swatch(layer), make('span', {class: 'name wide'}, name),
                 make('span', {class: 'quiet'}, run.layers[layer] + (is_asked ? '' : ', not queried')),
                 make('span', {class: 'quiet'}, run.models[model].name));
  element.title = name + ', layer ' + run.layers[layer] + ', ' + run.models[model].name;
}

function choose(object, fly) {
  state.chosen = object;
  if (state.view) state.view.choose_object(object, fly);
  objects.activate(objects.rows.findIndex(({i}) => i === object), true);
  objects.draw();
}

function write_objects() {
  const words = $('object-words').value.trim().toLowerCase();
  const rows = [];
  run.objects.forEach(([name, model, layer], i) => {
    const text = name + ' ' + run.layers[layer] + ' ' + run.models[model].name;
    if (!words || text.toLowerCase().includes(words)) rows.push({i});
  });
  $('object-count').textContent = (words ? whole(rows.length) + ' of ' : '') +
      plural(run.objects.length, 'object', 'objects');
  objects.set_rows(rows);
}

function write_layers() {
  $('layers').replaceChildren(...plan.layers.map(({name, objects}, i) =>
      make('span', {}, layer_swatch(i), name + ': ' + whole(objects))));
}

// ---- The plan

function pair_options(pair) {
  const words = [];
  if (pair.effects.includes('within')) words.push('tolerance ' + number(pair.tolerance));
  if (pair.effects.includes('distance')) words.push('at most ' + number(pair.max_distance));
  if (pair.rung) words.push('error at most ' + number(pair.rung.error) + ', by ' + (pair.rung.name === 'parts' ? 'enclosing parts' : 'BVH traversal'));
  if (pair.contacts) words.push('contacts within ' + number(pair.contacts.tolerance) + ', most ' + whole(pair.contacts.most));
  if (pair.body === 'solid') words.push('solids');
  if (pair.overlap === 'proper') words.push('proper overlap');
  return words.join('; ');
}

function model_sections(model) {
  const name = model.path.split('/').pop();
  const title = make('h3', {title: model.path}, name);
  if (!model.serves.length) {
    return [title, make('p', {class: 'none'}, 'Not opened: no pair of layers uses its objects.')];
  }
  const all = model.read_bytes + model.untouched_bytes;
  const share = make('div', {class: 'share', 'aria-hidden': 'true'}, make('i', {}));
  share.firstChild.style.width = 100 * model.read_bytes / Math.max(1, all) + '%';
  const section = (unused) => ({name: section_name, bytes}) => make('li', {class: unused ? 'unused' : false,
      title: (unused ? 'never touched: ' : 'read: ') + in_bytes(bytes)}, section_name);
  return [title,
          make('p', {class: 'note'}, plural(model.objects, 'object', 'objects') + ', ' + model.origin +
               '; must serve ' + model.serves.join(', ') + '. Read: ' +
               plural(model.read.length, 'section', 'sections') + ', ' + in_bytes(model.read_bytes) + '. Never touched: ' +
               (model.untouched.length ? plural(model.untouched.length, 'section', 'sections') + ', ' + in_bytes(model.untouched_bytes) : 'none') + '.'),
          share, make('ul', {class: 'sections'}, ...model.read.map(section(false)), ...model.untouched.map(section(true)))];
}

function write_plan() {
  const head = ['Layers', 'Effects', 'Options'].map((name) => make('th', {scope: 'col', class: 'text'}, name));
  const rows = plan.pairs.map((pair) => make('tr', {},
      make('td', {}, pair.layers.join(' \u2013 ')), make('td', {class: 'text'}, pair.effects.join(', ')),
      make('td', {class: 'text'}, pair_options(pair))));
  $('panel-plan').replaceChildren(
      make('h3', {}, 'Requested effects'),
      make('table', {class: 'plain'}, make('thead', {}, make('tr', {}, ...head)), make('tbody', {}, ...rows)),
      make('p', {}, not_computed_words() || 'Every effect is computed for some pair of layers.'),
      make('p', {class: 'note'}, 'Other pairs of layers are never tested.'),
      make('h3', {}, 'Sections read'),
      make('p', {class: 'note'}, 'Sections of the models that the plan needs. Grey sections are in the file, but are never read.'),
      ...plan.models.flatMap(model_sections),
      make('details', {}, make('summary', {}, 'The same as text'),
           make('pre', {class: 'plan-text'}, read_json('plan-text'))));
}

function not_computed_words() {
  const dropped = run.effects.filter((effect) => effect.is_dropped).map((effect) => effect.name);
  const unasked = plan.not_computed.filter((name) => !dropped.includes(name));
  const words = [];
  if (unasked.length) {
    words.push('Not requested by any pair of layers: ' + unasked.join(', ') + '.');
  }
  if (dropped.length) words.push('Left out by --drop: ' + dropped.join(', ') + '.');
  if (run.effects.some((effect) => effect.is_replayed)) {
    words.push('Response was not computed here: the poses are from the recording.');
  }
  return words.join(' ');
}

function write_costs() {
  const {spans} = run;
  const total = spans.frames.reduce((x, y) => x + y, 0);
  const rows = spans.stages.map((name, stage) => make('tr', {}, make('td', {}, name),
      make('td', {}, number_us(spans.us.reduce((sum, row, i) => sum + row[stage] * spans.frames[i], 0) / total)),
      make('td', {}, number_us(spans.us.reduce((most, row) => Math.max(most, row[stage]), 0)))));
  const most = spans.frames[0] === 1 ? 'Longest frame, us' : 'Slowest span, us a frame';
  const head = ['Stage', 'Mean, us a frame', most].map((name) => make('th', {scope: 'col'}, name));
  $('costs').replaceChildren(make('table', {class: 'plain'}, make('thead', {}, make('tr', {}, ...head)),
                                  make('tbody', {}, ...rows)),
      make('p', {class: 'note'}, 'Time of the library in this run, without poses, output and this page.'),
      ...changes_of_time());
}

// What --cost measured, if it did: how the time of all frames changes without an effect.
function changes_of_time() {
  const measured = run.effects.filter((effect) => 'change_of_time' in effect);
  if (!measured.length) return [];
  const percent = (share) => (100 * share).toFixed(1) + ' %';
  const rows = measured.map((effect) => make('tr', {}, make('td', {}, effect.name),
      make('td', {}, (effect.change_of_time > 0 ? '+' : '') + percent(effect.change_of_time)),
      make('td', {}, percent(effect.spread_of_time))));
  const head = ['Without', 'Change of time', 'Spread'].map((name) => make('th', {scope: 'col'}, name));
  return [make('h3', {}, 'Cost of each effect'),
          make('table', {class: 'plain', id: 'effect-costs'}, make('thead', {}, make('tr', {}, ...head)),
               make('tbody', {}, ...rows)),
          make('p', {class: 'note'}, 'Change of the time of all frames if the scene runs without the effect. It is the ' +
               'median of alternating rounds. The spread is the largest change minus the smallest.')];
}

// ---- The address: #frame=12&object=3

function write_address() {
  if (state.playing) return;
  const address = '#frame=' + run.frame;
  if (address !== location.hash) history.replaceState(null, '', address);
}
function read_address() {
  const match = /(?:^#|&)frame=(\d+)/.exec(location.hash);
  go_to(match ? run.nearest(Math.min(Number(match[1]), run.frames - 1)) : run.at);
}

// ---- The label of the chosen object

function place_label() {
  const label = $('label');
  const {chosen} = state.view;
  const seen = chosen && state.view.project(chosen.at);
  label.hidden = !seen;
  if (!seen) return;
  label.style.transform = 'translate(' + seen[0] + 'px,' + seen[1] + 'px)';
  const [name, , layer] = run.objects[chosen.object];
  $('label-text').textContent = name + '  \u00b7  ' + run.layers[layer];
  label.style.setProperty('--mark', 'var(--accent)');
  label.classList.toggle('left', seen[0] > $('view').clientWidth * 0.6);
}

// ---- Start

function start_view() {
  if (has_webgl()) {
    try {
      state.view = new SceneView($('view'), run, (object) => choose(object, false));
    } catch (error) {
      console.log(error);
    }
  }
  if (!state.view) {
    document.body.classList.add('no-webgl');
    $('nothing').hidden = false;
    return;
  }
  const {view} = state;
  view.on_draw = place_label;
  view.canvas.setAttribute('aria-label', 'The objects of ' + run.name + '. The tab Frame lists the effects that hold.');
  $('fit').onclick = () => { choose(null, false); view.fit(true); };
  $('edges').onclick = () => press('edges', view.toggle('edges'));
  $('glass').onclick = () => press('glass', view.toggle('glass'));
  const name_up = () => { $('up').textContent = view.z_up ? 'Z is up' : 'Y is up'; };
  name_up();
  $('up').onclick = () => {
    view.set_up(!view.z_up);
    name_up();
    view.fit(true);
  };
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => view.restyle());
}

function write_left_out() {
  if (!run.left_out.length) return;
  $('partial').hidden = false;
  $('partial').firstElementChild.textContent = 'This page leaves something out (' + whole(run.left_out.length) + ')';
  $('partial').lastElementChild.replaceChildren(...run.left_out.map((text) => make('li', {}, text)));
}

function use_keys(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (/^(SELECT|TEXTAREA)$/.test(event.target.tagName) || event.target.type === 'search') return;
  if (event.key === ' ' && /^(BUTTON|SUMMARY)$/.test(event.target.tagName)) return;
  const keys = {' ': () => play(!state.playing), ',': () => step(-1), '.': () => step(1),
                n: () => step_event(1), p: () => step_event(-1), l: () => $('loop').click(),
                f: () => $('fit').click(), e: () => $('edges').click(), x: () => $('glass').click(),
                u: () => $('up').click(),
                '/': () => { tabs.show('objects'); $('object-words').focus(); }};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
}

const lanes = new Lanes(run, $('effect-lanes'), (frame) => {
  if (state.playing) play(false);
  go_to_frame(frame);
});
const events = new RowList($('events'), paint_event, open_event, () => {});
const objects = new RowList($('objects'), paint_object, ({i}) => choose(i, true), () => {});
const tabs = new Tabs(['frame', 'events', 'objects', 'plan', 'cost', 'about'], (name) => {
  if (name === 'frame') write_frame();
  if (name === 'events') {
    events.draw();
    events.activate(events.rows.findIndex(({i}) => run.event(i).frame >= run.frame), true);
  }
  if (name === 'objects') objects.draw();
});

function start() {
  $('mesh-name').textContent = run.name;
  $('sizes').textContent = plural(run.object_count, 'object', 'objects') + ', ' +
      plural(run.frames, 'frame', 'frames') + ' of ' + number_s(run.step_s) + ' s';
  $('not-computed').textContent = not_computed_words();
  start_view();
  start_playback();
  write_left_out();
  write_plan();
  write_costs();
  write_layers();
  write_objects();
  write_events();
  $('event-words').oninput = write_events;
  $('object-words').oninput = write_objects;
  document.addEventListener('keydown', use_keys);
  addEventListener('hashchange', read_address);
  read_address();
}

start();
