// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and what goes on, in words.

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"]];

// A number with four digits, without trailing zeros.
export function short(x) {
  const rounded = Number(x.toPrecision(4));
  const size = Math.abs(rounded);
  return size !== 0 && (size >= 1e5 || size < 1e-3) ? rounded.toExponential().replace("e+", "e") : String(rounded);
}

// A number with a prefixed unit, such as 1.25 MPa.
export function withUnit(x, unit) {
  const [size, prefix] = PREFIXES.find(([least]) => Math.abs(x) >= least) || [1, ""];
  return `${short(x / size)} ${prefix}${unit}`;
}

// The nearest number with two digits.
export const round = (x) => Number(x.toPrecision(2));

// The pace of the simulation, for users who have never heard of a frame.
export function speedWords(isPaused, rate) {
  if (isPaused)
    return "paused";
  return rate >= 0.95 ? "real time" : `slow motion: ${Math.round(100 * rate)} % of real time`;
}

// The numbers behind those words: [what, how much].
export function detailsOf(status, rate, { cells }) {
  return [
    ["simulated time", `${status.time.toFixed(2)} s`],
    ["speed", `${Math.round(100 * rate)} % of real time`],
    ["behind the clock", `${status.behind.toFixed(1)} frames`],
    ["longest step", `${status.milliseconds.toFixed(0)} ms`],
    ["iterations of a step", String(status.iterations)],
    ["step error", status.residual === null ? "–" : short(round(status.residual))],
    ["body", `${cells} cells`],
  ];
}
