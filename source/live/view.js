// SPDX-License-Identifier: GPL-3.0-or-later
// The body and what is drawn beside it.
import * as THREE from "./three/build/three.module.js";
import { Body } from "./body.js";
import { Camera } from "./camera.js";
import { Ground } from "./ground.js";
import { Marks } from "./marks.js";
import { Obstacles } from "./obstacles.js";
import { Skin } from "./skin.js";

// Colours are those of style.css.
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Let the browser save a file.
export function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.eye = new Camera(canvas);
    this.light = new THREE.DirectionalLight("#ffffff", 0.6);
    this.sky = new THREE.HemisphereLight("#ffffff", "#8890a0", 0.6);
    this.marks = new Marks({ handle: colour("handle"), pin: colour("pin"), edge: colour("edge"), spring: colour("spring") }, document.getElementById("names"));
    this.ground = new Ground(this.renderer);
    this.scene.add(this.sky, this.light, this.light.target, this.marks.group, this.marks.spring, this.ground.group);
    this.body = null;
    this.obstacles = null;
    this.skin = null; // of a body that was made of a surface
    this.wantsGround = true;
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addListener(() => this.takeColours());
    this.takeColours();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    draw();
  }

  get controls() {
    return this.eye.controls;
  }

  takeColours() {
    this.ground.setColours({ ground: colour("ground"), opacity: Number(colour("ground-opacity")), shadow: Number(colour("shadow-opacity")) });
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.eye.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.eye.camera.updateProjectionMatrix();
    this.body && this.draw(); // or it would be empty until the next frame
  }

  draw() {
    this.eye.fly();
    this.light.position.copy(this.eye.camera.position);
    this.light.target.position.copy(this.controls.target);
    this.onDraw && this.onDraw();
    this.marks.placeNames((point) => this.onPage(point));
    if (this.ground.group.visible)
      this.ground.castShadow();
    this.renderer.render(this.scene, this.eye.camera);
  }

  // Which way is up, and where a floor is, before there is a body.
  setScene({ up, floor }) {
    this.floor = floor;
    for (const part of [this.obstacles, this.skin])
      part && this.scene.remove(part.mesh);
    this.obstacles = this.skin = null;
    this.eye.setUp(new THREE.Vector3().fromArray(up));
    this.sky.position.copy(this.eye.up);
  }

  setTopology(topology) {
    if (this.body)
      this.scene.remove(this.body.mesh);
    this.body = new Body(topology, colour("body"));
    this.scene.add(this.body.mesh);
    this.hasPlace = false;
  }

  setObstacles(topology) {
    this.obstacles && this.scene.remove(this.obstacles.mesh);
    this.obstacles = new Obstacles(topology, colour("obstacle"));
    this.scene.add(this.obstacles.mesh);
  }

  setSkin(data) {
    this.skin = new Skin(data, colour("body"));
    this.scene.add(this.skin.mesh);
    this.body.mesh.material.visible = false; // a mesh that is not visible would not be met by the pointer
  }

  setColours(bytes) {
    (this.skin || this.body).setColours(bytes);
  }

  // Shows the patch that the pointer would take hold of; null: none.
  showPatch(point, radius) {
    this.body && this.body.showPatch(point, radius);
    this.skin && this.skin.drawn.showPatch(point, radius);
  }

  setPlaces(places, inner) {
    this.body.setPlaces(places);
    this.skin && this.skin.setPlaces(places, inner);
    this.ground.isOld = true;
    if (this.hasPlace)
      return this.marks.move(this.body.geometry);
    this.hasPlace = true; // as the body was at the beginning
    const { radius } = this.sphere();
    this.spacing = 0.07 * radius;
    this.eye.suit(this.body.geometry);
    this.ground.place(this.body.geometry, this.eye.up, this.floor);
    this.ground.group.visible = this.wantsGround;
    this.look("home", true);
  }

  sphere() {
    this.body.geometry.computeBoundingSphere();
    return this.body.geometry.boundingSphere;
  }

  look(name, atOnce = false) {
    this.body && this.eye.look(name, this.sphere(), atOnce);
  }

  toggleGround() {
    this.wantsGround = !this.wantsGround;
    this.ground.group.visible = this.wantsGround;
    this.ground.isOld = true;
    return this.wantsGround;
  }

  // A ray through a place of the window.
  ray(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.eye.camera);
    return caster;
  }

  // The first point of the body on a ray through a place of the window; null: none.
  pick(event) {
    return this.body && this.hasPlace ? this.body.hit(this.ray(event)) : null;
  }

  // The obstacle on such a ray, if it is nearer than the body; null: none.
  pickObstacle(event, list) {
    const hit = this.obstacles && this.obstacles.hit(this.ray(event), list);
    const body = hit && this.pick(event);
    return hit && !(body && body.distance < hit.distance) ? hit : null;
  }

  // A place to the right of the body, as it is seen, for an obstacle of this size.
  placeBeside(size) {
    const { center, radius } = this.sphere();
    const right = new THREE.Vector3(1, 0, 0).applyQuaternion(this.eye.camera.quaternion);
    right.addScaledVector(this.eye.up, -right.dot(this.eye.up)).normalize();
    return center.clone().addScaledVector(right, radius + 1.2 * size);
  }

  // Where the pointer is in the plane through a point that faces the camera.
  inPlane(event, point) {
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.eye.camera.getWorldDirection(new THREE.Vector3()), point);
    return this.ray(event).ray.intersectPlane(plane, new THREE.Vector3());
  }

  // Where on the page a point of the body's surroundings is.
  onPage(point) {
    const { x, y } = point.clone().project(this.eye.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return { x: ((x + 1) / 2) * clientWidth, y: ((1 - y) / 2) * clientHeight };
  }

  showMarks(groups) {
    if (this.body && this.hasPlace)
      this.marks.set(groups, this.body.geometry, this.spacing);
  }

  // What is seen, on the colour of the page, as a file.
  savePicture(name) {
    const { width, height } = this.canvas;
    const picture = Object.assign(document.createElement("canvas"), { width, height });
    const pen = picture.getContext("2d");
    pen.fillStyle = colour("back");
    pen.fillRect(0, 0, width, height);
    this.draw();
    pen.drawImage(this.canvas, 0, 0);
    picture.toBlob((blob) => save(blob, `${name}.png`));
  }

  // Small pictures of other places of the vertices: [{places, inner, canvas}]; `frame` is what is shown before and after.
  drawPoses(poses, frame) {
    const show = ({ places, inner }) => {
      this.body.setPlaces(places);
      this.skin && this.skin.setPlaces(places, inner);
    };
    const { camera } = this.eye;
    const kept = { position: camera.position.clone(), target: this.controls.target.clone(), aspect: camera.aspect };
    const besides = [this.marks.group, this.ground.group, ...(this.obstacles ? [this.obstacles.mesh] : [])];
    besides.forEach((part) => (part.visible = false));
    for (const { canvas, ...pose } of poses) {
      show(pose);
      this.renderer.setSize(canvas.width, canvas.height, false);
      camera.aspect = canvas.width / canvas.height;
      this.look("home", true);
      this.draw();
      canvas.getContext("2d").drawImage(this.renderer.domElement, 0, 0, canvas.width, canvas.height);
    }
    show(frame);
    camera.aspect = kept.aspect;
    this.look("home", true);
    camera.position.copy(kept.position);
    this.controls.target.copy(kept.target);
    this.controls.update();
    besides.forEach((part) => (part.visible = true));
    this.ground.group.visible = this.wantsGround;
    this.ground.isOld = true;
    this.resize();
  }
}
