// SPDX-License-Identifier: GPL-3.0-or-later
// Messages between page and server, see doc/live.md.

const HEAD = 64; // bytes before the places of a frame

// A binary message, decoded: {kind, ...}.
export function decode(buffer) {
  const data = new DataView(buffer);
  const kind = data.getUint32(0, true);
  if (kind === 0 || kind === 3)
    return { kind, nVertices: data.getUint32(4, true), triangles: new Uint32Array(buffer, 12) };
  const n = data.getUint32(48, true);
  const min = [0, 1, 2].map((c) => data.getFloat32(24 + 4 * c, true));
  const size = [0, 1, 2].map((c) => data.getFloat32(36 + 4 * c, true));
  const places = new Float32Array(3 * n);
  const end = HEAD + 6 * n + (data.getUint32(52, true) ? n : 0);
  const shorts = new Int16Array(buffer, HEAD, 3 * n);
  for (let i = 0; i < 3 * n; ++i)
    places[i] = min[i % 3] + ((shorts[i] / 32767 + 1) / 2) * size[i % 3];
  const rest = end < buffer.byteLength ? decode(buffer.slice(end)) : null;
  const tails = rest ? [rest, ...rest.tails] : []; // obstacles, once they have moved, and inner nodes of a drawn surface
  const tail = (wanted) => (tails.find((other) => other.kind === wanted) || { places: null }).places;
  return {
    kind, places, tails,
    number: data.getUint32(4, true), step: data.getUint32(8, true), pointer: data.getUint32(12, true),
    time: data.getFloat64(16, true),
    colours: data.getUint32(52, true) ? new Uint8Array(buffer, HEAD + 6 * n, n) : null,
    low: data.getFloat32(56, true), high: data.getFloat32(60, true),
    obstacles: tail(4), inner: tail(5),
  };
}

// A connection that comes back by itself. hear(text message), see(binary message), change(whether it is open).
export class Connection {
  constructor({ hear, see, change }) {
    this.handlers = { hear, see, change };
    this.open();
  }

  open() {
    const address = new URL("ws", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.search = "";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.handlers.change(true);
    this.socket.onmessage = ({ data }) => {
      if (typeof data === "string")
        this.handlers.hear(JSON.parse(data));
      else
        this.handlers.see(decode(data));
    };
    this.socket.onclose = () => {
      this.handlers.change(false);
      setTimeout(() => this.open(), 2000);
    };
  }

  acknowledge(frame) {
    if (this.socket.readyState === WebSocket.OPEN)
      this.socket.send(`ack ${frame}`);
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN)
      this.socket.send(JSON.stringify(message));
  }
}
