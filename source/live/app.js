// SPDX-License-Identifier: GPL-3.0-or-later
import { Vector3 } from "./three/build/three.module.js";
import { Connection } from "./messages.js";
import { Panel } from "./panel.js";
import { Pointer } from "./pointer.js";
import { View } from "./view.js";

const view = new View(document.getElementById("canvas"));
let handles = [];
const poses = new Map();

const panel = new Panel((message) => {
  if (message.type === "reset" || message.type === "undo")
    panel.forgetPins();
  if (message.type === "reset")
    handles.forEach(({ shift }) => shift.set(0, 0, 0));
  connection.send(message);
});

function showMarks(pins) {
  if (view.body)
    view.showMarks([...handles.map(({ vertices }) => ({ vertices, colour: "#3b82f6" })),
      ...pins.map((vertices) => ({ vertices, colour: "#e5484d" }))]);
}
panel.onPins = showMarks;

const hear = {
  scene(scene) {
    handles = scene.handles.map((handle) => ({ ...handle, shift: new Vector3() }));
    poses.clear();
    panel.setScene(scene);
  },
  status: (status) => panel.showStatus(status),
  mouse: (mouse) => panel.showMouse(mouse),
  warning: ({ text }) => panel.say(text),
  refused: ({ text }) => panel.say(text),
  saved: ({ text }) => panel.say(`The pose is in ${text}.`),
};

function seeFrame(frame) {
  const isFirst = !view.hasPlace;
  view.setPlaces(frame.places);
  view.setColours(frame.colours);
  panel.showLegend(frame);
  if (isFirst) {
    poses.forEach((places, i) => view.drawPose(places, panel.bars[i].picture));
    showMarks([...panel.pins.values()]);
  }
  view.moveMarks();
  if (frame.number > 0)
    connection.acknowledge(frame.number);
}

const connection = new Connection({
  hear: (message) => hear[message.type] && hear[message.type](message),
  see(message) {
    if (message.kind === 0)
      view.setTopology(message);
    else if (message.kind === 2)
      poses.set(message.number, message.places);
    else
      seeFrame(message);
  },
  change(isOpen) {
    if (!isOpen)
      panel.say("The server does not answer. Is it still there?");
    document.body.dataset.open = isOpen;
  },
});

new Pointer(view, connection, {
  tool: () => panel.tool(),
  strength: () => panel.strength(),
  handleAt: (corners) => handles.find(({ vertices }) => corners.some((vertex) => vertices.includes(vertex))),
  onPin: (vertices) => panel.addPin(vertices),
});
