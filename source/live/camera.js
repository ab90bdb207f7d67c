// SPDX-License-Identifier: GPL-3.0-or-later
// The camera: turned by hand or by keys, or brought to a place that a button names.
import * as THREE from "./three/build/three.module.js";
import { OrbitControls } from "./three/examples/jsm/controls/OrbitControls.js";

const FLIGHT = 250; // [ms]
const TURN = Math.PI / 24; // of a key
const isStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

export class Camera {
  constructor(canvas) {
    this.canvas = canvas;
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    this.flight = null;
    this.setUp(new THREE.Vector3(0, 0, 1));
    canvas.addEventListener("keydown", (event) => this.hearKey(event));
  }

  // Sets the up direction, against gravity. Controls are made for one such direction.
  setUp(up) {
    this.up = up;
    this.home = null;
    this.front = new THREE.Vector3(0, -1, 0).addScaledVector(up, up.y);
    if (this.front.length() < 0.1) // gravity is along y
      this.front.set(0, 0, 1);
    this.front.normalize();
    this.side = up.clone().cross(this.front);
    this.camera.up.copy(up);
    this.controls && this.controls.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.mouseButtons.RIGHT = THREE.MOUSE.ROTATE; // over the body, too
    this.controls.touches.TWO = THREE.TOUCH.DOLLY_ROTATE;
    this.controls.addEventListener("start", () => (this.flight = null));
  }

  // Chooses the direction from which a body shows most of itself: its front or its side, and from higher up if it is flat.
  suit(geometry) {
    const { array } = geometry.attributes.position;
    const extent = (axis) => {
      let [least, most] = [Infinity, -Infinity];
      for (let i = 0; i < array.length; i += 3) {
        const x = array[i] * axis.x + array[i + 1] * axis.y + array[i + 2] * axis.z;
        least = Math.min(least, x);
        most = Math.max(most, x);
      }
      return most - least;
    };
    const { up, front, side } = this;
    const [height, depth, width] = [up, front, side].map(extent);
    const [main, other] = width >= depth ? [front, side] : [side, front];
    const isFlat = width * depth > 2 * Math.max(width, depth) * height;
    this.home = main.clone().addScaledVector(other, 0.35).addScaledVector(up, isFlat ? 1 : 0.3);
  }

  direction(name) {
    const { up, front, side } = this;
    const home = this.home || front.clone().addScaledVector(side, 0.35).addScaledVector(up, 0.3);
    return { home: home.clone(), front: front.clone(), side: side.clone(),
      top: up.clone().addScaledVector(front, 1e-3) }[name].normalize();
  }

  // Looks from a direction, so that all of a sphere is seen; at once, or as the eye can follow.
  look(name, { center, radius }, atOnce) {
    const distance = (1.15 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.near = 0.01 * radius;
    this.camera.far = 100 * radius;
    this.camera.updateProjectionMatrix();
    const from = this.camera.position.clone().sub(this.controls.target);
    this.flight = { begin: performance.now() - (atOnce || isStill() ? FLIGHT : 0), target: this.controls.target.clone(), goal: center.clone(),
      distance: from.length(), way: distance, direction: from.normalize(), end: this.direction(name) };
    this.fly();
  }

  fly(now = performance.now()) {
    if (!this.flight)
      return;
    const { begin, target, goal, distance, way, direction, end } = this.flight;
    const part = Math.min(1, Math.max(0, (now - begin) / FLIGHT));
    const eased = part * part * (3 - 2 * part);
    const turned = direction.clone().lerp(end, eased);
    if (part === 1 || turned.length() < 0.1) // to the opposite side
      turned.copy(end);
    this.controls.target.lerpVectors(target, goal, eased);
    this.camera.position.copy(this.controls.target).addScaledVector(turned.normalize(), distance + (way - distance) * eased);
    this.controls.update();
    if (part === 1)
      this.flight = null;
  }

  // Arrows turn, + and - zoom, while the canvas has the focus.
  hearKey(event) {
    const steps = { ArrowLeft: [-TURN, 0, 1], ArrowRight: [TURN, 0, 1], ArrowUp: [0, -TURN, 1], ArrowDown: [0, TURN, 1], "+": [0, 0, 0.9], "-": [0, 0, 1 / 0.9] };
    const step = steps[event.key];
    if (!step)
      return;
    event.preventDefault();
    const [around, over, nearer] = step;
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(nearer);
    const height = offset.angleTo(this.up);
    const axis = this.up.clone().cross(offset).normalize();
    offset.applyAxisAngle(axis, Math.min(Math.PI - 0.01, Math.max(0.01, height + over)) - height).applyAxisAngle(this.up, around);
    this.flight = null;
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
}
