// SPDX-License-Identifier: GPL-3.0-or-later
// The artist's surface and what it wears, drawn instead of the body's boundary. Each vertex is linear in the places of nodes.
import { Body } from "./body.js";

// The surface of surface.bin, decoded; doc/live.md.
export function decodeSkin(buffer) {
  const [nVertices, nTriangles, nShares] = new Uint32Array(buffer, 0, 3);
  let at = 12;
  const take = (Type, n) => {
    const array = new Type(buffer, at, n);
    at += 4 * n;
    return array;
  };
  return { nVertices, offsets: take(Float32Array, 3 * nVertices), ends: take(Uint32Array, nVertices), nearest: take(Uint32Array, nVertices),
    nodes: take(Uint32Array, nShares), values: take(Float32Array, nShares), triangles: take(Uint32Array, 3 * nTriangles) };
}

export class Skin {
  constructor(data, colour) {
    this.data = data;
    this.drawn = new Body(data, colour);
  }

  get mesh() {
    return this.drawn.mesh;
  }

  // `inner`: places of the nodes that the boundary has not; null: there are none.
  setPlaces(boundary, inner) {
    const { nVertices, offsets, ends, nodes, values } = this.data;
    const places = inner ? new Float32Array(boundary.length + inner.length) : boundary;
    if (inner) {
      places.set(boundary);
      places.set(inner, boundary.length);
    }
    const result = Float32Array.from(offsets);
    for (let v = 0, i = 0; v < nVertices; ++v)
      for (; i < ends[v]; ++i)
        for (let c = 0; c < 3; ++c)
          result[3 * v + c] += values[i] * places[3 * nodes[i] + c];
    this.places = result;
    this.drawn.setPlaces(result);
  }

  // Each vertex has the colour of the boundary's vertex that moves it most.
  setColours(bytes) {
    this.drawn.setColours(bytes && this.data.nearest.map((i) => (i < bytes.length ? bytes[i] : 0)));
  }
}
