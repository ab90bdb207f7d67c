// SPDX-License-Identifier: GPL-3.0-or-later
// What the surfaces do from one press of a button to the next, as point caches of the artist's files.

const PER_SECOND = 24; // of the body's time, as Blender has it
const MOST_BYTES = 1e9;

// The file of a .pc2: samples are arrays of 3 n numbers.
export function pointCache(samples, n) {
  const head = new DataView(new ArrayBuffer(32));
  [..."POINTCACHE2"].forEach((letter, i) => head.setUint8(i, letter.charCodeAt(0)));
  head.setInt32(12, 1, true); // version
  head.setInt32(16, n, true);
  head.setFloat32(20, 0, true); // first frame
  head.setFloat32(24, 1, true); // frames a sample
  head.setInt32(28, samples.length, true);
  return new Blob([head, ...samples]);
}

// At even times, linear in between.
export function resampled(moments, perSecond) {
  const [first, last] = [moments[0].time, moments[moments.length - 1].time];
  const samples = [];
  for (let i = 0, k = 0; first + k / perSecond <= last + 1e-9; ++k) {
    const time = first + k / perSecond;
    while (i + 2 < moments.length && moments[i + 1].time < time)
      ++i;
    const [before, after] = [moments[i], moments[Math.min(i + 1, moments.length - 1)]];
    const part = after.time > before.time ? Math.min(1, (time - before.time) / (after.time - before.time)) : 0;
    samples.push(before.places.map((x, c) => x + part * (after.places[c] - x)));
  }
  return samples;
}

export class Motion {
  // save(blob, name of the file)
  constructor(button, { save, say }) {
    Object.assign(this, { button, save, say });
    this.moments = null; // {time, places} while motion is kept
    button.onclick = () => this.press();
  }

  setScene({ name, scale, surfaces }) {
    Object.assign(this, { name, scale, surfaces });
    this.button.hidden = surfaces.length === 0;
    this.stop();
  }

  stop() {
    this.moments = null;
    this.button.textContent = "Record motion";
    this.button.setAttribute("aria-pressed", "false");
  }

  // Places of all vertices at a time of the body. What an undone pull has done is forgotten.
  see(time, places) {
    if (!this.moments)
      return;
    while (this.moments.length > 0 && this.moments[this.moments.length - 1].time >= time)
      this.moments.pop();
    this.moments.push({ time, places: places.slice() });
    if (this.moments.length * places.byteLength > MOST_BYTES) {
      this.say("The motion has a gigabyte, and is saved so far.");
      this.press();
    }
  }

  press() {
    if (!this.moments) {
      this.moments = [];
      this.button.textContent = "Save motion";
      this.button.setAttribute("aria-pressed", "true");
      return;
    }
    const { moments } = this;
    this.stop();
    if (moments.length < 2)
      return this.say("Nothing has moved meanwhile, so that there is no motion to save.");
    const samples = resampled(moments, PER_SECOND);
    let at = 0;
    for (const { name, vertices } of this.surfaces) {
      const end = at + 3 * vertices;
      const own = samples.map((places) => places.slice(at, end).map((x) => x / this.scale));
      this.save(pointCache(own, vertices), `${[this.name, name].filter(Boolean).join("-")}.pc2`);
      at = end;
    }
  }
}
