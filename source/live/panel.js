// SPDX-License-Identifier: GPL-3.0-or-later
// Buttons, sliders, bars and words.

const find = (id) => document.getElementById(id);
const short = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-2 ? x.toExponential(1) : String(Number(x.toPrecision(3))));

// What may be set: name, text, range of the slider, and the number that the slider stands for.
const slidersOf = (scene) => [
  { name: "importance", text: "importance", min: 0.01, max: 1, start: scene.importance, number: (x) => x, needs: scene.examples.length > 0 && scene.importance > 0 },
  { name: "young", text: "Young's modulus [Pa]", min: -2, max: 2, start: 0, number: (x) => scene.young * 10 ** x, needs: true },
  { name: "poisson", text: "Poisson's ratio", min: 0, max: 0.49, start: scene.poisson, number: (x) => x, needs: true },
  { name: "damping", text: "damping [1/s]", min: 0, max: 20, start: scene.damping[0], number: (x) => x, needs: true,
    message: (x) => ({ type: "damping", numbers: [x, scene.damping[1]] }) },
  { name: "gravity", text: "gravity along z [m/s²]", min: -20, max: 20, start: scene.gravity[2], number: (x) => x, needs: true,
    message: (x) => ({ type: "gravity", numbers: [scene.gravity[0], scene.gravity[1], x] }) },
];

export class Panel {
  constructor(send) {
    this.send = send;
    this.isPaused = false;
    this.pins = new Map();
    const press = { pause: () => send({ type: "pause", on: !this.isPaused }), step: () => send({ type: "step" }),
      undo: () => send({ type: "undo" }), reset: () => send({ type: "reset" }), save: () => send({ type: "save pose" }),
      take: () => send({ type: "take mouse" }) };
    for (const [id, action] of Object.entries(press))
      find(id).onclick = action;
    const keys = { " ": "pause", ".": "step", z: "undo", r: "reset", s: "save" };
    addEventListener("keydown", (event) => {
      const id = keys[event.key];
      if (!id || event.target.matches("input, select, button") || event.metaKey || event.altKey)
        return;
      event.preventDefault();
      press[id]();
    });
    find("colour").onchange = ({ target }) => send({ type: "colour", name: target.value });
    for (const rule of document.querySelectorAll("[name=rule]"))
      rule.onchange = () => send({ type: "weights", numbers: rule.value === "by hand" ? this.weights || [] : [] });
    const strength = find("strength");
    const show = () => (strength.previousElementSibling.value = `× ${short(this.strength())}`);
    strength.oninput = show;
    show();
  }

  tool() {
    return document.querySelector("[name=tool]:checked").value;
  }

  strength() {
    return 10 ** Number(find("strength").value);
  }

  setScene(scene) {
    this.scene = scene;
    find("name").textContent = scene.name;
    document.title = `${scene.name} – exemplar live`;
    find("sliders").replaceChildren(...slidersOf(scene).filter(({ needs }) => needs).map((slider) => this.slider(slider)));
    find("examples").hidden = scene.examples.length === 0;
    find("rule").hidden = !scene.finds_weights;
    this.bars = scene.examples.map((name, i) => this.bar(name, i));
    find("weights").replaceChildren(...this.bars.map(({ element }) => element));
    const colour = find("colour");
    [...colour.options].slice(3).forEach((option) => option.remove());
    scene.examples.forEach((name, i) => colour.add(new Option(`distance to ${name}`, `pose ${i}`)));
    this.pins.clear();
    this.showPins();
  }

  slider({ name, text, min, max, start, number, message }) {
    const label = document.createElement("label");
    label.className = "slider";
    const output = document.createElement("output");
    const input = Object.assign(document.createElement("input"), { type: "range", min, max, step: (max - min) / 200, value: start, id: name });
    label.append(text, output, input);
    const show = () => (output.value = short(number(Number(input.value))));
    input.oninput = show;
    input.onchange = () => {
      const value = number(Number(input.value));
      this.send(message ? message(value) : { type: "set", name, numbers: [value] });
    };
    show();
    return label;
  }

  bar(name, i) {
    const element = document.createElement("div");
    element.className = "weight";
    const picture = Object.assign(document.createElement("canvas"), { width: 144, height: 108 });
    const right = document.createElement("div");
    const output = document.createElement("output");
    const bar = document.createElement("div");
    bar.className = "bar";
    const fill = document.createElement("i");
    bar.append(fill);
    const input = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 1, step: 0.01, hidden: true });
    input.setAttribute("aria-label", `weight of ${name}`);
    input.oninput = () => this.holdWeight(i, Number(input.value));
    right.append(name, " ", output, bar, input);
    element.append(picture, right);
    return { element, picture, fill, output, input };
  }

  // The others share what is left as they did before.
  holdWeight(i, value) {
    const rest = this.bars.reduce((sum, { input }, k) => sum + (k === i ? 0 : Number(input.value)), 0);
    const numbers = this.bars.map(({ input }, k) =>
      k === i ? value : rest > 0 ? ((1 - value) * Number(input.value)) / rest : (1 - value) / Math.max(1, this.bars.length - 1));
    const sum = numbers.reduce((a, b) => a + b, 0);
    this.bars.forEach(({ input }, k) => (input.value = numbers[k]));
    if (sum > 0)
      this.send({ type: "weights", numbers: numbers.map((weight) => weight / sum) });
  }

  // Whether they are those of sliders: said by the server, because an undo or a reset may have changed it.
  showRule(isByHand) {
    if (this.isByHand !== isByHand)
      for (const rule of document.querySelectorAll("[name=rule]"))
        rule.checked = (rule.value === "by hand") === isByHand;
    for (const { input } of this.bars)
      input.hidden = !isByHand;
    if (!isByHand || !this.isByHand)
      this.bars.forEach(({ input }, i) => (input.value = this.weights[i]));
    this.isByHand = isByHand;
  }

  showStatus(status) {
    this.isPaused = status.paused;
    find("pause").textContent = status.paused ? "Go on" : "Pause";
    find("step").disabled = !status.paused;
    const residual = status.residual === null ? "–" : status.residual.toExponential(1);
    find("strip").replaceChildren(...[
      `t = ${status.time.toFixed(2)} s`, status.paused ? "paused" : `${Math.round(100 * status.rate)} % of real time`,
      `${status.behind.toFixed(1)} frames behind`, `${status.iterations} iterations`, `step error ${residual}`,
      `${status.milliseconds.toFixed(0)} ms a step`].map((text) => Object.assign(document.createElement("span"), { textContent: text })));
    const n = this.bars ? this.bars.length : 0;
    this.weights = [];
    for (let i = 0; i < n; ++i) {
      const regions = status.weights.filter((_, k) => k % n === i);
      const mean = regions.reduce((sum, w) => sum + w, 0) / Math.max(1, regions.length);
      this.bars[i].output.value = mean.toFixed(2);
      this.bars[i].fill.style.width = `${100 * Math.min(1, Math.max(0, mean))}%`;
      this.weights.push(mean);
    }
    this.showRule(status.weights_by_hand);
  }

  showMouse({ yours, viewers }) {
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

  addPin(vertices) {
    const name = String(1 + Math.max(0, ...[...this.pins.keys()].map(Number)));
    this.send({ type: "pin", name, vertices });
    this.pins.set(name, vertices);
    this.showPins();
  }

  forgetPins() {
    this.pins.clear();
    this.showPins();
  }

  showPins() {
    find("pins").replaceChildren(...[...this.pins.keys()].map((name) => {
      const item = document.createElement("li");
      const button = Object.assign(document.createElement("button"), { textContent: "let go" });
      button.onclick = () => {
        this.send({ type: "unpin", name });
        this.pins.delete(name);
        this.showPins();
      };
      item.append(`pin ${name}`, button);
      return item;
    }));
    this.onPins && this.onPins([...this.pins.values()]);
  }
}
