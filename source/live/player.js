// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the frames of a page that exemplar export has written. Three.js is there already.
"use strict";
(() => {
  const find = (id) => document.getElementById(id);
  const bytes = (id) => Uint8Array.from(atob(find(id).textContent), (letter) => letter.charCodeAt(0)).buffer;
  const { runs } = JSON.parse(find("data").textContent);
  const COLOURS = ["#1f6feb", "#e5484d", "#2f9e44", "#b45309", "#8250df", "#0e8a93"];
  const BODIES = ["#e08a3c", "#4b8fd8"];
  const HELD = "#1d4ed8", MOVED = "#dc2626", OBSTACLE = "#aab2bd";
  const short = (x) => (!Number.isFinite(x) ? "–" : x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-2 ? x.toExponential(1) : String(Number(x.toPrecision(3))));
  const HEAD = 64;

  const canvas = find("canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);

  // A ring with a pale border, which is seen on any colour.
  const ring = new THREE.CanvasTexture(Object.assign(document.createElement("canvas"), { width: 32, height: 32 }));
  {
    const pen = ring.image.getContext("2d");
    for (const [colour, width] of [["#ffffff", 12], ["#888888", 6]]) {
      pen.strokeStyle = colour === "#888888" ? "#ffffff" : "#00000088";
      pen.lineWidth = width;
      pen.beginPath();
      pen.arc(16, 16, 9, 0, 7);
      pen.stroke();
    }
  }

  // A surface in motion: the places of its vertices by frame; of what stands still there is one.
  class Moving {
    constructor(frames, topology, look) {
      this.all = bytes(frames);
      this.view = new DataView(this.all);
      this.n = this.view.getUint32(48, true);
      this.stride = HEAD + 6 * this.n;
      this.last = this.all.byteLength / this.stride - 1;
      this.shown = -1;
      this.geometry = new THREE.BufferGeometry();
      this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(topology), 12), 1));
      this.positions = new THREE.BufferAttribute(new Float32Array(3 * this.n), 3);
      this.geometry.setAttribute("position", this.positions);
      this.geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(3 * this.n), 3));
      this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshPhongMaterial(look));
      this.mesh.frustumCulled = false;
    }

    coordinate(frame, i) {
      const begin = frame * this.stride;
      return this.view.getFloat32(begin + 24 + 4 * (i % 3), true) +
        ((this.view.getInt16(begin + HEAD + 2 * i, true) / 32767 + 1) / 2) * this.view.getFloat32(begin + 36 + 4 * (i % 3), true);
    }

    timeOf(frame) {
      return this.view.getFloat64(frame * this.stride + 16, true);
    }

    show(frame) {
      this.shown = frame;
      for (let i = 0; i < 3 * this.n; ++i)
        this.positions.array[i] = this.coordinate(Math.min(frame, this.last), i);
      this.positions.needsUpdate = true;
      this.geometry.computeVertexNormals();
    }
  }

  // A body in motion, in a scene of its own, and the obstacles beside it, which are seen from the side on which it is.
  class Body extends Moving {
    constructor(run, i) {
      super(`frames-${i}`, `topology-${i}`, { color: BODIES[i % BODIES.length], side: THREE.DoubleSide, shininess: 15, specular: "#222222" });
      Object.assign(this, run);
      this.scene = new THREE.Scene();
      this.light = new THREE.DirectionalLight("#ffffff", 0.75);
      this.scene.add(new THREE.HemisphereLight("#ffffff", "#8890a0", 0.65), this.light, this.light.target);
      this.scene.add(this.mesh);
      this.obstacles = find(`obstacles-${i}`)
        ? new Moving(`obstacles-${i}`, `topology-of-obstacles-${i}`, { color: OBSTACLE, flatShading: true, shininess: 5, specular: "#111111" }) : null;
      if (this.obstacles)
        this.scene.add(this.obstacles.mesh);
      this.marks = this.handles.filter(({ vertices }) => vertices.length).map(({ vertices }) => this.mark(vertices));
    }

    // Rings on vertices that are held, in another colour if they are moved in the course of the run.
    mark(vertices) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices.length), 3));
      const far = [0, 1, 2].some((c) => Math.abs(this.coordinate(this.frames - 1, 3 * vertices[0] + c) - this.coordinate(0, 3 * vertices[0] + c)) >
        0.002 * Math.max(...[0, 1, 2].map((d) => this.view.getFloat32(36 + 4 * d, true))));
      const points = new THREE.Points(geometry, new THREE.PointsMaterial(
        { color: far ? MOVED : HELD, size: 9, sizeAttenuation: false, map: ring, transparent: true, alphaTest: 0.3 }));
      points.frustumCulled = false;
      this.scene.add(points);
      return { vertices, geometry, isMoved: far };
    }

    // The last frame that is not after this time.
    frameAt(time) {
      let frame = 0;
      while (frame + 1 < this.frames && this.timeOf(frame + 1) <= time + 1e-9)
        ++frame;
      return frame;
    }

    show(frame) {
      if (frame === this.shown)
        return;
      super.show(frame);
      this.obstacles && this.obstacles.show(frame);
      for (const { vertices, geometry } of this.marks) {
        vertices.forEach((v, k) => geometry.attributes.position.array.set(this.positions.array.subarray(3 * v, 3 * v + 3), 3 * k));
        geometry.attributes.position.needsUpdate = true;
      }
    }
  }

  const bodies = runs.map((run, i) => new Body(run, i));
  const longest = bodies.reduce((a, b) => (b.timeOf(b.frames - 1) > a.timeOf(a.frames - 1) ? b : a));
  const end = longest.timeOf(longest.frames - 1);
  // Where nothing has a kinetic energy, t counts parts of a load and no seconds.
  const unit = runs.some(({ plots }) => "energy_kinetic" in plots) ? " s" : "";

  function show(time) {
    bodies.forEach((body) => body.show(body.frameAt(time)));
    find("scrub").value = longest.shown;
    find("time").value = `t = ${longest.timeOf(longest.shown).toFixed(2)}${unit}`;
    drawPlots(longest.timeOf(longest.shown));
  }

  function resize() {
    const { clientWidth, clientHeight } = canvas.parentElement;
    renderer.setSize(clientWidth, clientHeight, false);
    camera.aspect = clientWidth / bodies.length / Math.max(1, clientHeight); // side by side
    camera.updateProjectionMatrix();
  }

  // "weight_1" is of example 1, "weight_7_1" of example 1 in region 7.
  function nameOf(column, run) {
    const [kind, ...numbers] = column.split("_");
    if (kind !== "weight")
      return numbers.join(" ");
    const example = run.examples[Number(numbers[numbers.length - 1])] || `example ${numbers[numbers.length - 1]}`;
    return numbers.length > 1 ? `${example}, region ${numbers[0]}` : example;
  }

  // The plots: one of the weights, one of the energies; the second run is dashed.
  const plots = [["weight_", "Weights of the examples"], ["energy_", "Energies [J]"]].map(([prefix, title]) => ({
    title, lines: runs.flatMap((run, k) => Object.keys(run.plots).filter((column) => column.startsWith(prefix)).map((column) => (
      { name: nameOf(column, run), run: run.name, dash: k ? [8, 6] : [], times: run.plots.time, values: run.plots[column].map((v) => (v === null ? NaN : v)) }))) }))
    .filter(({ lines }) => lines.length);
  const colourOf = ({ name }, lines) => COLOURS[[...new Set(lines.map((line) => line.name))].indexOf(name) % COLOURS.length];
  for (const plot of plots) {
    const box = document.createElement("fieldset");
    const title = Object.assign(document.createElement("legend"), { textContent: plot.title });
    plot.canvas = Object.assign(document.createElement("canvas"), { className: "plot", width: 480, height: 300 });
    plot.canvas.setAttribute("role", "img");
    plot.canvas.setAttribute("aria-label", `${plot.title} over time`);
    const key = Object.assign(document.createElement("div"), { className: "key" });
    plot.lines.forEach((line) => {
      const entry = document.createElement("span");
      entry.style.color = colourOf(line, plot.lines);
      line.output = document.createElement("output");
      entry.append(`${line.dash.length ? "╌" : "—"} ${line.name} `, line.output);
      key.append(entry);
    });
    box.append(title, plot.canvas, key);
    find("plots").append(box);
  }

  // The value of a line in the last row that is not after this time.
  const valueAt = ({ times, values }, time) => {
    const after = times.findIndex((t) => t > time + 1e-9);
    return values[after < 0 ? values.length - 1 : Math.max(0, after - 1)];
  };

  // The lines of a plot within its axes: zero and the greatest and least values across, seconds along.
  function drawPlot({ lines, canvas: target }, time) {
    const pen = target.getContext("2d");
    const values = lines.flatMap((line) => line.values).filter(Number.isFinite);
    const [low, high] = values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [0, 1e-30]);
    const [left, bottom, top] = [70, target.height - 34, 12];
    const x = (t) => left + (t / Math.max(1e-9, end)) * (target.width - left - 8);
    const y = (v) => bottom - ((v - low) / (high - low)) * (bottom - top);
    const text = getComputedStyle(target);
    pen.clearRect(0, 0, target.width, target.height);
    pen.font = "20px system-ui, sans-serif";
    pen.fillStyle = text.color;
    pen.strokeStyle = text.color;
    pen.setLineDash([]);
    pen.lineWidth = 1;
    pen.textAlign = "right";
    for (const v of new Set([low, 0, high])) {
      pen.fillText(short(v), left - 6, y(v) + 7);
      pen.globalAlpha = v === 0 ? 0.7 : 0.2;
      pen.beginPath();
      pen.moveTo(left, y(v));
      pen.lineTo(target.width - 8, y(v));
      pen.stroke();
      pen.globalAlpha = 1;
    }
    pen.fillText(`${short(end)}${unit}`, target.width - 8, target.height - 8);
    pen.textAlign = "left";
    pen.fillText("0", left, target.height - 8);
    pen.lineWidth = 3;
    lines.forEach((line) => {
      pen.strokeStyle = colourOf(line, lines);
      pen.setLineDash(line.dash);
      pen.beginPath();
      line.values.forEach((v, k) => Number.isFinite(v) && pen.lineTo(x(line.times[k]), y(v)));
      pen.stroke();
      line.output.value = short(valueAt(line, time));
    });
    pen.fillStyle = "#8888";
    pen.fillRect(x(time), top, 2, bottom - top);
  }

  function drawPlots(time) {
    plots.forEach((plot) => drawPlot(plot, time));
  }

  let playing = true;
  let clock = 0;
  let last = performance.now();
  const setPlaying = (on) => {
    playing = on;
    find("play").textContent = on ? "Pause" : "Play";
  };
  find("scrub").max = longest.frames - 1;
  find("scrub").oninput = ({ target }) => {
    setPlaying(false);
    clock = longest.timeOf(Number(target.value));
    show(clock);
  };
  find("play").onclick = () => setPlaying(!playing);
  addEventListener("keydown", (event) => {
    if (event.key === " " && !event.target.matches("button, input")) {
      event.preventDefault();
      setPlaying(!playing);
    }
  });
  runs.forEach((run) => (run.name = run.name.replace(/_/g, " ")));
  find("name").textContent = runs.map(({ name }) => name).join(" | ");
  runs.forEach(({ name }, i) => {
    const caption = Object.assign(document.createElement("span"), { textContent: name });
    caption.style.left = `${(100 * (i + 0.5)) / runs.length}%`;
    caption.style.borderColor = BODIES[i % BODIES.length];
    find("captions").append(caption);
  });
  const marks = bodies.flatMap((body) => body.marks);
  for (const [is, id] of [[false, "held"], [true, "moved"]])
    find(id).hidden = !marks.some(({ isMoved }) => isMoved === is);
  document.title = `${find("name").textContent} – exemplar`;
  find("error").textContent = runs.map(({ name, frames, error }) =>
    `${name}: ${frames} frames; coordinates are rounded by ${error.toExponential(1)} m at most.`).join(" ");

  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  show(0);
  longest.geometry.computeBoundingSphere();
  const sphere = longest.geometry.boundingSphere;
  if (longest.obstacles) { // what falls or slides may go far: all of its way is to be seen
    const way = new THREE.Box3();
    for (let frame = longest.frames - 1; frame >= 0; --frame) {
      longest.show(frame);
      way.union(new THREE.Box3().setFromBufferAttribute(longest.positions));
    }
    way.getBoundingSphere(sphere);
  }
  const { center, radius } = sphere;
  controls.target.copy(center);
  camera.position.copy(center).add(new THREE.Vector3(0.35, -1, 0.3).normalize().multiplyScalar((1.35 * radius) / Math.sin(Math.PI / 9) / Math.min(1, camera.aspect)));
  camera.near = 0.01 * radius;
  camera.far = 100 * radius;
  camera.updateProjectionMatrix();
  controls.update();
  renderer.setScissorTest(true);

  function draw(now = performance.now()) {
    requestAnimationFrame(draw);
    if (playing) {
      clock += Math.min(0.1, (now - last) / 1000);
      if (clock > end + 0.5)
        clock = 0;
      if (bodies.some((body) => body.frameAt(clock) !== body.shown))
        show(clock);
    }
    last = now;
    const { clientWidth, clientHeight } = canvas.parentElement;
    const width = clientWidth / bodies.length;
    bodies.forEach(({ scene, light }, i) => {
      light.position.copy(camera.position);
      light.target.position.copy(controls.target);
      renderer.setViewport(i * width, 0, width, clientHeight);
      renderer.setScissor(i * width, 0, width, clientHeight);
      renderer.render(scene, camera);
    });
  }
  draw();
})();
