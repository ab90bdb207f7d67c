// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of handles, rings on vertices that are pinned, and the line of a pull. All have dark borders, as they are seen on any colour.
import * as THREE from "./three/build/three.module.js";
import { Outline } from "./outline.js";

const PIXELS = 64;

// The ring of a mark, with a dot for pins.
function ring(colour, edge, hasDot) {
  const canvas = Object.assign(document.createElement("canvas"), { width: PIXELS, height: PIXELS });
  const pen = canvas.getContext("2d");
  const circle = (radius, width, style) => {
    pen.beginPath();
    pen.arc(PIXELS / 2, PIXELS / 2, radius, 0, 2 * Math.PI);
    Object.assign(pen, { lineWidth: width, strokeStyle: style, fillStyle: style });
    width ? pen.stroke() : pen.fill();
  };
  circle(21, 21, edge);
  circle(21, 10, colour);
  if (hasDot) {
    circle(10, 0, edge);
    circle(6, 0, colour);
  }
  return new THREE.CanvasTexture(canvas);
}

// Some of the vertices, no two of them nearer than a distance, so that their rings do not touch.
function spaced(vertices, vertexAt, distance) {
  const places = [];
  return vertices.filter((vertex) => {
    const place = vertexAt(vertex);
    const isFree = places.every((other) => other.distanceToSquared(place) > distance * distance);
    if (isFree)
      places.push(place);
    return isFree;
  });
}

export class Marks {
  // `names`: the element that holds the names of handles
  constructor(colours, names) {
    Object.assign(this, { colours, names });
    this.outlines = [];
    this.group = new THREE.Group();
    this.rings = { handle: ring(colours.handle, colours.edge, false), pin: ring(colours.pin, colours.edge, true) };
    this.spring = new THREE.Group();
    const rod = new THREE.CylinderBufferGeometry(1, 1, 1, 12);
    this.spring.add(...[[colours.edge, 2, 4], [colours.spring, 1, 5]].map(([color, width, renderOrder]) => {
      const mesh = new THREE.Mesh(rod, new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true }));
      mesh.scale.set(width, 1, width);
      return Object.assign(mesh, { renderOrder });
    }));
    this.spring.visible = false;
  }

  // `groups` is [{name, kind, vertices}], at the places and normals of a geometry.
  set(groups, geometry, distance) {
    this.group.children.slice().forEach((child) => {
      child.geometry && child.geometry.dispose();
      this.group.remove(child);
    });
    this.outlines.forEach((outline) => outline.dispose());
    this.outlines = [];
    const vertexAt = (i) => new THREE.Vector3().fromArray(geometry.attributes.position.array, 3 * i);
    for (const { name, kind, vertices } of groups) {
      if (kind === "handle") {
        const outline = new Outline({ name, vertices }, geometry, { colour: this.colours.handle, edge: this.colours.edge }, 0.1 * distance);
        if (!outline.isEmpty) { // else all of a part of the body is held, which has rings
          this.group.add(outline.group);
          this.names.append(outline.label);
          this.outlines.push(outline);
          continue;
        }
        outline.dispose();
      }
      const shown = spaced(vertices, vertexAt, distance);
      const own = new THREE.BufferGeometry();
      own.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * shown.length), 3));
      const points = new THREE.Points(own, new THREE.PointsMaterial(
        { map: this.rings[kind], size: 14, sizeAttenuation: false, transparent: true, alphaTest: 0.3 }));
      points.frustumCulled = false;
      points.renderOrder = 3;
      points.userData = { name, kind, shown };
      this.group.add(points);
    }
    this.lift = 0.3 * distance;
    this.move(geometry);
  }

  // Places rings a little above the surface, which would hide half of them.
  move(geometry) {
    const { position, normal } = geometry.attributes;
    this.outlines.forEach((outline) => outline.move(geometry));
    for (const { geometry: own, userData } of this.group.children.filter(({ isPoints }) => isPoints)) {
      const { array } = own.attributes.position;
      userData.shown.forEach((i, k) => {
        for (let c = 0; c < 3; ++c)
          array[3 * k + c] = position.array[3 * i + c] + this.lift * normal.array[3 * i + c];
      });
      own.attributes.position.needsUpdate = true;
    }
  }

  // Enlarges the line of the handle under the pointer.
  stress(name) {
    this.outlines.forEach((outline) => outline.stress(outline.group.userData.name === name));
    for (const { material, userData } of this.group.children.filter(({ isPoints }) => isPoints))
      material.size = userData.kind === "handle" && userData.name === name ? 20 : 14;
  }

  placeNames(onPage) {
    this.outlines.forEach((outline) => outline.place(onPage));
  }

  // Draws the line of a pull, of the same width on screen wherever the camera is.
  showSpring(from, to, camera) {
    this.spring.visible = Boolean(from) && from.distanceTo(to) > 0;
    if (!this.spring.visible)
      return;
    const width = 0.0016 * camera.position.distanceTo(to);
    const way = to.clone().sub(from);
    this.spring.position.lerpVectors(from, to, 0.5);
    this.spring.scale.set(width, way.length(), width);
    this.spring.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
  }
}
