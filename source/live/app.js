// SPDX-License-Identifier: GPL-3.0-or-later
import { Vector3 } from "./three/build/three.module.js";
import { Connection } from "./messages.js";
import { Motion } from "./motion.js";
import { Panel } from "./panel.js";
import { Pointer } from "./pointer.js";
import { decodeSkin } from "./skin.js";
import { save, View } from "./view.js";

const find = (id) => document.getElementById(id);

export const view = new View(find("canvas"));
let scene = null;
let handles = []; // of the scene: {name, vertices, shift}
let pins = []; // of the state
let obstacles = []; // of the state: {name, triangles, shift}
let brush = []; // vertices that were touched
let hasPulled = false;
const poses = new Map();

const look = Object.fromEntries([["fit", "home"], ["front", "front"], ["side", "side"], ["top", "top"]].map(([id, name]) => [id, () => view.look(name)]));
look.ground = () => find("ground").setAttribute("aria-pressed", view.toggleGround());
look.picture = () => view.savePicture(`exemplar-${scene ? scene.name : "live"}`);
const panel = new Panel((message) => connection.send(message), look);
export const motion = new Motion(find("motion"), { save, say: (text) => panel.say(text) });

function showMarks() {
  view.showMarks([...handles.map(({ name, vertices }) => ({ name, kind: "handle", vertices })),
    ...pins.map(({ name, vertices }) => ({ name, kind: "pin", vertices })), { name: "brush", kind: "pin", vertices: brush }]);
}

const hear = {
  scene(message) {
    scene = message;
    handles = scene.handles.map((handle) => ({ ...handle, shift: new Vector3() }));
    poses.clear();
    view.setScene(scene);
    panel.setScene(scene);
    motion.setScene(scene);
    fetchSkin();
  },
  state(state) {
    const isOther = JSON.stringify(state.pins) !== JSON.stringify(pins);
    ({ pins, obstacles } = state);
    for (const handle of handles) {
      const moved = state.handles.find(({ name }) => name === handle.name);
      handle.shift = new Vector3().fromArray(moved ? moved.shift : [0, 0, 0]);
    }
    panel.setState(state);
    if (isOther)
      showMarks();
  },
  status: (status) => panel.showStatus(status),
  mouse(mouse) {
    panel.showMouse(mouse);
    if (!mouse.yours)
      pointer.drop();
  },
  warning: ({ text }) => panel.say(text),
  refused({ text }) {
    panel.showRefusal(text);
    if (/^(grab|move|handle|carry): /.test(text))
      pointer.drop(); // or each place of the pointer would be refused
  },
  saved: ({ text }) => panel.say(`The pose is in ${text}.`),
};

// While the surface that is drawn comes, the first frame and the newest wait for it.
let waiting = null;

async function fetchSkin() {
  const mine = (waiting = scene.draws_surface ? { first: null, newest: null } : null);
  if (!mine)
    return;
  const answer = await fetch("surface.bin").catch(() => null);
  const skin = answer && answer.ok ? decodeSkin(await answer.arrayBuffer()) : null;
  if (waiting !== mine)
    return; // there is another scene
  waiting = null;
  if (skin)
    view.setSkin(skin);
  for (const frame of [mine.first, mine.newest])
    frame && seeFrame(frame);
}

function seeFrame(frame) {
  if (waiting) {
    waiting.first ? (waiting.newest = frame) : (waiting.first = frame);
    if (frame.number > 0)
      connection.acknowledge(frame.number);
    return;
  }
  const isFirst = !view.hasPlace;
  view.setPlaces(frame.places, frame.inner);
  view.setColours(frame.colours);
  view.skin && frame.number > 0 && motion.see(frame.time, view.skin.places);
  if (frame.obstacles && view.obstacles)
    view.obstacles.setPlaces(frame.obstacles);
  panel.showLegend(frame);
  if (isFirst) {
    view.drawPoses([...poses].map(([i, pose]) => ({ ...pose, canvas: panel.weights.bars[i].picture })), frame);
    showMarks();
  }
  if (frame.number > 0)
    connection.acknowledge(frame.number);
}

const connection = new Connection({
  hear: (message) => hear[message.type] && hear[message.type](message),
  see(message) {
    if (message.kind === 0)
      view.setTopology(message);
    else if (message.kind === 3)
      view.setObstacles(message);
    else if (message.kind === 4)
      view.obstacles.setPlaces(message.places);
    else if (message.kind === 2)
      poses.set(message.number, { places: message.places, inner: message.inner });
    else
      seeFrame(message);
  },
  change(isOpen) {
    panel.showConnection(isOpen);
    if (!isOpen)
      pointer.drop();
  },
});

// An obstacle on the page is found by the name that no other has had.
const names = new Set();
function putObstacle(kind) {
  const { radius } = view.sphere();
  const size = 0.2 * radius;
  const at = view.placeBeside(size).toArray();
  let number = 1;
  while (names.has(`${kind} ${number}`) || obstacles.some(({ name }) => name === `${kind} ${number}`))
    ++number;
  names.add(`${kind} ${number}`);
  const friction = 0.5;
  const numbers = kind === "ball" ? [...at, size, friction] : [...at.map((x) => x - size), ...at.map((x) => x + size), friction];
  connection.send({ type: "put", name: `${kind} ${number}`, numbers });
}
for (const kind of ["ball", "block"])
  find(kind).onclick = () => putObstacle(kind);

const pointer = new Pointer(view, connection, {
  obstacleAt(event) {
    const hit = view.pickObstacle(event, obstacles);
    const of = hit && obstacles.find(({ name }) => name === hit.name);
    return of && of.movable ? { ...hit, of, shift: new Vector3().fromArray(of.shift) } : null;
  },
  tool: () => panel.tool(),
  strength: () => panel.strength(),
  mayAct: () => Boolean(panel.hasMouse && panel.state),
  grabRadius: () => scene.grab_radius,
  handleAt: (corners) => handles.find(({ vertices }) => corners.some((vertex) => vertices.includes(vertex))),
  onPin: (vertices) => panel.addPin(vertices),
  onBrush(vertices) {
    brush = vertices;
    showMarks();
  },
  onPull: () => (hasPulled = true),
});

// Hint beside the body until it is pulled first; hidden while it is held.
setInterval(() => {
  find("hint").hidden = hasPulled || !view.hasPlace || !panel.hasMouse || Boolean(pointer.held);
  if (find("hint").hidden)
    return;
  const { center, radius } = view.sphere();
  const { x, y } = view.onPage(center.clone().addScaledVector(view.eye.up, 0.8 * radius));
  find("hint").style.transform = `translate(${Math.round(x)}px, ${Math.round(Math.max(110, y))}px)`;
}, 100);
