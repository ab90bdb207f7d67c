// SPDX-License-Identifier: GPL-3.0-or-later
// The body and what is drawn beside it.
import * as THREE from "./three/build/three.module.js";
import { OrbitControls } from "./three/examples/jsm/controls/OrbitControls.js";

const RAMP = ["#30123b", "#4662d7", "#36aaf9", "#1ae4b6", "#72fe5e", "#c8ef34", "#faba39", "#f66b19", "#ca2a04"]
  .map((text) => new THREE.Color(text));

function rampColour(byte) {
  const place = (byte / 255) * (RAMP.length - 1);
  const below = Math.min(Math.floor(place), RAMP.length - 2);
  return RAMP[below].clone().lerp(RAMP[below + 1], place - below);
}
const TABLE = Array.from({ length: 256 }, (_, byte) => rampColour(byte));
const PLAIN = new THREE.Color("#e08a3c");

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.light = new THREE.DirectionalLight("#ffffff", 0.75);
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8890a0", 0.65), this.light, this.light.target);
    this.controls = new OrbitControls(this.camera, canvas);
    this.marks = new THREE.Group();
    this.scene.add(this.marks);
    this.spring = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: "#e5484d", depthTest: false }));
    this.spring.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
    this.spring.frustumCulled = false;
    this.spring.visible = false;
    this.scene.add(this.spring);
    this.body = null;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    draw();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
  }

  draw() {
    this.light.position.copy(this.camera.position);
    this.light.target.position.copy(this.controls.target);
    this.onDraw && this.onDraw();
    this.renderer.render(this.scene, this.camera);
  }

  setTopology({ nVertices, triangles }) {
    if (this.body)
      this.scene.remove(this.body);
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles), 1));
    for (const name of ["position", "normal", "color"])
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * nVertices), 3));
    this.body = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(
      { vertexColors: THREE.VertexColors, side: THREE.DoubleSide, shininess: 15, specular: "#222222" }));
    this.body.frustumCulled = false;
    this.scene.add(this.body);
    this.hasPlace = false;
    this.hasColours = null;
  }

  setPlaces(places) {
    const geometry = this.body.geometry;
    geometry.attributes.position.array.set(places);
    geometry.attributes.position.needsUpdate = true;
    geometry.computeVertexNormals();
    geometry.boundingSphere = null; // for the ray
    if (!this.hasPlace) {
      this.look();
      this.hasPlace = true;
    }
  }

  setColours(bytes) {
    if (!bytes && this.hasColours === false)
      return;
    const colours = this.body.geometry.attributes.color;
    for (let i = 0; i < colours.count; ++i)
      (bytes ? TABLE[bytes[i]] : PLAIN).toArray(colours.array, 3 * i);
    colours.needsUpdate = true;
    this.hasColours = Boolean(bytes);
  }

  // From the side, so that all of the body is seen.
  look() {
    this.body.geometry.computeBoundingSphere();
    const { center, radius } = this.body.geometry.boundingSphere;
    this.radius = radius;
    this.controls.target.copy(center);
    const distance = (1.15 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.position.copy(center).add(new THREE.Vector3(0.35, -1, 0.3).normalize().multiplyScalar(distance));
    this.camera.near = 0.01 * radius;
    this.camera.far = 100 * radius;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  vertex(i) {
    return new THREE.Vector3().fromArray(this.body.geometry.attributes.position.array, 3 * i);
  }

  corners(triangle) {
    const index = this.body.geometry.index.array;
    return [0, 1, 2].map((a) => index[3 * triangle + a]);
  }

  // A ray through a place of the window.
  ray(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster;
  }

  // What of the body is seen there: {triangle, shares, point}; null: nothing.
  pick(event) {
    const hit = this.body && this.ray(event).intersectObject(this.body)[0];
    if (!hit)
      return null;
    const [a, b, c] = this.corners(hit.faceIndex).map((i) => this.vertex(i));
    const shares = new THREE.Triangle(a, b, c).getBarycoord(hit.point, new THREE.Vector3()).toArray().map((x) => Math.max(0, x));
    const sum = shares[0] + shares[1] + shares[2];
    return { triangle: hit.faceIndex, shares: shares.map((x) => x / sum), point: hit.point };
  }

  // Where the pointer is in the plane through a point that faces the camera.
  inPlane(event, point) {
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), point);
    return this.ray(event).ray.intersectPlane(plane, new THREE.Vector3());
  }

  pointOf({ triangle, shares }) {
    const point = new THREE.Vector3();
    this.corners(triangle).forEach((i, a) => point.addScaledVector(this.vertex(i), shares[a]));
    return point;
  }

  showSpring(from, to) {
    this.spring.visible = Boolean(from);
    if (!from)
      return;
    from.toArray(this.spring.geometry.attributes.position.array, 0);
    to.toArray(this.spring.geometry.attributes.position.array, 3);
    this.spring.geometry.attributes.position.needsUpdate = true;
  }

  // Dots on vertices; `groups` is [{vertices, colour}].
  showMarks(groups) {
    this.marks.children.slice().forEach((child) => {
      child.geometry.dispose();
      this.marks.remove(child);
    });
    for (const { vertices, colour } of groups) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices.length), 3));
      const points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: colour, size: 5, sizeAttenuation: false }));
      points.frustumCulled = false;
      points.userData.vertices = vertices;
      this.marks.add(points);
    }
    this.moveMarks();
  }

  moveMarks() {
    for (const { geometry, userData } of this.marks.children) {
      userData.vertices.forEach((i, k) => this.vertex(i).toArray(geometry.attributes.position.array, 3 * k));
      geometry.attributes.position.needsUpdate = true;
    }
  }

  // A small picture of other places of the vertices.
  drawPose(places, canvas) {
    const before = Float32Array.from(this.body.geometry.attributes.position.array);
    const size = this.renderer.getSize(new THREE.Vector2());
    this.marks.visible = false;
    this.setPlaces(places);
    const camera = this.camera.clone();
    this.camera.aspect = canvas.width / canvas.height;
    this.look();
    this.renderer.setSize(2 * canvas.width, 2 * canvas.height, false);
    this.camera.updateProjectionMatrix();
    this.draw();
    canvas.getContext("2d").drawImage(this.renderer.domElement, 0, 0, canvas.width, canvas.height);
    this.renderer.setSize(size.x, size.y, false);
    this.camera.copy(camera);
    this.resize();
    this.setPlaces(before);
    this.marks.visible = true;
  }
}
