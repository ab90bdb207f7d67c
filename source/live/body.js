// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of the body, its colours, and the patch of it that the pointer would take hold of.
import * as THREE from "./three/build/three.module.js";

const RAMP = ["#30123b", "#4662d7", "#36aaf9", "#1ae4b6", "#72fe5e", "#c8ef34", "#faba39", "#f66b19", "#ca2a04"]
  .map((text) => new THREE.Color(text));

function rampColour(byte) {
  const place = (byte / 255) * (RAMP.length - 1);
  const below = Math.min(Math.floor(place), RAMP.length - 2);
  return RAMP[below].clone().lerp(RAMP[below + 1], place - below);
}
const TABLE = Array.from({ length: 256 }, (_, byte) => rampColour(byte));

// The patch is light, as the share of the pull falls to its border, where there is a light line and a dark one.
const PATCH = "if (patchRadius > 0.0) { float far = distance(place, patchAt) / patchRadius; float light = max(0.0, 1.0 - far * far);" +
  "vec4 edge = smoothstep(vec4(0.93, 0.955, 0.965, 0.99), vec4(0.935, 0.965, 0.975, 1.0), vec4(far));" +
  "gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(1.0), max(0.6 * light * light, edge.x - edge.y));" +
  "gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(0.06, 0.07, 0.1), edge.z - edge.w); }";

export class Body {
  constructor({ nVertices, triangles }, colour) {
    this.plain = new THREE.Color(colour);
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles), 1));
    for (const name of ["position", "normal", "color"])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * nVertices), 3));
    this.patch = { patchAt: { value: new THREE.Vector3() }, patchRadius: { value: 0 } };
    this.mesh = new THREE.Mesh(this.geometry, this.material());
    this.mesh.frustumCulled = false;
    this.hasColours = null;
  }

  material() {
    const material = new THREE.MeshPhongMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide, shininess: 15, specular: "#222222" });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.patch);
      shader.vertexShader = `varying vec3 place;\n${shader.vertexShader}`.replace("#include <begin_vertex>", "#include <begin_vertex>\nplace = position;");
      shader.fragmentShader = `varying vec3 place; uniform vec3 patchAt; uniform float patchRadius;\n${shader.fragmentShader}`
        .replace("#include <dithering_fragment>", `#include <dithering_fragment>\n${PATCH}`);
    };
    return material;
  }

  setPlaces(places) {
    this.geometry.attributes.position.array.set(places);
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.geometry.boundingSphere = null; // for the ray
  }

  get places() {
    return this.geometry.attributes.position.array;
  }

  setColours(bytes) {
    if (!bytes && this.hasColours === false)
      return;
    const colours = this.geometry.attributes.color;
    for (let i = 0; i < colours.count; ++i)
      (bytes ? TABLE[bytes[i]] : this.plain).toArray(colours.array, 3 * i);
    colours.needsUpdate = true;
    this.hasColours = Boolean(bytes);
  }

  // Shows the patch; null: none.
  showPatch(point, radius = 0) {
    this.patch.patchRadius.value = point ? radius : 0;
    if (point)
      this.patch.patchAt.value.copy(point);
  }

  vertex(i) {
    return new THREE.Vector3().fromArray(this.places, 3 * i);
  }

  corners(triangle) {
    const index = this.geometry.index.array;
    return [0, 1, 2].map((a) => index[3 * triangle + a]);
  }

  pointOf({ triangle, shares }) {
    const point = new THREE.Vector3();
    this.corners(triangle).forEach((i, a) => point.addScaledVector(this.vertex(i), shares[a]));
    return point;
  }

  // The first hit of a ray with the surface: {triangle, shares, point}; null: none.
  hit(caster) {
    const hit = caster.intersectObject(this.mesh)[0];
    if (!hit)
      return null;
    const [a, b, c] = this.corners(hit.faceIndex).map((i) => this.vertex(i));
    const shares = new THREE.Triangle(a, b, c).getBarycoord(hit.point, new THREE.Vector3()).toArray().map((x) => Math.max(0, x));
    const sum = shares[0] + shares[1] + shares[2];
    return { triangle: hit.faceIndex, shares: shares.map((x) => x / sum), point: hit.point, distance: hit.distance };
  }
}
