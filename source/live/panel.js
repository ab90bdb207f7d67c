// SPDX-License-Identifier: GPL-3.0-or-later
// Buttons, keys, lists and words. What is shown is what the server said last.
import { Sliders } from "./sliders.js";
import { Weights } from "./weights.js";
import { detailsOf, round, short, speedWords } from "./words.js";

const find = (id) => document.getElementById(id);
const KEYS = { " ": "pause", ".": "step", z: "undo", r: "reset", s: "save", x: "example", e: "with", f: "fit", 1: "front", 2: "side", 3: "top", g: "ground", m: "motion",
  p: "picture", "?": "help" };

// Whether what has the focus wants a key for itself.
const takes = (target, key) => target.matches("select") || (key === " " && target.matches("button, summary, input:not([type=range])"));

export class Panel {
  // do: {fit, front, side, top, ground, picture}, what buttons of the view do
  constructor(send, look) {
    this.send = send;
    this.state = null;
    this.sent = new Set(); // names of pins that the server has not told of yet
    this.sliders = new Sliders(find("sliders"), send);
    this.weights = new Weights(send);
    const press = { pause: () => send({ type: "pause", on: !this.state.paused }), step: () => send({ type: "step" }),
      undo: () => send({ type: "undo" }), reset: () => send({ type: "reset" }), save: () => send({ type: "save pose" }),
      example: () => send({ type: "add example" }),
      take: () => send({ type: "take mouse" }), help: () => this.showHelp(), ...look };
    for (const [id, action] of Object.entries(press))
      find(id).onclick = action;
    addEventListener("keydown", (event) => this.hearKey(event));
    find("close").onclick = () => find("overlay").close();
    find("colour").onchange = ({ target }) => send({ type: "colour", name: target.value });
    find("strength").oninput = () => this.showStrength();
    this.showStrength();
  }

  hearKey(event) {
    const id = KEYS[event.key.toLowerCase()];
    if (!id || event.ctrlKey || event.metaKey || event.altKey || find("overlay").open || takes(event.target, event.key))
      return;
    event.preventDefault();
    find(id).click(); // which does nothing if it is disabled
  }

  showHelp() {
    find("overlay").showModal();
  }

  tool() {
    return document.querySelector("[name=tool]:checked").value;
  }

  strength() {
    return round(10 ** Number(find("strength").value));
  }

  showStrength() {
    find("strength").previousElementSibling.value = `× ${this.strength()}`;
    find("strength").setAttribute("aria-valuetext", `times ${this.strength()}`);
  }

  setScene(scene) {
    this.scene = scene;
    this.sent.clear();
    find("name").textContent = scene.name;
    document.title = `${scene.name} – exemplar live`;
    find("save").hidden = !scene.saves_poses;
    find("example").hidden = !scene.takes_examples;
    find("said").hidden = Number.isFinite(scene.floor); // something rests on it
    this.sliders.setScene(scene);
    this.weights.setScene(scene);
    document.body.classList.remove("waits");
    const colour = find("colour");
    [...colour.options].slice(3).forEach((option) => option.remove());
    if (scene.has_contact) colour.add(new Option("forces of contact", "contact"));
    scene.examples.forEach((name, i) => colour.add(new Option(`distance to ${name}`, `pose ${i}`)));
  }

  setState(state) {
    this.state = state;
    this.showPause(state.paused);
    this.sliders.setState(state);
    this.weights.setState(state);
    find("undo").disabled = state.undo === 0;
    find("colour").value = state.colour;
    state.pins.forEach(({ name }) => this.sent.delete(name));
    this.showPins(state.pins);
    this.showObstacles(state.obstacles.filter(({ there }) => there));
  }

  // Something was refused: nothing is as it was asked for.
  showRefusal(text) {
    this.say(text);
    this.sent.clear();
    this.state && this.setState(this.state);
  }

  showPause(isPaused) {
    find("pause").textContent = isPaused ? "Go on" : "Pause";
    find("step").disabled = !isPaused;
  }

  showStatus(status) {
    this.showPause(status.paused);
    this.rate = status.paused || this.rate === undefined ? status.rate : 0.8 * this.rate + 0.2 * status.rate; // as one of ten a second jitters
    find("speed").textContent = speedWords(status.paused, this.rate);
    find("numbers").replaceChildren(...detailsOf(status, this.rate, this.scene).flatMap(([what, number]) => [
      Object.assign(document.createElement("dt"), { textContent: what }), Object.assign(document.createElement("dd"), { textContent: number })]));
    this.weights.setStatus(status);
  }

  showConnection(isOpen) {
    document.body.dataset.open = isOpen;
    if (isOpen)
      return;
    find("speed").textContent = "no connection";
    this.say("The server does not answer. Is it still there?");
  }

  showMouse({ yours, viewers }) {
    this.hasMouse = yours;
    for (const part of document.querySelectorAll(".acts"))
      part.disabled = !yours;
    find("take").hidden = yours;
    find("mouse").textContent = viewers > 1 ? `${viewers} viewers; ${yours ? "you have" : "another has"} the mouse` : "";
  }

  showLegend(frame) {
    find("legend").hidden = !frame.colours;
    find("low").textContent = short(frame.low);
    find("high").textContent = short(frame.high);
  }

  say(text) {
    find("notice").textContent = text;
    find("notice").hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (find("notice").hidden = true), 8000);
  }

  // The server's list says which names are free; a pin is drawn when it is in that list.
  addPin(vertices) {
    const names = [...this.state.pins.map(({ name }) => name), ...this.sent];
    const name = String(1 + Math.max(0, ...names.map((other) => Number(other) || 0)));
    this.sent.add(name);
    this.send({ type: "pin", name, vertices });
  }

  showPins(pins) {
    this.showList("pins", pins, ({ name }) => ({ text: `pin ${name}`, action: "let go", label: `let go of pin ${name}`, message: { type: "unpin", name } }));
  }

  showObstacles(obstacles) {
    this.showList("obstacles", obstacles, ({ name }) => ({ text: name, action: "remove", label: `remove ${name}`, message: { type: "take away", name } }));
  }

  // A list of what a button ends.
  showList(id, all, itemOf) {
    const names = all.map(({ name }) => name).join("|");
    if (find(id).dataset.names === names)
      return; // so that a button is not made anew while it is pressed
    find(id).dataset.names = names;
    find(id).replaceChildren(...all.map((one) => {
      const { text, action, label, message } = itemOf(one);
      const item = document.createElement("li");
      const button = Object.assign(document.createElement("button"), { textContent: action });
      button.setAttribute("aria-label", label);
      button.onclick = () => this.send(message);
      item.append(text, button);
      return item;
    }));
  }
}
