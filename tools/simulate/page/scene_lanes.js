// SPDX-License-Identifier: GPL-3.0-or-later
// The lanes below the time bar: one for each effect that is computed.
'use strict';

const LANE_PX = 46;       // as scene_page.css has it
const LANE_TOP = 10;      // room for the marks of what begins
const LANE_BOTTOM = 36;   // and of what ends
const INSET = 8;          // half the thumb of the time bar
const FEW_MARKS = 300;    // more are drawn as strokes

const effect_colour = (effect) => 'var(--effect-' + effect.name + ', var(--effect-other))';

const most_of = (values) => values.reduce((x, y) => Math.max(x, y), 0);

function svg(tag, attributes, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

class Lanes {
  // go(frame) is a click.
  constructor(run, holder, go) {
    this.run = run;
    this.holder = holder;
    this.go = go;
    this.lanes = run.effects.flatMap((effect, i) => effect.asked ? [this.make_lane(effect, i)] : []);
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  make_lane(effect, number) {
    const swatch = make('span', {class: 'swatch', 'aria-hidden': 'true'});
    swatch.style.setProperty('--mark', effect_colour(effect));
    const now = make('span', {class: 'now', title: 'pairs of objects for which the effect holds now'});
    const time = this.run.time_of(number);
    const picture = svg('svg', {role: 'img', 'aria-label': this.words(effect, number)});
    this.holder.append(make('div', {class: 'lane', id: 'lane-' + effect.name},
        make('div', {class: 'lane-name'}, swatch, effect.name, now,
             make('small', {}, time.of + ' \u2264 ' + in_time(most_of(time.us)))),
        make('div', {class: 'lane-body'}, picture)));
    picture.addEventListener('click', (event) => this.go(this.frame_at(event)));
    picture.addEventListener('pointermove', (event) => this.hint(event, number));
    picture.addEventListener('pointerleave', () => { $('hint').hidden = true; });
    return {effect, number, now, picture, time};
  }

  words(effect, number) {
    const {begins, ends, holds} = this.run.spans;
    const sum = (rows) => rows.reduce((total, row) => total + row[number], 0);
    return effect.name + ': begins ' + plural(sum(begins), 'time', 'times') + ', ends ' +
        plural(sum(ends), 'time', 'times') + '; at most ' +
        plural(most_of(holds.map((row) => row[number])), 'pair', 'pairs') +
        ' of objects in a frame. The events are listed in the tab Events.';
  }

  get width() { return Math.max(40, this.lanes[0].picture.clientWidth); }

  x_of(frame) {
    const last = Math.max(1, this.run.frames - 1);
    return INSET + (this.width - 2 * INSET) * (this.run.frames > 1 ? frame / last : 0.5);
  }

  frame_at(event) {
    const box = event.currentTarget.getBoundingClientRect();
    const share = (event.clientX - box.left - INSET) / Math.max(1, box.width - 2 * INSET);
    return Math.round(Math.min(1, Math.max(0, share)) * (this.run.frames - 1));
  }

  draw() {
    for (const lane of this.lanes) this.draw_lane(lane);
    this.show(this.run.frame);
  }

  // The edges of a span on the page.
  edges(i) {
    const {span_starts, spans} = this.run;
    const low = this.x_of(span_starts[i] - 0.5), high = this.x_of(span_starts[i] + spans.frames[i] - 0.5);
    return [Math.max(0, low), Math.min(this.width, high)];
  }
  middle(i) {
    return this.x_of(this.run.span_starts[i] + (this.run.spans.frames[i] - 1) / 2);
  }

  // A curve that is level over each span.
  steps(values, most) {
    const height = (value) => LANE_BOTTOM - (LANE_BOTTOM - LANE_TOP) * value / Math.max(most, 1e-9);
    return values.map((value, i) => {
      const [low, high] = this.edges(i);
      return (i ? 'L' : 'M') + low.toFixed(1) + ' ' + height(value).toFixed(1) + 'H' + high.toFixed(1);
    }).join('');
  }

  draw_lane(lane) {
    const {picture, effect, number, time} = lane;
    const holds = this.run.spans.holds.map((row) => row[number]);
    const most = most_of(holds);
    const most_us = most_of(time.us);
    const colour = effect_colour(effect);
    const parts = [];
    if (most > 0) {
      const top = this.steps(holds, most);
      parts.push(svg('path', {class: 'area', style: 'fill:' + colour,
                              d: top + 'V' + LANE_BOTTOM + 'H' + this.edges(0)[0].toFixed(1) + 'Z'}),
                 svg('path', {class: 'top', style: 'stroke:' + colour, d: top}));
    }
    parts.push(svg('path', {class: 'us', d: this.steps(time.us, most_us)}));
    parts.push(this.marks('begins', this.run.spans.begins, number, colour),
               this.marks('ends', this.run.spans.ends, number, colour));
    picture.setAttribute('viewBox', '0 0 ' + this.width + ' ' + LANE_PX);
    picture.replaceChildren(...parts);
  }

  marks(kind, rows, number, colour) {
    const at = rows.flatMap((row, i) => row[number] > 0 ? [this.middle(i)] : []);
    const begins = kind === 'begins';
    const y = begins ? 1.5 : LANE_PX - 1.5;
    const away = begins ? 7 : -7;
    const d = at.map((x) => at.length > FEW_MARKS
        ? 'M' + x.toFixed(1) + ' ' + y + 'v' + away
        : 'M' + (x - 4).toFixed(1) + ' ' + y + 'h8l-4 ' + away + 'z').join('');
    const style = at.length > FEW_MARKS || !begins ? 'stroke:' + colour : 'fill:' + colour;
    return svg('path', {class: kind, style, d, 'data-count': at.length});
  }

  // Moves the cursor, and the counts beside the names.
  show(frame) {
    if (!this.lanes.length) return;
    const {holds} = this.run.spans;
    const exact = this.run.spans.frames[0] === 1;
    for (const {number, now} of this.lanes) {
      now.textContent = exact ? whole(holds[this.run.span_of(frame)][number]) : '';
    }
    const body = this.lanes[0].picture.getBoundingClientRect();
    const left = body.left - $('lanes').getBoundingClientRect().left;
    $('cursor').style.left = (left + this.x_of(frame) - 0.5).toFixed(1) + 'px';
  }

  hint(event, number) {
    const frame = this.frame_at(event);
    const i = this.run.span_of(frame);
    const {frames, begins, ends, holds, longest} = this.run.spans;
    const first = this.run.span_starts[i];
    const lane = this.lanes.find((one) => one.number === number);
    const when = frames[i] === 1 ? 'frame ' + whole(first)
                                 : 'frames ' + whole(first) + ' to ' + whole(first + frames[i] - 1);
    const lines = [when + ', ' + number_s(this.run.time_s(first)) + ' s',
                   (frames[i] === 1 ? '' : 'at most ') + plural(holds[i][number], 'pair', 'pairs') +
                       (begins[i][number] ? ', ' + whole(begins[i][number]) + ' begin' : '') +
                       (ends[i][number] ? ', ' + whole(ends[i][number]) + ' end' : ''),
                   in_time(lane.time.us[i]) + (frames[i] === 1 ? '' : ' a frame') +
                       (lane.time.of ? ' (' + lane.time.of + ')' : '') +
                       (frames[i] === 1 ? '' : ', longest ' + in_time(longest[i]))];
    const hint = $('hint');
    hint.textContent = lines.join('\n');
    hint.hidden = false;
    const area = $('lanes').getBoundingClientRect();
    const left = event.clientX - area.left;
    hint.style.left = Math.max(0, Math.min(left - hint.offsetWidth / 2, area.width - hint.offsetWidth)) + 'px';
    const row = event.currentTarget.getBoundingClientRect();
    hint.style.bottom = (area.bottom - row.top + 3) + 'px';
  }
}

const number_s = (value) => String(Number(value.toPrecision(6)));
const number_us = (value) => value >= 100 ? whole(Math.round(value)) : String(Number(value.toPrecision(3)));
const in_time = (us) => us < 1000 ? number_us(us) + ' us' : number_us(us / 1000) + ' ms';
