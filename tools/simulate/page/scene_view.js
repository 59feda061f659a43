// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a scene: instances of its models, and what the present frame says of them.
'use strict';

const LAYER_COLOURS = 8;
const EDGE_DEGREES = 25;        // flatter edges are not drawn
const MOST_EDGES = 20000;       // triangles of a model above which its edges are not drawn
const MOST_OUTLINED = 5000;     // lit triangles that get outlines
const HOVER_TRIANGLES = 20000;  // a larger model is found by its ball while the mouse moves

const layer_colour = (layer) => '--layer-' + layer % LAYER_COLOURS;

// Flat shading in the light of the other pages. Instances have colours of their own, which three.js
// r111 does not know; and Phong's shader is slow where a processor draws.
const SURFACE_VERTEX = `
  varying vec3 here; varying vec3 tint_here;
  #ifdef USE_INSTANCING
    attribute vec3 tint;
  #else
    uniform vec3 tint;
  #endif
  void main() {
    vec4 p = vec4(position, 1.0);
    #ifdef USE_INSTANCING
      p = instanceMatrix * p;
    #endif
    p = modelViewMatrix * p;
    here = p.xyz;
    tint_here = tint;
    gl_Position = projectionMatrix * p;
  }`;
const SURFACE_FRAGMENT = `
  uniform vec3 up; uniform float opacity;
  varying vec3 here; varying vec3 tint_here;
  const vec3 LAMP = vec3(-0.3244, 0.4867, 0.8111);
  void main() {
    vec3 normal = normalize(cross(dFdx(here), dFdy(here)));
    vec3 sky = mix(vec3(0.604, 0.639, 0.678), vec3(1.0), 0.5 + 0.5 * dot(normal, up));
    gl_FragColor = vec4(tint_here * (0.72 * sky + 0.42 * max(0.0, dot(normal, LAMP))), opacity);
  }`;

// Edges of instances, whose poses are the rows of a 3 x 4 matrix.
const EDGE_VERTEX = `
  attribute vec4 row_0; attribute vec4 row_1; attribute vec4 row_2;
  void main() {
    vec4 p = vec4(position, 1.0);
    gl_Position = projectionMatrix * viewMatrix * vec4(dot(row_0, p), dot(row_1, p), dot(row_2, p), 1.0);
    gl_Position.z -= 1e-4 * gl_Position.w;
  }`;
const EDGE_FRAGMENT = `
  uniform vec3 colour; uniform float opacity;
  void main() { gl_FragColor = vec4(colour, opacity); }`;

// The objects of one model that have its shape.
class Instances {
  constructor(triangles, objects, edge, sky) {
    this.objects = objects;
    this.geometry = point_geometry(triangles.positions);
    this.geometry.setIndex(new THREE.BufferAttribute(triangles.indices, 1));
    this.tint = new THREE.InstancedBufferAttribute(new Float32Array(objects.length * 3), 3);
    this.geometry.setAttribute('tint', this.tint);
    this.mesh = new THREE.InstancedMesh(this.geometry, surface_material(sky), objects.length);
    this.mesh.frustumCulled = false;
    this.edges = triangles.indices.length / 3 <= MOST_EDGES ? this.make_edges(edge) : null;
  }

  make_edges(material) {
    const flat = this.geometry.clone();
    flat.deleteAttribute('tint');
    const sharp = new THREE.EdgesGeometry(flat, EDGE_DEGREES);
    flat.dispose();
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute('position', sharp.getAttribute('position'));
    this.rows = [0, 1, 2].map((i) => {
      const row = new THREE.InstancedBufferAttribute(new Float32Array(this.objects.length * 4), 4);
      geometry.setAttribute('row_' + i, row);
      return row;
    });
    geometry.maxInstancedCount = this.objects.length;
    const edges = new THREE.LineSegments(geometry, material);
    edges.frustumCulled = false;
    return edges;
  }

  place(i, matrix) {
    this.mesh.setMatrixAt(i, matrix);
    if (!this.edges) return;
    const m = matrix.elements;
    for (let r = 0; r < 3; ++r) this.rows[r].setXYZW(i, m[r], m[4 + r], m[8 + r], m[12 + r]);
  }

  upload() {
    this.mesh.instanceMatrix.needsUpdate = true;
    this.tint.needsUpdate = true;
    if (this.edges) for (const row of this.rows) row.needsUpdate = true;
  }
}

// `up` is where the sky is, as the camera sees it.
function surface_material(up) {
  return new THREE.ShaderMaterial({
    vertexShader: SURFACE_VERTEX, fragmentShader: SURFACE_FRAGMENT, side: THREE.DoubleSide,
    extensions: {derivatives: true}, polygonOffset: true, polygonOffsetFactor: 1,
    polygonOffsetUnits: 1, uniforms: {up: {value: up}, opacity: {value: 1},
                                      tint: {value: new THREE.Color()}}});
}

function centres_of(triangles) {
  const centres = new Float32Array(triangles.length / 3);
  for (let i = 0; i < centres.length; ++i) {
    const at = Math.floor(i / 3) * 9 + i % 3;
    centres[i] = (triangles[at] + triangles[at + 3] + triangles[at + 6]) / 3;
  }
  return centres;
}

// Both ends of each edge, once.
function edges_of(indices) {
  const seen = new Set(), edges = [];
  for (let i = 0; i < indices.length; ++i) {
    const a = indices[i], b = indices[i % 3 === 2 ? i - 2 : i + 1];
    const key = Math.min(a, b) * 0x4000000 + Math.max(a, b);
    if (seen.has(key)) continue;
    seen.add(key);
    edges.push(a, b);
  }
  return new Uint32Array(edges);
}

class SceneView extends View {
  constructor(holder, run, on_pick) {
    super(holder, on_pick);
    this.run = run;
    this.set_up(!run.y_is_up);
    this.half.fromArray(run.half);
    this.radius = Math.max(this.half.length(), 1e-3);
    this.edge = new THREE.ShaderMaterial({vertexShader: EDGE_VERTEX, fragmentShader: EDGE_FRAGMENT,
        transparent: true, uniforms: {colour: {value: new THREE.Color()}, opacity: {value: 0.5}}});
    this.sky = new THREE.Vector3(0, 1, 0);
    this.instances = [];
    this.shaped = new Map();
    run.triangles_of_models.forEach((triangles, model) => this.add_model(triangles, model));
    for (const object of run.changing_of.keys()) this.add_shaped(object);
    this.matrices = run.objects.map(() => new THREE.Matrix4());
    this.marks_now = null;
    this.restyle();
    this.fit(false);
  }

  add_model(triangles, model) {
    if (!triangles) return;
    const objects = [];
    this.run.objects.forEach((object, i) => {
      if (object[1] === model && !this.run.changing_of.has(i)) objects.push(i);
    });
    if (!objects.length || !triangles.indices.length) return;
    const instances = new Instances(triangles, objects, this.edge, this.sky);
    this.instances.push(instances);
    this.surface.add(instances.mesh);
    if (instances.edges) this.surface.add(instances.edges);
  }

  // An object whose shape changes has a mesh of its own, and lines on all its edges.
  add_shaped(object) {
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), surface_material(this.sky));
    const edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
        {transparent: true, opacity: 0.35}));
    for (const one of [mesh, edges]) {
      one.frustumCulled = false;
      one.matrixAutoUpdate = false;
      this.surface.add(one);
    }
    this.shaped.set(object, {mesh, edges, shape: null});
  }

  // Gives a mesh the shape of the present frame.
  reshape(object, drawn) {
    const shape = this.run.shapes.get(this.run.changing_of.get(object));
    if (drawn.shape === shape) return;
    drawn.shape = shape;
    const {positions, indices} = this.run.triangles_of(object);
    const both = new THREE.BufferAttribute(positions, 3);
    drawn.mesh.geometry.dispose();
    drawn.mesh.geometry = new THREE.BufferGeometry();
    drawn.mesh.geometry.setAttribute('position', both);
    drawn.mesh.geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    drawn.edges.geometry.dispose();
    drawn.edges.geometry = new THREE.BufferGeometry();
    drawn.edges.geometry.setAttribute('position', both);
    drawn.edges.geometry.setIndex(new THREE.BufferAttribute(edges_of(indices), 1));
  }

  // Draws the state of the run as it is now.
  show() {
    const {run} = this;
    const tints = this.tints();
    const place = new THREE.Vector3(), turn = new THREE.Quaternion(), one = new THREE.Vector3(1, 1, 1);
    run.objects.forEach((_, i) => {
      const at = i * POSE;
      if (!run.present[i]) one.set(0, 0, 0);
      else one.set(1, 1, 1);
      turn.set(run.poses[at + 1], run.poses[at + 2], run.poses[at + 3], run.poses[at]);
      this.matrices[i].compose(place.fromArray(run.poses, at + 4), turn, one);
    });
    for (const instances of this.instances) {
      instances.objects.forEach((object, i) => {
        instances.place(i, this.matrices[object]);
        const tint = tints[object];
        instances.tint.setXYZ(i, tint.r, tint.g, tint.b);
      });
      instances.upload();
    }
    for (const [object, drawn] of this.shaped) {
      this.reshape(object, drawn);
      drawn.mesh.matrix.copy(this.matrices[object]);
      drawn.edges.matrix.copy(this.matrices[object]);
      drawn.mesh.material.uniforms.tint.value.copy(tints[object]);
    }
    this.show_marks_now();
    this.follow_chosen();
    this.ask();
  }

  // The outline of the chosen object, in front of all else.
  follow_chosen() {
    if (!this.chosen) return;
    const {object, at, outline} = this.chosen;
    at.setFromMatrixPosition(this.matrices[object]);
    if (outline) outline.matrix.copy(this.matrices[object]);
  }

  outline_of(object) {
    const triangles = this.run.triangles_of_models[this.run.objects[object][1]];
    if (!triangles || triangles.indices.length / 3 > MOST_EDGES) return null;
    if (this.run.changing_of.has(object)) return null;
    const whole = point_geometry(triangles.positions);
    whole.setIndex(new THREE.BufferAttribute(triangles.indices, 1));
    const outline = new THREE.LineSegments(new THREE.EdgesGeometry(whole, EDGE_DEGREES),
        new THREE.LineBasicMaterial({color: css_colour('--accent'), depthTest: false, transparent: true}));
    outline.matrixAutoUpdate = false;
    outline.frustumCulled = false;
    outline.renderOrder = 50;
    return outline;
  }

  // The colour of each object: that of its layer, tinted by the effects that hold for it.
  tints() {
    const {run} = this;
    const layers = run.layers.map((_, i) => css_colour(layer_colour(i)));
    const ground = css_colour('--scene');
    const effects = run.effects.map((effect) => css_colour('--effect-' + effect.name));
    const bit = (name) => 1 << run.effects.findIndex((effect) => effect.name === name);
    const collide = bit('collide'), within = bit('within');
    const held = new Uint32Array(run.objects.length);
    const {hits, lit} = run.now;
    for (let i = 0; i < hits.length; i += 3) {
      held[hits[i]] |= hits[i + 2];
      held[hits[i + 1]] |= hits[i + 2];
    }
    // Where the triangles that touch are known, these are lit instead.
    const exact = new Set(lit.map(([object]) => object));
    return run.objects.map(([, , layer, asked], i) => {
      const colour = layers[layer].clone();
      if (!asked) return colour.lerp(ground, 0.55);
      if (held[i] & within) colour.lerp(effects[Math.log2(within)], exact.has(i) ? 0.2 : 0.55);
      if (held[i] & collide) colour.lerp(effects[Math.log2(collide)], exact.has(i) ? 0.25 : 0.8);
      return colour;
    });
  }

  // Nine floats for each lit triangle of the present frame.
  lit_triangles() {
    const corners = [];
    const point = new THREE.Vector3();
    for (const [object, numbers] of this.run.now.lit) {
      const triangles = this.run.triangles_of(object);
      if (!triangles) continue;
      const positions = triangles.lit || triangles.positions;
      for (const number of numbers) {
        const place = triangles.place ? triangles.place.get(number) : number;
        if (place === undefined) continue;
        if (!triangles.lit && place * 3 + 2 >= triangles.indices.length) continue;
        for (let k = 0; k < 3; ++k) {
          const vertex = triangles.lit ? place * 3 + k : triangles.indices[place * 3 + k];
          point.fromArray(positions, vertex * 3).applyMatrix4(this.matrices[object]);
          corners.push(point.x, point.y, point.z);
        }
      }
    }
    return new Float32Array(corners);
  }

  // An arrow for each contact: a shaft along the normal, and a head of four strokes.
  arrows() {
    const {contacts} = this.run.now;
    const length = this.radius * 0.09;
    const segments = [], points = [];
    const add = (from, to) => segments.push(...from.toArray(), ...to.toArray());
    for (let i = 0; i < contacts.length; i += CONTACT) {
      const from = new THREE.Vector3().fromArray(contacts, i);
      const normal = new THREE.Vector3().fromArray(contacts, i + 3);
      const side = new THREE.Vector3(1, 0, 0);
      if (Math.abs(normal.x) > 0.7) side.set(0, 1, 0);
      side.cross(normal).normalize();
      const other = side.clone().cross(normal);
      const tip = from.clone().addScaledVector(normal, length);
      const neck = from.clone().addScaledVector(normal, length * 0.72);
      points.push(...from.toArray());
      add(from, tip);
      for (const way of [side, side.clone().negate(), other, other.clone().negate()]) {
        add(tip, neck.clone().addScaledVector(way, length * 0.14));
      }
    }
    return {segments: new Float32Array(segments), points: new Float32Array(points)};
  }

  distance_lines() {
    const {distances} = this.run.now;
    const segments = [], points = [];
    for (let i = 0; i < distances.length; i += DISTANCE) {
      segments.push(...distances.subarray(i, i + 6));
      points.push(...distances.subarray(i, i + 6));
    }
    return {segments: new Float32Array(segments), points: new Float32Array(points)};
  }

  show_marks_now() {
    if (this.marks_now) {
      this.marks_now.traverse((object) => {
        if (object.geometry) object.geometry.dispose();
        if (object.material) object.material.dispose();
      });
      this.scene.remove(this.marks_now);
    }
    const group = this.marks_now = new THREE.Group();
    const style = {scale: {value: 1}, dim: {value: 1}, faint: 0.25, casing: 2};
    const lit = this.lit_triangles();
    if (lit.length) {
      const fill = {...style, colour: css_colour('--effect-overlap'), casing: 0, width: 0, order: 0};
      this.layers(group, THREE.Mesh, point_geometry(lit), [FILL_VERTEX, PLAIN_FRAGMENT],
                  {...fill, bias: BIAS.fill});
      // A dot each, so that none is too small to be seen from afar.
      this.layers(group, THREE.Points, point_geometry(centres_of(lit)), [PIN_VERTEX, PIN_FRAGMENT],
                  {...fill, width: 3, faint: 0.4, bias: BIAS.outline});
      if (lit.length / 9 <= MOST_OUTLINED) {
        group.add(this.object(THREE.Mesh, band_geometry(outlines(lit).full), [BAND_VERTEX, PLAIN_FRAGMENT],
                              {...fill, colour: css_colour('--casing'), opacity: 0.6, width: 1.2,
                               thin: 0.02, bias: BIAS.outline, order: 21}));
      }
    }
    this.add_lines(group, this.distance_lines(), {...style, colour: css_colour('--effect-distance'),
                                                  width: 3, order: 1}, 7);
    this.add_lines(group, this.arrows(), {...style, colour: css_colour('--effect-contacts'),
                                          width: 4, order: 3}, 8);
    this.scene.add(group);
  }

  add_lines(group, {segments, points}, style, pin) {
    if (!segments.length) return;
    this.layers(group, THREE.Mesh, band_geometry(segments), [BAND_VERTEX, PLAIN_FRAGMENT],
                {...style, bias: BIAS.band});
    this.layers(group, THREE.Points, point_geometry(points), [PIN_VERTEX, PIN_FRAGMENT],
                {...style, width: pin, bias: BIAS.pin, order: style.order + 1});
  }

  restyle() {
    if (!this.run) return;
    this.scene.background = css_colour('--scene');
    this.edge.uniforms.colour.value = css_colour('--surface-edge');
    for (const {edges} of this.shaped.values()) edges.material.color = css_colour('--surface-edge');
    this.apply_showing();
    this.show();
  }

  apply_showing() {
    if (!this.run) return;
    const {glass, edges} = this.showing;
    for (const {mesh} of [...this.instances, ...this.shaped.values()]) {
      mesh.material.transparent = glass;
      mesh.material.uniforms.opacity.value = glass ? 0.25 : 1;
      mesh.material.depthWrite = !glass;
      mesh.material.needsUpdate = true;
    }
    for (const one of [...this.instances, ...this.shaped.values()]) {
      if (one.edges) one.edges.visible = edges;
    }
    this.ask();
  }

  draw() {
    if (this.run) this.sky.copy(this.camera.up).transformDirection(this.camera.matrixWorldInverse);
    super.draw();
  }

  radius_of(object) {
    const {half} = this.run.models[this.run.objects[object][1]];
    return Math.hypot(...half);
  }

  // Chooses an object; its label and its outline follow it.
  choose_object(object, fly) {
    if (this.chosen && this.chosen.outline) {
      this.scene.remove(this.chosen.outline);
      this.chosen.outline.geometry.dispose();
      this.chosen.outline.material.dispose();
    }
    this.chosen = object === null ? null
        : {object, at: new THREE.Vector3(), outline: this.outline_of(object)};
    if (this.chosen && this.chosen.outline) this.scene.add(this.chosen.outline);
    this.follow_chosen();
    if (this.chosen && fly) {
      const present = this.camera.position.clone().sub(this.controls.target).normalize();
      const distance = this.distance_for(Math.max(this.radius_of(object) * 2.2, this.radius * 0.3));
      this.move(this.chosen.at.clone().addScaledVector(present, distance), this.chosen.at.clone(), true);
    }
    this.ask();
  }

  // As near as the corners of the box allow, or, before there is one, as the ball does.
  fit(animated) {
    if (!this.run) return super.fit(animated);
    const way = (this.z_up ? new THREE.Vector3(0.8, -1.1, 0.65) : new THREE.Vector3(0.8, 0.65, 1.1)).normalize();
    const right = this.camera.up.clone().cross(way).normalize();
    const up = way.clone().cross(right);
    const high = Math.tan(FIELD_OF_VIEW * Math.PI / 360);
    let distance = this.radius * 0.1;
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).multiply(this.half);
      const across = Math.abs(corner.dot(right)) / (high * this.camera.aspect);
      distance = Math.max(distance, corner.dot(way) + Math.max(across, Math.abs(corner.dot(up)) / high));
    }
    this.move(way.multiplyScalar(distance * 1.08), new THREE.Vector3(), animated);
    this.fitted = true;
  }

  // The object in front at the mouse.
  pick(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((event.clientX - box.left) / box.width * 2 - 1,
                                 1 - (event.clientY - box.top) / box.height * 2);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    let best = null, least = Infinity;
    this.run.objects.forEach((object, i) => {
      const triangles = this.run.triangles_of(i);
      if (!triangles || !this.run.present[i]) return;
      const ball = new THREE.Sphere(new THREE.Vector3().setFromMatrixPosition(this.matrices[i]),
                                    this.radius_of(i));
      // A shape may be larger than the model.
      if (!this.run.changing_of.has(i) && !caster.ray.intersectsSphere(ball)) return;
      const quick = event.type === 'mousemove' && triangles.indices.length / 3 > HOVER_TRIANGLES;
      const away = quick ? caster.ray.origin.distanceTo(ball.center) : this.hit(caster.ray, i, least);
      if (away < least) {
        least = away;
        best = {key: i, place: 0};
      }
    });
    return best;
  }

  // How far away a ray meets an object.
  hit(ray, object, least) {
    const local = ray.clone().applyMatrix4(new THREE.Matrix4().getInverse(this.matrices[object]));
    const {indices, positions} = this.run.triangles_of(object);
    const [a, b, c, at] = [0, 1, 2, 3].map(() => new THREE.Vector3());
    for (let i = 0; i < indices.length; i += 3) {
      a.fromArray(positions, indices[i] * 3);
      b.fromArray(positions, indices[i + 1] * 3);
      c.fromArray(positions, indices[i + 2] * 3);
      if (local.intersectTriangle(a, b, c, false, at)) least = Math.min(least, at.distanceTo(local.origin));
    }
    return least;
  }
}
