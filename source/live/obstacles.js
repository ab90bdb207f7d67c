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

  // Places of another set of obstacles are left out: those of these follow.
  setPlaces(places) {
    const { position } = this.geometry.attributes;
    if (places.length !== position.array.length)
      return;
    position.array.set(places);
    position.needsUpdate = true;
    this.geometry.boundingSphere = null; // for the ray
  }

  // The first hit of a ray: {name, point, distance}; null: none. `list`: {name, triangles} of each obstacle.
  hit(caster, list) {
    const hit = this.geometry.index.count > 0 ? caster.intersectObject(this.mesh)[0] : null;
    if (!hit)
      return null;
    let end = 0;
    const found = list.find(({ triangles }) => hit.faceIndex < (end += triangles));
    return found ? { name: found.name, point: hit.point, distance: hit.distance } : null;
  }
}
