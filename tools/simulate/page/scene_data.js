// SPDX-License-Identifier: GPL-3.0-or-later
// The run as the page has it: its frames, and the state of all objects at one of them.
'use strict';

const POSE = 7;      // floats of a pose: w x y z, then the place of the model's centre
const CONTACT = 8;   // floats: point, normal, bounds of the distance
const DISTANCE = 8;  // floats: two points, bounds of the distance
const KINDS = ['ends', 'stays', 'begins'];
const REASONS = ['moved', 'removed', 'relayered', 'paused', 'unchanged'];

const read_json = (id) => JSON.parse(document.getElementById(id).textContent);

// A model's triangles. `numbers` are their source numbers, or null if those are 0, 1, ...
function unpack_model(packed) {
  if (!packed) return null;
  const numbers = packed.numbers ? unpack(packed.numbers, Uint32Array) : null;
  return {positions: unpack(packed.positions, Float32Array),
          indices: unpack(packed.indices, Uint32Array),
          lit: packed.lit === undefined ? null : unpack(packed.lit, Float32Array),
          place: numbers && new Map([...numbers].map((number, i) => [number, i]))};
}

function unpack_topology(packed) {
  const numbers = unpack(packed.numbers, Uint32Array);
  return {indices: unpack(packed.indices, Uint32Array),
          place: new Map([...numbers].map((number, i) => [number, i]))};
}

function unpack_frame(packed) {
  return {...packed,
          moved: unpack(packed.moved, Uint32Array), poses: unpack(packed.poses, Float32Array),
          lit: packed.lit.map(([object, numbers]) => [object, unpack(numbers, Uint32Array)]),
          hits: unpack(packed.hits, Uint32Array),
          contact_objects: unpack(packed.contact_objects, Uint32Array),
          contacts: unpack(packed.contacts, Float32Array),
          distance_objects: unpack(packed.distance_objects, Uint32Array),
          distances: unpack(packed.distances, Float32Array),
          shapes: packed.shapes.map(([changing, torn, positions]) =>
              ({changing, torn, positions: unpack(positions, Float32Array)}))};
}

class SceneRun {
  constructor(data, models, frames) {
    Object.assign(this, data);
    this.triangles_of_models = models.map(unpack_model);
    this.shown = frames.map(unpack_frame);
    this.event_words = unpack(data.events, Uint32Array);
    this.event_count = this.event_words.length / 4;
    // The objects that deform or tear, and the triangles of each live model: at rest, and torn.
    this.changing_of = new Map(this.changing.flatMap((one, i) =>
        one ? one.objects.map((object) => [object, i]) : []));
    this.topologies = this.changing.map((one) => one && one.topologies.map(unpack_topology));
    this.span_starts = [];
    let start = 0;
    for (const count of data.spans.frames) {
      this.span_starts.push(start);
      start += count;
    }
    this.rewind();
    this.seek(0);
  }

  rewind() {
    this.at = -1;
    this.poses = new Float32Array(this.objects.length * POSE);
    this.present = new Uint8Array(this.objects.length);
    this.shapes = new Map();
  }

  get now() { return this.shown[this.at]; }
  get frame() { return this.now.frame; }
  time_s(frame) { return frame * this.step_s; }

  // Goes to a shown frame. Frames say what changed, so that all up to it are applied.
  seek(index) {
    if (index < this.at) this.rewind();
    while (this.at < index) {
      const next = this.shown[++this.at];
      next.moved.forEach((object, i) => {
        this.poses.set(next.poses.subarray(i * POSE, (i + 1) * POSE), object * POSE);
        this.present[object] = 1;
      });
      for (const shape of next.shapes) this.shapes.set(shape.changing, shape);
    }
  }

  // The triangles of an object as they are now, or null if it is not drawn. Positions are in its own
  // coordinates. `place` has the places of source numbers; null where these are 0, 1, ...
  triangles_of(object) {
    const changing = this.changing_of.get(object);
    if (changing === undefined) return this.triangles_of_models[this.objects[object][1]];
    const {torn, positions} = this.shapes.get(changing);
    return {...this.topologies[changing][torn], positions, lit: null};
  }

  // The shown frame nearest to a frame.
  nearest(frame) {
    let low = 0, high = this.shown.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.shown[middle].frame < frame) low = middle + 1;
      else high = middle;
    }
    const before = Math.max(0, low - 1);
    return frame - this.shown[before].frame < this.shown[low].frame - frame ? before : low;
  }

  span_of(frame) {
    return Math.min(Math.floor(frame / this.spans.frames[0]), this.span_starts.length - 1);
  }

  event(i) {
    const [frame, a, b, what] = this.event_words.subarray(i * 4, i * 4 + 4);
    return {frame, a, b, effect: what & 15, kind: KINDS[(what >> 4) & 3], reason: REASONS[what >> 6]};
  }

  // The first event not before a frame.
  event_at(frame) {
    let low = 0, high = this.event_count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.event_words[middle * 4] < frame) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  object_name(object) { return object < this.objects.length ? this.objects[object][0] : 'object ' + object; }

  // The time of a frame for the lane of an effect, in microseconds by span, and what it is the time
  // of. A stage with the effect's name is its own time; else all lanes show that of the step.
  time_of(effect) {
    const stage = this.spans.stages.indexOf(this.effects[effect].name);
    if (stage >= 0) return {us: this.spans.us.map((stages) => stages[stage]), of: 'own time'};
    const sum = (stages) => stages.reduce((x, y) => x + y, 0);
    return {us: this.spans.us.map(sum), of: 'step'};
  }
}
