// SPDX-License-Identifier: GPL-3.0-or-later
// A closed line around a part of the body, with a name beside it.
import * as THREE from "./three/build/three.module.js";

const UP = new THREE.Vector3(0, 1, 0); // the axis of a rod
const rod = new THREE.CylinderBufferGeometry(1, 1, 1, 6);

// Pairs of edges of the surface, each edge by its ends: a line from the middle of the one to that of the other goes through each triangle
// that has vertices inside and outside of the part.
function crossings(vertices, triangles) {
  const isInside = new Set(vertices);
  const found = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const edges = [0, 1, 2].map((a) => [corners[a], corners[(a + 1) % 3]]).filter(([a, b]) => isInside.has(a) !== isInside.has(b));
    if (edges.length === 2)
      found.push(edges);
  }
  return found;
}

export class Outline {
  // `width`: of the line in the body's unit
  constructor({ name, vertices }, geometry, { colour, edge }, width) {
    this.crossings = crossings(vertices, geometry.index.array);
    this.width = width;
    this.group = new THREE.Group();
    this.group.userData = { name, kind: "handle" };
    // the dark border is behind the bright line, whatever is nearer to the eye
    this.lines = [[edge, 1.7, 3], [colour, 1, 4]].map(([color, factor, renderOrder]) => {
      const mesh = new THREE.InstancedMesh(rod, new THREE.MeshBasicMaterial({ color, transparent: true, depthWrite: false }), Math.max(1, this.crossings.length));
      mesh.frustumCulled = false;
      return Object.assign(mesh, { renderOrder, userData: { factor } });
    });
    this.group.add(...this.lines);
    this.points = []; // middles of the line's pieces
    this.label = Object.assign(document.createElement("span"), { textContent: name, className: "label" });
    this.stress(false);
    this.move(geometry);
  }

  get isEmpty() {
    return this.crossings.length === 0;
  }

  stress(isStressed) {
    this.factor = isStressed ? 1.8 : 1;
    this.label.classList.toggle("stressed", isStressed);
  }

  // Lies a little above the surface, which would hide half of it.
  move(geometry) {
    const { position, normal } = geometry.attributes;
    const middle = ([a, b]) => new THREE.Vector3(...[0, 1, 2].map((c) =>
      (position.array[3 * a + c] + position.array[3 * b + c]) / 2 + this.width * (normal.array[3 * a + c] + normal.array[3 * b + c])));
    const pieces = this.crossings.map((edges) => edges.map(middle));
    this.points = pieces.map(([from, to]) => from.clone().lerp(to, 0.5));
    const matrix = new THREE.Matrix4();
    const turn = new THREE.Quaternion();
    for (const line of this.lines) {
      const thick = this.width * this.factor * line.userData.factor;
      pieces.forEach(([from, to], i) => {
        const way = to.clone().sub(from);
        const length = way.length() || 1e-30;
        turn.setFromUnitVectors(UP, way.divideScalar(length));
        line.setMatrixAt(i, matrix.compose(this.points[i], turn, new THREE.Vector3(thick, length + 0.5 * thick, thick)));
      });
      line.instanceMatrix.needsUpdate = true;
    }
  }

  // Puts the name above the highest point of the line, seen on the page.
  place(onPage) {
    const places = this.points.map(onPage);
    const { x, y } = places.reduce((best, place) => (place.y < best.y ? place : best), { x: -1000, y: 1e9 });
    this.label.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px) translate(-50%, -130%)`;
  }

  dispose() {
    this.label.remove();
    this.lines.forEach(({ material }) => material.dispose());
  }
}
