// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: a surface, the marks upon it, and the camera that flies to them.
// Lengths here are page units: the box of the mesh is centred on the origin and its
// longest half side lies in [0.5, 1).
'use strict';

const FIELD_OF_VIEW = 40;       // degrees, of the height of the picture
const FLIGHT_MS = 450;
const PICK_PX = 14;             // how near a click must be to a place
const FLAT = 2e-3;              // double area by squared edge below which no fill is seen
const MANY = 150;               // marks of a finding that are drawn smaller from afar
const EDGES_BY_DEFAULT = 60000; // triangles above which edges are drawn only when asked for

// A segment as a band of constant width on the screen: WebGL draws lines one pixel wide
// only. `corner` is (end, side). A segment shorter than `least` pixels is drawn that long,
// so that no edge is too small to be seen. With `thin` set, a band is never wider than a
// part of its length. So outlines do not drown what they surround.
const BAND_VERTEX = `
  attribute vec3 other; attribute vec2 corner;
  uniform vec2 size; uniform float width; uniform float least; uniform float thin;
  uniform float bias; uniform float scale;
  void main() {
    vec4 a = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    vec4 b = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
    float front = 1e-6;
    if (a.w < front && b.w < front) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
    if (a.w < front) a = mix(b, a, (b.w - front) / (b.w - a.w));
    if (b.w < front) b = mix(a, b, (a.w - front) / (a.w - b.w));
    vec2 run = b.xy / b.w * size * 0.5 - a.xy / a.w * size * 0.5;
    float length_px = length(run);
    vec2 along = length_px > 1e-3 ? run / length_px : vec2(corner.x > 0.5 ? -1.0 : 1.0, 0.0);
    float side = corner.x > 0.5 ? -corner.y : corner.y;
    float half_width = 0.5 * (thin > 0.0 ? min(width, length_px * thin) : width) * scale;
    float reach = half_width + max(0.0, (least * scale - length_px) * 0.5);
    gl_Position = a;
    gl_Position.xy += (vec2(-along.y, along.x) * side * half_width - along * reach)
        / size * 2.0 * a.w;
    gl_Position.z -= bias * a.w;
  }`;

const PIN_VERTEX = `
  uniform float width; uniform float bias; uniform float scale;
  void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_Position.z -= bias * gl_Position.w;
    gl_PointSize = width * scale;
  }`;
const PIN_FRAGMENT = `
  uniform vec3 colour; uniform float opacity; uniform float dim;
  void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(colour, opacity * dim);
  }`;

const FILL_VERTEX = `
  uniform float bias;
  void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_Position.z -= bias * gl_Position.w;
  }`;
const PLAIN_FRAGMENT = `
  uniform vec3 colour; uniform float opacity; uniform float dim;
  void main() { gl_FragColor = vec4(colour, opacity * dim); }`;

// Marks are drawn before their depth by a part of it, about 25 times this. A band is wider
// than the segment it stands for, and would sink into the surface beside it.
const BIAS = {fill: 1e-4, outline: 2e-4, band: 1e-3, pin: 1.3e-3};

function css_colour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return new THREE.Color(text);
}

// Floats or whole numbers out of base64, little-endian as every machine with WebGL is.
function unpack(text, Kind) {
  const bytes = atob(text);
  const raw = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) raw[i] = bytes.charCodeAt(i);
  return new Kind(raw.buffer);
}

// Segments (six floats each) as bands: four corners and two triangles each.
function band_geometry(segments) {
  const count = segments.length / 6;
  const position = new Float32Array(count * 12);
  const other = new Float32Array(count * 12);
  const corner = new Float32Array(count * 8);
  const index = new Uint32Array(count * 6);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 4; ++k) {
      const end = k >> 1;
      for (let axis = 0; axis < 3; ++axis) {
        position[i * 12 + k * 3 + axis] = segments[i * 6 + end * 3 + axis];
        other[i * 12 + k * 3 + axis] = segments[i * 6 + (1 - end) * 3 + axis];
      }
      corner[i * 8 + k * 2] = end;
      corner[i * 8 + k * 2 + 1] = (k & 1) ? 1 : -1;
    }
    index.set([0, 1, 2, 2, 1, 3].map((k) => i * 4 + k), i * 6);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('other', new THREE.BufferAttribute(other, 3));
  geometry.setAttribute('corner', new THREE.BufferAttribute(corner, 2));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

function point_geometry(positions) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  return geometry;
}

// The outlines of triangles (nine floats each) as segments: of those with area, and of
// those that are seen only by them.
function outlines(triangles) {
  const full = [];
  const flat = [];
  for (let at = 0; at < triangles.length; at += 9) {
    const corner = [0, 3, 6].map((k) => new THREE.Vector3().fromArray(triangles, at + k));
    const sides = [0, 1, 2].map((k) => corner[(k + 1) % 3].clone().sub(corner[k]));
    const longest = Math.max(...sides.map((side) => side.lengthSq()));
    const has_area = sides[0].clone().cross(sides[1]).length() > longest * FLAT;
    for (let k = 0; k < 3; ++k) {
      if (!has_area && sides[k].lengthSq() === 0) continue;
      (has_area ? full : flat).push(...corner[k].toArray(), ...corner[(k + 1) % 3].toArray());
    }
  }
  return {full: new Float32Array(full), flat: new Float32Array(flat)};
}

// Nine floats for each triangle that may come this near to a point along every axis.
function triangles_around(drawn, target, reach) {
  const {positions, indices} = drawn;
  const near = [];
  const at = target.toArray();
  for (let i = 0; i < indices.length; i += 3) {
    const a = indices[i] * 3, b = indices[i + 1] * 3, c = indices[i + 2] * 3;
    let axis = 0;
    for (; axis < 3; ++axis) {
      const u = positions[a + axis] - at[axis];
      const v = positions[b + axis] - at[axis];
      const w = positions[c + axis] - at[axis];
      if ((u > reach && v > reach && w > reach) || (u < -reach && v < -reach && w < -reach)) break;
    }
    if (axis < 3) continue;
    for (const corner of [a, b, c]) {
      near.push(positions[corner], positions[corner + 1], positions[corner + 2]);
    }
  }
  return near;
}

// Whether one of these triangles lies between two points, not at once before the second.
function is_hidden(triangles, eye, target) {
  const [dx, dy, dz] = target.clone().sub(eye).toArray();
  const [ox, oy, oz] = eye.toArray();
  for (let i = 0; i < triangles.length; i += 9) {
    const ax = triangles[i], ay = triangles[i + 1], az = triangles[i + 2];
    const ux = triangles[i + 3] - ax, uy = triangles[i + 4] - ay, uz = triangles[i + 5] - az;
    const vx = triangles[i + 6] - ax, vy = triangles[i + 7] - ay, vz = triangles[i + 8] - az;
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const scale = ux * px + uy * py + uz * pz;
    if (scale === 0) continue;
    const tx = ox - ax, ty = oy - ay, tz = oz - az;
    const u = (tx * px + ty * py + tz * pz) / scale;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = ty * uz - tz * uy, qy = tz * ux - tx * uz, qz = tx * uy - ty * ux;
    const v = (dx * qx + dy * qy + dz * qz) / scale;
    if (!(v >= 0 && u + v <= 1)) continue;
    const t = (vx * qx + vy * qy + vz * qz) / scale;
    if (t > 0.02 && t < 0.97) return true;
  }
  return false;
}

// The direction that the triangles with a first corner this near look in together, or zero.
// What crosses or folds is wound any way; its surroundings know the outside better.
function normal_around(triangles, target, reach) {
  const sum = new THREE.Vector3();
  for (let i = 0; i < triangles.length; i += 9) {
    const corner = [0, 3, 6].map((k) => new THREE.Vector3().fromArray(triangles, i + k));
    if (Math.max(...corner[0].clone().sub(target).toArray().map(Math.abs)) > reach) continue;
    sum.add(corner[1].sub(corner[0]).cross(corner[2].sub(corner[0])));
  }
  return sum.length() > 0 ? sum.normalize() : sum;
}

function has_webgl() {
  try {
    const canvas = document.createElement('canvas');
    return !!canvas.getContext('webgl');
  } catch (_) {
    return false;
  }
}

// What a finding's marks are made of, unpacked once.
class Marks {
  constructor(packed) {
    this.places = unpack(packed.places, Float32Array);  // x y z, normal x y z, radius
    this.segments = unpack(packed.segments, Float32Array);
    this.segment_ends = unpack(packed.segment_ends, Uint32Array);
    this.triangles = unpack(packed.triangles, Float32Array);
    this.triangle_ends = unpack(packed.triangle_ends, Uint32Array);
    this.count = this.places.length / 7;
    this.pins = packed.pins;
    this.wide = packed.wide;
  }
  drawn(i) { return i < this.count && isFinite(this.places[i * 7]); }
  at(i) { return new THREE.Vector3().fromArray(this.places, i * 7); }
  normal(i) { return new THREE.Vector3().fromArray(this.places, i * 7 + 3); }
  radius(i) { return this.places[i * 7 + 6]; }
  segments_of(i) {
    return this.segments.slice((i ? this.segment_ends[i - 1] : 0) * 6, this.segment_ends[i] * 6);
  }
  triangles_of(i) {
    return this.triangles.slice((i ? this.triangle_ends[i - 1] : 0) * 9,
                                this.triangle_ends[i] * 9);
  }
  positions() {
    const kept = [];
    for (let i = 0; i < this.count; ++i) {
      if (this.drawn(i)) kept.push(...this.places.subarray(i * 7, i * 7 + 3));
    }
    return new Float32Array(kept);
  }
}

class View {
  constructor(holder, on_pick) {
    this.holder = holder;
    this.on_pick = on_pick;
    this.on_draw = () => {};
    this.renderer = new THREE.WebGLRenderer({antialias: true});
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    holder.prepend(this.canvas);
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    this.steer();
    this.showing = {edges: true, glass: false};
    this.z_up = false;
    this.asked = false;
    this.crowded = {value: 1};            // by how much many marks are smaller, from here
    this.dim = {value: 1};                // of all marks but the chosen one
    this.size = new THREE.Vector2(1, 1);  // of the picture in its own pixels
    this.clear();
    this.fitted = true;  // until the reader turns elsewhere, all stays in sight
    this.radius = 1;
    this.resize();
    this.listen();
  }

  steer() {
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener('change', () => this.ask());
    this.controls.addEventListener('start', () => {
      this.flight = null;
      this.fitted = false;
    });
  }

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.holder);
    let down = null;
    this.canvas.addEventListener('mousedown', (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('click', (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4;
      const hit = still && this.pick(event);
      if (hit) this.on_pick(hit.key, hit.place);
    });
    this.canvas.addEventListener('mousemove', (event) => {
      if (!event.buttons) this.canvas.style.cursor = this.pick(event) ? 'pointer' : 'grab';
    });
    this.canvas.addEventListener('keydown', (event) => this.key(event));
  }

  // Arrows turn, + and - zoom: what the mouse can do, the keyboard can.
  key(event) {
    const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (turn[event.key]) {
      const to_y = new THREE.Quaternion().setFromUnitVectors(this.camera.up,
                                                              new THREE.Vector3(0, 1, 0));
      const ball = new THREE.Spherical().setFromVector3(offset.applyQuaternion(to_y));
      ball.theta += turn[event.key][0] * 0.12;
      ball.phi += turn[event.key][1] * 0.12;
      ball.makeSafe();
      offset.setFromSpherical(ball).applyQuaternion(to_y.inverse());
    } else if (event.key === '+' || event.key === '=') {
      offset.multiplyScalar(0.85);
    } else if (event.key === '-') {
      offset.multiplyScalar(1 / 0.85);
    } else {
      return;
    }
    event.preventDefault();
    this.flight = null;
    this.fitted = false;
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.ask();
  }

  clear() {
    if (this.scene) this.scene.traverse((object) => {
      if (object.geometry) object.geometry.dispose();
      if (object.material) object.material.dispose();
    });
    this.scene = new THREE.Scene();
    this.surface = new THREE.Group();
    this.scene.add(this.surface);
    this.marks = new Map();
    this.chosen = null;
    this.drawn = null;
    this.half = new THREE.Vector3(1, 1, 1);
    this.flight = null;
    this.light();
  }

  light() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa3ad, 0.72));
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.42);
    this.scene.add(this.lamp, this.lamp.target);
  }

  // drawn: {positions, indices, ghost_positions, ghost_indices, half, whole}
  set_mesh(drawn) {
    this.clear();
    this.drawn = drawn;
    this.half.fromArray(drawn.half);
    this.radius = Math.max(this.half.length(), 1e-3);
    this.showing.edges = drawn.indices.length / 3 <= EDGES_BY_DEFAULT;
    if (drawn.indices.length) this.add_surface(drawn);
    if (drawn.ghost_indices.length) this.add_ghost(drawn);
    if (!drawn.whole) this.add_box();
    this.restyle();
    this.fit(false);
  }

  add_surface(drawn) {
    const geometry = point_geometry(drawn.positions);
    geometry.setIndex(new THREE.BufferAttribute(drawn.indices, 1));
    const shade = {flatShading: true, polygonOffset: true, polygonOffsetFactor: 1,
                   polygonOffsetUnits: 1};
    this.front = new THREE.MeshPhongMaterial({...shade, side: THREE.FrontSide, shininess: 12});
    this.back = new THREE.MeshPhongMaterial({...shade, side: THREE.BackSide, shininess: 0});
    this.edge = new THREE.MeshBasicMaterial({wireframe: true, transparent: true});
    const parts = [this.front, this.back, this.edge].map((m) => new THREE.Mesh(geometry, m));
    parts.forEach((part) => { part.frustumCulled = false; });
    this.edges = parts[2];
    this.surface.add(...parts);
  }

  add_ghost(drawn) {
    const geometry = point_geometry(drawn.ghost_positions);
    geometry.setIndex(new THREE.BufferAttribute(drawn.ghost_indices, 1));
    const ghost = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({
      flatShading: true, side: THREE.DoubleSide, transparent: true, opacity: 0.32,
      depthWrite: false}));
    ghost.material.ghost = true;
    this.surface.add(ghost);
  }

  add_box() {
    const box = new THREE.Box3(this.half.clone().negate(), this.half.clone());
    const outline = new THREE.Box3Helper(box, css_colour('--muted'));
    outline.material.transparent = true;
    outline.material.opacity = 0.5;
    this.surface.add(outline);
  }

  // style: colour, opacity, width, bias, order, scale; and least, thin, behind.
  object(Kind, geometry, shaders, style) {
    const ratio = this.renderer.getPixelRatio();
    const object = new Kind(geometry, new THREE.ShaderMaterial({
      vertexShader: shaders[0], fragmentShader: shaders[1], side: THREE.DoubleSide,
      transparent: true, depthTest: !style.behind, depthWrite: false,
      uniforms: {
        colour: {value: style.colour}, opacity: {value: style.opacity},
        width: {value: style.width * ratio}, least: {value: (style.least || 0) * ratio},
        thin: {value: style.thin || 0}, bias: {value: style.bias}, size: {value: this.size},
        scale: style.scale, dim: style.dim,
      },
    }));
    object.frustumCulled = false;
    object.renderOrder = style.order;
    return object;
  }

  // Faintly through the surface, then, where it is in sight, a casing that sets it off from
  // any ground, and itself.
  layers(group, Kind, geometry, shaders, style) {
    group.add(this.object(Kind, geometry, shaders,
                          {...style, behind: true, opacity: style.faint, order: 10 + style.order}));
    if (style.casing) {
      group.add(this.object(Kind, geometry, shaders, {
        ...style, colour: css_colour('--casing'), opacity: 0.85, order: 20 + style.order,
        width: style.width + style.casing, least: style.least && style.least + style.casing}));
    }
    group.add(this.object(Kind, geometry, shaders,
                          {...style, opacity: style.opacity || 1, order: 20.5 + style.order}));
  }

  mark_group(parts, colour, chosen) {
    const group = new THREE.Group();
    const lift = chosen ? 20 : 0;
    // Many marks are drawn small from afar, or they would hide the mesh and one another.
    const count = parts.triangles.length / 9 + parts.segments.length / 6 + parts.points.length / 3;
    const many = !chosen && count > MANY;
    const common = {colour, scale: many ? this.crowded : {value: 1}, faint: many ? 0.1 : 0.3,
                    dim: chosen ? {value: 1} : this.dim};
    if (parts.triangles.length) {
      this.layers(group, THREE.Mesh, point_geometry(parts.triangles), [FILL_VERTEX, PLAIN_FRAGMENT],
                  {...common, width: 0, bias: BIAS.fill, order: lift, opacity: many ? 0.7 : 1});
      const lines = outlines(parts.triangles);
      group.add(this.object(THREE.Mesh, band_geometry(lines.full), [BAND_VERTEX, PLAIN_FRAGMENT],
                            {...common, colour: css_colour('--casing'), opacity: 0.8, width: 2,
                             thin: 0.06, bias: BIAS.outline, order: 21 + lift}));
      this.layers(group, THREE.Mesh, band_geometry(lines.flat), [BAND_VERTEX, PLAIN_FRAGMENT],
                  {...common, casing: 2, width: 3, bias: BIAS.band, order: 1 + lift});
    }
    if (parts.segments.length) {
      this.layers(group, THREE.Mesh, band_geometry(parts.segments), [BAND_VERTEX, PLAIN_FRAGMENT],
                  {...common, casing: 2, width: (parts.wide ? 7 : 4) + (chosen ? 2 : 0), least: 6,
                   bias: BIAS.band, order: (parts.wide ? 2 : 3) + lift});
    }
    if (parts.points.length) {
      this.layers(group, THREE.Points, point_geometry(parts.points), [PIN_VERTEX, PIN_FRAGMENT],
                  {...common, casing: 3, width: chosen ? 11 : 8, bias: BIAS.pin, order: 4 + lift});
    }
    return group;
  }

  set_marks(key, marks, colour_name) {
    this.marks.set(key, {marks, colour_name, group: null, visible: false});
  }

  show_marks(key, visible) {
    const entry = this.marks.get(key);
    if (!entry) return;
    entry.visible = visible;
    if (visible && !entry.group) {
      const points = entry.marks.pins ? entry.marks.positions() : new Float32Array(0);
      entry.group = this.mark_group({segments: entry.marks.segments, points,
                                     triangles: entry.marks.triangles, wide: entry.marks.wide},
                                    css_colour(entry.colour_name), false);
      this.scene.add(entry.group);
    }
    if (entry.group) entry.group.visible = visible;
    this.ask();
  }

  // Marks one place above all others, whether its rule is shown or not.
  choose(key, place) {
    if (this.chosen) this.scene.remove(this.chosen.group);
    this.chosen = null;
    const entry = this.marks.get(key);
    if (entry && entry.marks.drawn(place)) {
      const marks = entry.marks;
      const pins = marks.pins || !marks.segments_of(place).length;
      const parts = {segments: marks.segments_of(place), triangles: marks.triangles_of(place),
                     points: pins ? new Float32Array(marks.at(place).toArray()) : [],
                     wide: marks.wide};
      this.chosen = {key, place, at: marks.at(place), colour_name: entry.colour_name, parts,
                     group: this.mark_group(parts, css_colour(entry.colour_name), true)};
      this.scene.add(this.chosen.group);
    }
    this.ask();
  }

  // A spot without marks: a component by its first triangle.
  choose_spot(at) {
    this.choose(null, 0);
    this.chosen = {at: new THREE.Vector3().fromArray(at), group: new THREE.Group()};
    this.fly(this.chosen.at, new THREE.Vector3(), this.radius * 0.2);
  }

  // Colours anew, after the reader's theme changed or another mesh came.
  restyle() {
    this.scene.background = css_colour('--scene');
    this.scene.traverse((object) => {
      if (object.material && object.material.ghost) object.material.color = css_colour('--surface');
    });
    if (this.front) {
      this.front.color = css_colour('--surface');
      this.front.specular = new THREE.Color(0x111111);
      this.back.color = css_colour('--surface-back');
      this.back.specular = new THREE.Color(0);
      this.edge.color = css_colour('--surface-edge');
      this.edge.opacity = 0.28;
    }
    for (const [key, entry] of this.marks) {
      if (!entry.group) continue;
      this.scene.remove(entry.group);
      entry.group = null;
      this.show_marks(key, entry.visible);
    }
    if (this.chosen && this.chosen.key) this.choose(this.chosen.key, this.chosen.place);
    this.apply_showing();
  }

  apply_showing() {
    if (this.front && this.surface.children.length) {
      const glass = this.showing.glass;
      for (const material of [this.front, this.back]) {
        material.transparent = glass;
        material.opacity = glass ? 0.22 : 1;
        material.depthWrite = !glass;
        material.needsUpdate = true;
      }
      this.edges.visible = this.showing.edges;
    }
    this.ask();
  }

  toggle(what) {
    this.showing[what] = !this.showing[what];
    this.apply_showing();
    return this.showing[what];
  }

  set_up(z_up) {
    this.z_up = z_up;
    this.camera.up.set(0, z_up ? 0 : 1, z_up ? 1 : 0);
    // OrbitControls reads `up` once, when it is made.
    const target = this.controls.target.clone();
    this.controls.dispose();
    this.steer();
    this.controls.target.copy(target);
  }

  resize() {
    const width = Math.max(1, this.holder.clientWidth);
    const height = Math.max(1, this.holder.clientHeight);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    if (this.fitted) this.fit(false);
    this.draw();
  }

  // How far away a ball of this radius fills the picture.
  distance_for(radius) {
    const half = FIELD_OF_VIEW * Math.PI / 360;
    const narrow = Math.atan(Math.tan(half) * Math.min(1, this.camera.aspect));
    return radius / Math.sin(narrow);
  }

  fit(animated) {
    const from = this.z_up ? new THREE.Vector3(0.8, -1.1, 0.65) : new THREE.Vector3(0.8, 0.65, 1.1);
    const eye = from.normalize().multiplyScalar(this.distance_for(this.radius));
    this.move(eye, new THREE.Vector3(), animated);
    this.fitted = true;
  }

  // The directions a place may be looked at from, the best first. First come those from
  // outside, but turned no more than needed and never flat upon an edge. Those from
  // elsewhere follow.
  directions(target, normal) {
    const present = this.camera.position.clone().sub(this.controls.target).normalize();
    const outwards = normal.lengthSq() > 0.25 ? normal.clone()
        : target.lengthSq() > 1e-6 ? target.clone().normalize() : present.clone();
    const found = [];
    for (const share of [0.6, 0.15, 2.5]) found.push(outwards.clone().addScaledVector(present, share));
    for (let k = 0; k < 8; ++k) {
      const turn = k * Math.PI / 4;
      const side = new THREE.Vector3(Math.cos(turn), 0.4, Math.sin(turn));
      if (this.z_up) side.set(side.x, -side.z, side.y);
      found.push(outwards.clone().add(side), side.clone());
    }
    found.push(outwards.clone().negate().addScaledVector(present, 0.3));
    return found.filter((way) => way.length() > 0.2).map((way) => way.normalize());
  }

  fly(target, normal, radius) {
    // A small place with some of its surroundings, a point with more of them.
    const around = radius > 0 ? Math.max(radius * 25, this.radius * 0.01) : this.radius * 0.03;
    const shown = Math.max(radius * 1.7, Math.min(around, this.radius * 0.08));
    const distance = this.distance_for(Math.min(shown, this.radius));
    const near = this.drawn ? triangles_around(this.drawn, target, distance) : [];
    const outside = normal_around(near, target, shown);
    const eyes = this.directions(target, outside.lengthSq() > 0 ? outside : normal)
        .map((way) => target.clone().addScaledVector(way, distance));
    const clear = eyes.find((eye) => !is_hidden(near, eye, target));
    this.move(clear || eyes[0] || this.camera.position.clone(), target, true);
  }

  fly_to(key, place) {
    const entry = this.marks.get(key);
    if (!entry || !entry.marks.drawn(place)) return;
    this.fly(entry.marks.at(place), entry.marks.normal(place), entry.marks.radius(place));
  }

  move(eye, target, animated) {
    this.fitted = false;
    this.holder.setAttribute('aria-busy', 'true');
    if (!animated || matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.flight = null;
      this.camera.position.copy(eye);
      this.controls.target.copy(target);
    } else {
      this.flight = {from: this.camera.position.clone(), eye, target,
                     from_target: this.controls.target.clone(), start: performance.now()};
    }
    this.ask();
  }

  step() {
    const flight = this.flight;
    if (!flight) return;
    const t = Math.min(1, (performance.now() - flight.start) / FLIGHT_MS);
    const eased = t * t * (3 - 2 * t);
    this.controls.target.lerpVectors(flight.from_target, flight.target, eased);
    this.camera.position.lerpVectors(flight.from, flight.eye, eased);
    if (t >= 1) this.flight = null;
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  draw() {
    this.step();
    this.dim.value = this.chosen && this.chosen.key ? 0.22 : 1;
    const distance = Math.max(this.camera.position.distanceTo(this.controls.target), 1e-7);
    const reach = this.radius + this.camera.position.length();
    this.crowded.value = Math.min(1, Math.max(0.4, 1.2 * this.radius / distance));
    this.camera.near = distance * 0.02;
    this.camera.far = Math.max(reach * 1.1, distance * 4);
    this.camera.updateProjectionMatrix();
    this.camera.lookAt(this.controls.target);
    this.camera.updateMatrixWorld();
    this.lamp.position.copy(this.camera.position)
        .add(new THREE.Vector3(-0.4, 0.6, 0).applyQuaternion(this.camera.quaternion)
                 .multiplyScalar(distance));
    this.lamp.target.position.copy(this.controls.target);
    this.renderer.getDrawingBufferSize(this.size);
    this.renderer.render(this.scene, this.camera);
    this.on_draw();
    if (this.flight) this.ask();
    else this.holder.setAttribute('aria-busy', 'false');
  }

  // CSS pixels from the top left of the picture, or null when behind the camera.
  project(point) {
    const seen = point.clone().project(this.camera);
    if (!(seen.z < 1 && seen.z > -1)) return null;
    return [(seen.x + 1) / 2 * this.holder.clientWidth, (1 - seen.y) / 2 * this.holder.clientHeight];
  }

  pick(event) {
    const box = this.canvas.getBoundingClientRect();
    let best = null;
    let least = PICK_PX;
    for (const [key, entry] of this.marks) {
      if (!entry.visible) continue;
      for (let i = 0; i < entry.marks.count; ++i) {
        const seen = entry.marks.drawn(i) && this.project(entry.marks.at(i));
        if (!seen) continue;
        const away = Math.hypot(seen[0] - (event.clientX - box.left), seen[1] - (event.clientY - box.top));
        if (away < least) {
          least = away;
          best = {key, place: i};
        }
      }
    }
    return best;
  }

  // For paper: wide, and on white.
  picture() {
    const ground = this.scene.background;
    const {aspect} = this.camera;
    this.scene.background = new THREE.Color(0xffffff);
    this.renderer.setSize(1500, 900, false);
    this.camera.aspect = 1500 / 900;
    if (this.fitted) this.fit(false);
    this.draw();
    const png = this.canvas.toDataURL('image/png');
    this.scene.background = ground;
    this.camera.aspect = aspect;
    this.resize();
    return png;
  }
}
