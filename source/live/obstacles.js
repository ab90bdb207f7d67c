// SPDX-License-Identifier: GPL-3.0-or-later
// What the body may not pass, drawn from the side on which the body is.
import * as THREE from "./three/build/three.module.js";

export class Obstacles {
  constructor({ nVertices, triangles }, colour) {
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles), 1));
    this.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * nVertices), 3));
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshPhongMaterial({ color: colour, flatShading: true, shininess: 5, specular: "#111111" }));
    this.mesh.frustumCulled = false;
  }

  setPlaces(places) {
    this.geometry.attributes.position.array.set(places);
    this.geometry.attributes.position.needsUpdate = true;
  }
}
