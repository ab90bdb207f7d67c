// SPDX-License-Identifier: GPL-3.0-or-later
// Sliders of the body's settings. The number beside a slider is the one in force, as the server says.
import { Latest } from "./latest.js";
import { round, short, withUnit } from "./words.js";

const PAUSE = 100; // between two messages [ms]
const DEAR = 250; // for what costs the solver its factors: a cat's steps take 5 ms then as before, and 20 ms with 100
const same = (x) => x;
const set = (name) => (x) => ({ type: "set", name, numbers: [x] });

// `place` is where the thumb stands for a number, `number` what it stands for there: a round one.
const most = (least, x) => Math.max(least, Math.ceil(Math.abs(x)));

// Along which axis gravity acts: one of the coordinates', or the direction up.
function axisOf(up) {
  const c = up.findIndex((x) => Math.abs(x) > 1 - 1e-9);
  return c < 0 ? { name: "its axis, upwards", along: up } : { name: "xyz"[c], along: [0, 1, 2].map((d) => Number(c === d)) };
}

// One a region with active fibres; until it is moved the scene says its tension.
const tensionOf = ({ name, value, most: greatest }) => ({
  name: `tension ${name}`, text: name === "Material" ? "tension of fibres" : `tension of ${name}`, min: 0, max: greatest, step: greatest / 200,
  place: same, number: round, pause: DEAR, inForce: ({ tensions }) => tensions[name] ?? value,
  words: (x) => withUnit(x, "Pa"), message: (x) => ({ type: "tension", name, numbers: [x] }), needs: true });

function settingsOf({ young, damping, gravity, up, examples, importance, tensions }) {
  const middle = Math.round(Math.log10(young));
  const axis = axisOf(up);
  const part = (vector) => vector.reduce((sum, x, c) => sum + x * axis.along[c], 0);
  const strength = most(20, part(gravity));
  return [
    { name: "importance", text: "importance of the examples", min: 0.01, max: 1, step: 0.01, place: same, number: same, pause: DEAR,
      inForce: (settings) => settings.importance, words: short, message: set("importance"), needs: examples.length > 0 && importance > 0 },
    { name: "young", text: "Young's modulus", min: middle - 2, max: middle + 2, step: 0.05, place: Math.log10, number: (x) => round(10 ** x),
      pause: DEAR, inForce: (settings) => settings.young, words: (x) => withUnit(x, "Pa"), message: set("young"), needs: true },
    { name: "poisson", text: "Poisson's ratio", min: 0, max: 0.49, step: 0.01, place: same, number: same, pause: DEAR,
      inForce: (settings) => settings.poisson, words: short, message: set("poisson"), needs: true },
    { name: "damping", text: "damping", min: 0, max: most(20, damping[0]), step: 0.1, place: same, number: same, pause: DEAR,
      inForce: (settings) => settings.damping[0], words: (x) => `${short(x)} /s`,
      message: (x, settings) => ({ type: "damping", numbers: [x, settings.damping[1]] }), needs: true },
    { name: "gravity", text: `gravity along ${axis.name}`, min: -strength, max: strength, step: 0.1, place: same, number: same,
      pause: PAUSE, inForce: (settings) => part(settings.gravity), words: (x) => `${short(x)} m/s²`,
      message: (x, { gravity: now }) => ({ type: "gravity", numbers: now.map((g, c) => (axis.along[c] === 1 ? x : g + (x - part(now)) * axis.along[c])) }), needs: true },
    ...tensions.map(tensionOf),
  ];
}

class Slider {
  constructor(what, send) {
    this.what = what;
    const { name, text, min, max, step, pause, message, number } = what;
    this.element = Object.assign(document.createElement("label"), { className: "slider" });
    this.output = document.createElement("output");
    this.input = Object.assign(document.createElement("input"), { type: "range", min, max, step, id: name });
    this.element.append(text, this.output, this.input);
    this.latest = new Latest((x) => send(message(x, this.settings)), pause);
    this.input.oninput = () => this.latest.want(number(Number(this.input.value)));
  }

  // The thumb is left to who drags it.
  show({ settings, means }) {
    this.settings = settings;
    this.latest.answered();
    const { name, inForce, words, place } = this.what;
    const x = inForce(settings);
    this.output.value = (means.includes(name) ? "on average " : "") + words(x);
    this.input.setAttribute("aria-valuetext", this.output.value);
    if (!this.latest.isBusy && !this.input.matches(":active"))
      this.input.value = place(x);
  }
}

export class Sliders {
  constructor(parent, send) {
    Object.assign(this, { parent, send });
    this.all = [];
  }

  setScene(scene) {
    this.all = settingsOf(scene).filter(({ needs }) => needs).map((what) => new Slider(what, this.send));
    this.parent.replaceChildren(...this.all.map(({ element }) => element));
  }

  setState(state) {
    this.all.forEach((slider) => slider.show(state));
  }
}
