// SPDX-License-Identifier: MIT
// The 3D view: two meshes under one camera, side by side at a divider or one alone.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { colourOf } from './colours.js';
import { decoded, scene } from './data.js';

const gradientShare = 0.9; // of the texture; the rest has the colour beyond the scale
const beyondCode = 65535;  // of the stored deviations

function scaleTexture() {
  const size = 640;
  const pixels = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i)
    pixels.set([...colourOf((i + 0.5) / size / gradientShare), 255], 4 * i);
  const texture = new THREE.DataTexture(pixels, size, 1);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.needsUpdate = true;
  return texture;
}

/** Texture coordinates of deviations: the scale fills `gradientShare`, what is beyond stands at the end. */
function scaleCoordinates(deviations) {
  const coordinates = new Float32Array(2 * deviations.length);
  deviations.forEach((value, i) => {
    coordinates[2 * i] = value === beyondCode ? 1 : (value / (beyondCode - 1)) * gradientShare * 0.999;
    coordinates[2 * i + 1] = 0.5;
  });
  return coordinates;
}

function drawable(mesh, materials) {
  const positions = new THREE.BufferAttribute(decoded(mesh.positions, Float32Array), 3);
  const faces = new THREE.BufferGeometry();
  faces.setAttribute('position', positions);
  faces.setAttribute('uv', new THREE.BufferAttribute(scaleCoordinates(decoded(mesh.deviations, Uint16Array)), 2));
  faces.setIndex(new THREE.BufferAttribute(decoded(mesh.triangles, Uint32Array), 1));
  const edges = new THREE.BufferGeometry();
  edges.setAttribute('position', positions);
  edges.setIndex(new THREE.BufferAttribute(decoded(mesh.edges, Uint32Array), 1));
  const group = new THREE.Group();
  group.add(new THREE.Mesh(faces, materials.deviation), new THREE.LineSegments(edges, materials.edges));
  return group;
}

const cssColour = (name) => new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());

export class Viewer {
  /** `state` is read at each drawing: show, shading, colour, divider (0 to 1), level. Throws where there is no WebGL. */
  constructor(canvas, state) {
    this.state = state;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.materials = {
      deviation: new THREE.MeshLambertMaterial({ map: scaleTexture(), side: THREE.DoubleSide, flatShading: true,
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
      plain: new THREE.MeshLambertMaterial({ color: 0xb9c0cc, side: THREE.DoubleSide, flatShading: true,
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
      edges: new THREE.LineBasicMaterial({ color: 0x20242c, transparent: true, opacity: 0.55 }),
    };
    this.first = drawable(scene.meshes.find((mesh) => mesh.role === 'first'), this.materials);
    const seconds = scene.meshes.filter((mesh) => mesh.role === 'second');
    this.second = seconds.map((mesh) => drawable(mesh, this.materials));
    this.firstCoordinates = seconds.map((mesh) =>
      new THREE.BufferAttribute(scaleCoordinates(decoded(mesh.first_deviations, Uint16Array)), 2));
    this.world = new THREE.Scene();
    this.world.add(this.first, ...this.second);
    this.camera = new THREE.PerspectiveCamera(35, 1, 1e-5, 100);
    this.camera.up.set(...scene.up);
    const lamp = new THREE.DirectionalLight(0xffffff, 2.0);
    lamp.position.set(-0.4, 0.6, 0.7);
    this.camera.add(lamp);
    this.world.add(this.camera, new THREE.AmbientLight(0xffffff, 1.1));
    this.witness = this.makeWitness();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.zoomToCursor = true;
    this.showAll();
    new ResizeObserver(() => this.draw()).observe(canvas.parentElement);
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  makeWitness() {
    const group = new THREE.Group();
    const material = (color) => new THREE.MeshBasicMaterial({ color, depthTest: false });
    const ball = new THREE.SphereGeometry(1, 20, 12);
    group.add(new THREE.Mesh(ball, material(0xff3020)), new THREE.Mesh(ball, material(0x2060ff)),
      new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xff3020, depthTest: false })));
    group.children.forEach((child) => { child.renderOrder = 1; });
    group.visible = false;
    this.world.add(group);
    return group;
  }

  /** From model coordinates to those of the view. */
  inView([x, y, z]) {
    const [cx, cy, cz] = scene.frame.centre;
    return new THREE.Vector3((x - cx) / scene.frame.size, (y - cy) / scene.frame.size, (z - cz) / scene.frame.size);
  }

  showAll() {
    this.witness.visible = false;
    const up = new THREE.Vector3(...scene.up);
    const side = up.x === 1 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(1, 0, 0);
    const front = side.clone().cross(up);
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(0, 0, 0).addScaledVector(side, 0.62).addScaledVector(front, 1.25).addScaledVector(up, 0.68);
    const narrow = Math.min(1, this.camera.aspect);
    this.camera.position.multiplyScalar(1 / narrow);
    this.controls.update();
    this.draw();
  }

  /** Marks the two points and moves the eye to where both fill part of the view. */
  showWitness({ from, to }) {
    const [start, end] = [this.inView(from), this.inView(to)];
    const [a, b, line] = this.witness.children;
    a.position.copy(start);
    b.position.copy(end);
    line.geometry.setFromPoints([start, end]);
    this.witness.visible = true;
    const middle = start.clone().add(end).multiplyScalar(0.5);
    const towards = this.camera.position.clone().sub(this.controls.target).normalize();
    const reach = Math.max(12 * start.distanceTo(end), 0.02);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(towards, reach);
    this.controls.update();
    this.draw();
  }

  prepare(group) {
    const { shading, colour } = this.state;
    const [faces, edges] = group.children;
    faces.visible = shading !== 'wireframe';
    faces.material = this.materials[colour];
    edges.visible = shading !== 'shaded';
  }

  /** Draws one of the two sides into the columns from `left` to `right`, pixels of the page. */
  drawSide(side, left, right, height) {
    if (right <= left) return;
    const level = Math.min(this.state.level, this.second.length - 1);
    const chosen = this.second[level];
    this.first.children[0].geometry.setAttribute('uv', this.firstCoordinates[level]);
    this.first.visible = side === 'first';
    for (const group of this.second) group.visible = side === 'second' && group === chosen;
    this.renderer.setScissor(left, 0, right - left, height);
    this.renderer.render(this.world, this.camera);
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setClearColor(cssColour('--stage'));
    this.materials.edges.color.copy(this.state.shading === 'wireframe' ? cssColour('--text') : new THREE.Color(0x20242c));
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.witness.children.slice(0, 2).forEach((ball) => ball.scale.setScalar(0.006 * distance));
    [this.first, ...this.second].forEach((group) => this.prepare(group));
    this.renderer.setScissorTest(true);
    const divider = this.state.show === 'split' ? Math.round(this.state.divider * width) : this.state.show === 'first' ? width : 0;
    this.drawSide('first', 0, divider, height);
    this.drawSide('second', divider, width, height);
  }
}
