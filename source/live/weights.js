// SPDX-License-Identifier: GPL-3.0-or-later
// The examples: whether they act, how much of each is in the body, and who says so.
import { Latest } from "./latest.js";

const find = (id) => document.getElementById(id);
const create = (name, properties = {}) => Object.assign(document.createElement(name), properties);

export class Weights {
  constructor(send) {
    this.send = send;
    this.bars = [];
    this.latest = new Latest((numbers) => send({ type: "weights", numbers }), 100);
    for (const rule of document.querySelectorAll("[name=rule]"))
      rule.onchange = () => send({ type: "weights", numbers: rule.value === "by hand" ? this.inForce || [] : [] });
    for (const choice of document.querySelectorAll("[name=energy]"))
      choice.onchange = () => send({ type: "energy", name: choice.value });
    find("with").onchange = () => this.toggle();
  }

  setScene({ examples, weight_regions: regions, finds_weights: areFound, weights_add: areAdded, importance, bounds, chooses_energy: choosesEnergy }) {
    this.areAdded = areAdded;
    find("examples").hidden = examples.length === 0;
    find("rule").hidden = !areFound;
    find("energy").hidden = !choosesEnergy;
    find("switch").hidden = !(importance > 0);
    [this.least] = bounds.importance;
    this.bars = examples.map((name, i) => this.bar(name, i, regions.length > 1 ? regions : [null]));
    find("weights").replaceChildren(...this.bars.map(({ element }) => element));
  }

  // One fill a region, one under the other.
  bar(name, i, regions) {
    const element = create("div", { className: "weight" });
    const picture = create("canvas", { width: 144, height: 108 });
    const right = create("div");
    const label = create("span", { textContent: name, className: "name", title: name });
    const output = create("output");
    const bar = create("div", { className: "bar" });
    const fills = regions.map((number) => create("i", { title: number === null ? "" : `region ${number}` }));
    bar.style.height = `${Math.max(10, 4 * fills.length)}px`;
    for (const fill of fills)
      fill.style.height = `${100 / fills.length}%`;
    bar.append(...fills);
    const input = create("input", { type: "range", min: 0, max: 1, step: 0.01, hidden: true });
    input.setAttribute("aria-label", `weight of ${name}`);
    input.oninput = () => this.hold(i, Number(input.value));
    right.append(label, output, bar, input);
    element.append(picture, right);
    return { element, picture, fills, output, input };
  }

  // Ask for the examples to act, or to do as if there were none. The switch turns when the server says so.
  toggle() {
    const { with_examples: areActing, importance_with_examples: importance } = this.state;
    this.send({ type: "set", name: "importance", numbers: [areActing ? this.least : importance] });
    find("with").checked = areActing;
  }

  // The others share what is left as they did before, or stay where weights have no sum.
  hold(i, value) {
    if (this.areAdded) {
      this.latest.want(this.bars.map(({ input }, k) => (k === i ? value : Number(input.value))));
      return;
    }
    const rest = this.bars.reduce((sum, { input }, k) => sum + (k === i ? 0 : Number(input.value)), 0);
    const numbers = this.bars.map(({ input }, k) =>
      k === i ? value : rest > 0 ? ((1 - value) * Number(input.value)) / rest : (1 - value) / Math.max(1, this.bars.length - 1));
    const sum = numbers.reduce((a, b) => a + b, 0);
    this.bars.forEach(({ input }, k) => (input.value = numbers[k]));
    if (sum > 0)
      this.latest.want(numbers.map((weight) => weight / sum));
  }

  setState(state) {
    this.state = state;
    find("with").checked = state.with_examples;
    document.body.dataset.examples = state.with_examples;
    for (const rule of document.querySelectorAll("[name=rule]"))
      rule.checked = (rule.value === "by hand") === state.weights_by_hand;
    for (const choice of document.querySelectorAll("[name=energy]"))
      choice.checked = choice.value === state.settings.energy;
    this.latest.answered();
    this.bars.forEach(({ input }, i) => {
      input.hidden = !state.weights_by_hand;
      if (!this.latest.isBusy && !input.matches(":active"))
        input.value = state.weights_by_hand ? state.weights_wanted[i] : 0;
    });
  }

  // The number is the mean of all regions.
  setStatus({ weights }) {
    const n = this.bars.length;
    this.inForce = this.bars.map(({ output, fills }, i) => {
      const regions = weights.filter((_, k) => k % n === i);
      const mean = regions.reduce((sum, w) => sum + w, 0) / Math.max(1, regions.length);
      output.value = mean.toFixed(2);
      fills.forEach((fill, k) => (fill.style.width = `${100 * Math.min(1, Math.max(0, regions[k] ?? 0))}%`));
      return mean;
    });
  }
}
