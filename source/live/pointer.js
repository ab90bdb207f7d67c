// SPDX-License-Identifier: GPL-3.0-or-later
// Actions of a mouse or a finger: grabs the body or a handle, brushes a pin, or turns the view.

const NAME = "pointer"; // of the one spring that a page pulls by

export class Pointer {
  // `wants`: obstacleAt(event): {name, shift, point} or null; tool(): "spring", "hard" or "pin"; strength(); mayAct(); grabRadius(); handleAt(corners); onPin(vertices); onBrush(vertices); onPull()
  constructor(view, connection, wants) {
    Object.assign(this, { view, connection }, wants);
    this.sequence = 0;
    this.held = null;
    this.over = null; // the last event of a mouse that hovers
    this.rest = 0; // no look at what is hovered over before this
    const { canvas } = view;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerleave", () => this.leave());
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
      canvas.addEventListener(end, (event) => this.up(event));
    view.onDraw = () => this.follow();
  }

  down(event) {
    this.view.canvas.focus({ preventScroll: true }); // from which OrbitControls keeps the browser
    if (this.held && event.pointerType === "touch")
      return this.letGo(); // both fingers are the view's from now on
    if (event.button !== 0 || this.held || event.ctrlKey || event.shiftKey || !this.mayAct() || (event.pointerType === "touch" && !event.isPrimary))
      return;
    const obstacle = this.obstacleAt(event);
    const hit = obstacle ? null : this.view.pick(event);
    if (!hit && !obstacle)
      return;
    this.view.controls.enabled = false; // which hears of it after this
    this.view.canvas.setPointerCapture(event.pointerId);
    if (obstacle) {
      this.held = { kind: "obstacle", obstacle, shift: obstacle.shift, id: event.pointerId, from: obstacle.point, target: obstacle.point, changed: false };
      return this.show("pull");
    }
    const corners = this.view.body.corners(hit.triangle);
    const handle = this.tool() === "pin" ? null : this.handleAt(corners);
    const kind = handle ? "handle" : this.tool();
    this.held = { kind, hit, handle, shift: handle ? handle.shift : null, id: event.pointerId, from: hit.point,
      target: hit.point, brush: new Set(corners), changed: false };
    this.show(kind === "pin" ? "brush" : "pull");
    if (kind === "spring" || kind === "hard")
      this.connection.send({ type: "grab", name: NAME, triangle: hit.triangle, on: kind === "hard", sequence: ++this.sequence,
        numbers: [...hit.shares, ...hit.point.toArray(), this.strength()] });
    else if (kind === "pin")
      this.onBrush([...this.held.brush]);
  }

  move(event) {
    if (!this.held) {
      this.over = event.pointerType === "touch" || event.buttons ? null : event;
      return;
    }
    if (event.pointerId !== this.held.id)
      return;
    if (this.held.kind === "pin") {
      const hit = this.view.pick(event);
      hit && this.view.body.corners(hit.triangle).forEach((vertex) => this.held.brush.add(vertex));
      return this.onBrush([...this.held.brush]);
    }
    const target = this.view.inPlane(event, this.held.from);
    if (target) {
      this.held.target = target;
      this.held.changed = true;
    }
  }

  leave() {
    this.over = null;
    if (!this.held)
      this.show("nothing");
  }

  // Called once a frame of the display.
  follow() {
    const { held, view } = this;
    view.marks.showSpring(null);
    if (!held)
      return this.hover();
    if (held.kind === "pin")
      return;
    if (held.kind === "obstacle") {
      if (held.changed)
        this.connection.send({ type: "carry", name: held.obstacle.name, numbers: this.shiftOf(held).toArray() });
      held.changed = false;
      return;
    }
    const point = view.body.pointOf(held.hit);
    view.marks.showSpring(point, held.target, view.eye.camera);
    view.showPatch(held.kind === "handle" ? null : point, this.radius());
    if (!held.changed)
      return;
    held.changed = false;
    if (held.kind === "handle")
      this.connection.send({ type: "handle", name: held.handle.name, numbers: this.shiftOf(held).toArray() });
    else
      this.connection.send({ type: "move", name: NAME, numbers: held.target.toArray(), sequence: ++this.sequence });
  }

  shiftOf({ target, from, shift }) {
    return target.clone().sub(from).add(shift);
  }

  // What would be taken hold of is shown before it is. A look costs as much as the body is large: it takes a fifth of the time at most.
  hover() {
    const { view, over } = this;
    const begin = performance.now();
    if (!view.body)
      return;
    if (!over || !this.mayAct()) {
      view.showPatch(null);
      return view.marks.stress(null);
    }
    if (begin < this.rest)
      return;
    const obstacle = this.obstacleAt(over);
    const hit = obstacle ? null : view.pick(over);
    const handle = hit && this.tool() !== "pin" ? this.handleAt(view.body.corners(hit.triangle)) : null;
    this.rest = performance.now() + 4 * (performance.now() - begin);
    view.showPatch(hit && !handle ? hit.point : null, this.radius());
    view.marks.stress(handle ? handle.name : null);
    this.show(handle || obstacle ? "handle" : hit ? (this.tool() === "pin" ? "brush" : "body") : "beside");
  }

  // A brush touches what is right below it.
  radius() {
    return this.tool() === "pin" ? 0.3 * this.grabRadius() : this.grabRadius();
  }

  // Sets the shape of the cursor.
  show(over) {
    this.view.canvas.dataset.over = over;
  }

  up(event) {
    if (!this.held || event.pointerId !== this.held.id)
      return;
    this.follow();
    this.letGo();
  }

  // What was held is held no more, as the server knows already.
  drop() {
    if (this.held && this.held.kind === "pin")
      this.onBrush([]);
    this.held = null;
    this.view.controls.enabled = true;
    this.show("nothing");
    this.view.showPatch(null);
  }

  letGo() {
    const { held } = this;
    this.drop();
    if (held.kind === "pin")
      this.onPin([...held.brush]);
    else if (held.kind === "obstacle")
      held.obstacle.of.shift = this.shiftOf(held).toArray(); // until the server says so
    else {
      if (held.kind === "handle")
        held.handle.shift = this.shiftOf(held); // until the server says so
      else
        this.connection.send({ type: "release", name: NAME });
      this.onPull();
    }
  }
}
