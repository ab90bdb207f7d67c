// SPDX-License-Identifier: GPL-3.0-or-later
// What a mouse or a finger does: grabs the body or a handle, brushes a pin, or turns the view.

const NAME = "pointer"; // of the one spring that a page pulls by

export class Pointer {
  // tool(): "spring", "hard" or "pin"; strength(); handleAt(vertex); onPin(vertices)
  constructor(view, connection, { tool, strength, handleAt, onPin }) {
    Object.assign(this, { view, connection, tool, strength, handleAt, onPin });
    this.sequence = 0;
    this.held = null;
    const { canvas } = view;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
      canvas.addEventListener(end, (event) => this.up(event));
    view.onDraw = () => this.follow();
  }

  down(event) {
    if (event.button !== 0 || this.held || event.ctrlKey || event.shiftKey)
      return;
    const hit = this.view.pick(event);
    if (!hit)
      return;
    this.view.controls.enabled = false; // which hears of it after this
    this.view.canvas.setPointerCapture(event.pointerId);
    const corners = this.view.corners(hit.triangle);
    const handle = this.tool() === "pin" ? null : this.handleAt(corners);
    const kind = handle ? "handle" : this.tool();
    this.held = { kind, hit, handle, id: event.pointerId, from: hit.point, target: hit.point, brush: new Set(corners), changed: false };
    if (kind === "spring" || kind === "hard")
      this.connection.send({ type: "grab", name: NAME, triangle: hit.triangle, on: kind === "hard", sequence: ++this.sequence,
        numbers: [...hit.shares, ...hit.point.toArray(), this.strength()] });
  }

  move(event) {
    if (!this.held || event.pointerId !== this.held.id)
      return;
    if (this.held.kind === "pin") {
      const hit = this.view.pick(event);
      hit && this.view.corners(hit.triangle).forEach((vertex) => this.held.brush.add(vertex));
      return;
    }
    const target = this.view.inPlane(event, this.held.from);
    if (target) {
      this.held.target = target;
      this.held.changed = true;
    }
  }

  // Once a frame of the display.
  follow() {
    const held = this.held;
    if (!held || held.kind === "pin")
      return this.view.showSpring(null);
    this.view.showSpring(this.view.pointOf(held.hit), held.target);
    if (!held.changed)
      return;
    held.changed = false;
    if (held.kind === "handle")
      this.connection.send({ type: "handle", name: held.handle.name,
        numbers: held.target.clone().sub(held.from).add(held.handle.shift).toArray() });
    else
      this.connection.send({ type: "move", name: NAME, numbers: held.target.toArray(), sequence: ++this.sequence });
  }

  up(event) {
    const held = this.held;
    if (!held || event.pointerId !== held.id)
      return;
    this.follow();
    this.held = null;
    this.view.controls.enabled = true;
    if (held.kind === "pin")
      this.onPin([...held.brush]);
    else if (held.kind === "handle")
      held.handle.shift.add(held.target).sub(held.from);
    else
      this.connection.send({ type: "release", name: NAME });
  }
}
