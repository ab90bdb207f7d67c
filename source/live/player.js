// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the frames of a page that exemplar export has written. Three.js is there already.
"use strict";
(() => {
  const find = (id) => document.getElementById(id);
  const bytes = (id) => Uint8Array.from(atob(find(id).textContent), (letter) => letter.charCodeAt(0)).buffer;
  const { runs } = JSON.parse(find("data").textContent);
  const COLOURS = ["#1f6feb", "#e5484d", "#2f9e44", "#b45309", "#8250df", "#0e8a93"];
  const BODIES = ["#e08a3c", "#4b8fd8"];
  const HEAD = 64;

  const canvas = find("canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);

  // A body in motion, in a scene of its own.
  class Body {
    constructor(run, i) {
      Object.assign(this, run);
      this.all = bytes(`frames-${i}`);
      this.view = new DataView(this.all);
      this.n = this.view.getUint32(48, true);
      this.stride = HEAD + 6 * this.n;
      this.shown = -1;
      this.scene = new THREE.Scene();
      this.light = new THREE.DirectionalLight("#ffffff", 0.75);
      this.scene.add(new THREE.HemisphereLight("#ffffff", "#8890a0", 0.65), this.light, this.light.target);
      this.geometry = new THREE.BufferGeometry();
      this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(`topology-${i}`), 12), 1));
      this.positions = new THREE.BufferAttribute(new Float32Array(3 * this.n), 3);
      this.geometry.setAttribute("position", this.positions);
      this.geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(3 * this.n), 3));
      const mesh = new THREE.Mesh(this.geometry,
        new THREE.MeshPhongMaterial({ color: BODIES[i % BODIES.length], side: THREE.DoubleSide, shininess: 15, specular: "#222222" }));
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }

    timeOf(frame) {
      return this.view.getFloat64(frame * this.stride + 16, true);
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
      this.shown = frame;
      const begin = frame * this.stride;
      const shorts = new DataView(this.all, begin + HEAD);
      for (let i = 0; i < 3 * this.n; ++i) {
        const c = i % 3;
        this.positions.array[i] = this.view.getFloat32(begin + 24 + 4 * c, true) +
          ((shorts.getInt16(2 * i, true) / 32767 + 1) / 2) * this.view.getFloat32(begin + 36 + 4 * c, true);
      }
      this.positions.needsUpdate = true;
      this.geometry.computeVertexNormals();
    }
  }

  const bodies = runs.map((run, i) => new Body(run, i));
  const longest = bodies.reduce((a, b) => (b.timeOf(b.frames - 1) > a.timeOf(a.frames - 1) ? b : a));
  const end = longest.timeOf(longest.frames - 1);

  function show(time) {
    bodies.forEach((body) => body.show(body.frameAt(time)));
    find("scrub").value = longest.shown;
    find("time").value = `t = ${longest.timeOf(longest.shown).toFixed(2)} s`;
    drawPlots(longest.timeOf(longest.shown));
  }

  function resize() {
    const { clientWidth, clientHeight } = canvas.parentElement;
    renderer.setSize(clientWidth, clientHeight, false);
    camera.aspect = clientWidth / bodies.length / Math.max(1, clientHeight); // side by side
    camera.updateProjectionMatrix();
  }

  // Of plots: one of the weights, one of the energies; the second run is dashed.
  const plots = [["weight_", "Weights of the examples"], ["energy_", "Energies [J]"]].map(([prefix, title]) => ({
    title, lines: runs.flatMap((run, k) => Object.keys(run.plots).filter((name) => name.startsWith(prefix)).map((name) => (
      { name: name.slice(7).replace(/_/g, " "), dash: k ? [8, 6] : [], times: run.plots.time, values: run.plots[name] }))) }))
    .filter(({ lines }) => lines.length);
  const colourOf = ({ name }, lines) => COLOURS[[...new Set(lines.map((line) => line.name))].indexOf(name) % COLOURS.length];
  for (const plot of plots) {
    const box = document.createElement("fieldset");
    const title = Object.assign(document.createElement("legend"), { textContent: plot.title });
    plot.canvas = Object.assign(document.createElement("canvas"), { className: "plot", width: 480, height: 300 });
    const key = Object.assign(document.createElement("div"), { className: "key" });
    plot.lines.forEach((line) => {
      const entry = Object.assign(document.createElement("span"), { textContent: `${line.dash.length ? "╌" : "—"} ${line.name}` });
      entry.style.color = colourOf(line, plot.lines);
      key.append(entry);
    });
    box.append(title, plot.canvas, key);
    find("plots").append(box);
  }

  function drawPlots(time) {
    for (const { lines, canvas: target } of plots) {
      const pen = target.getContext("2d");
      const values = lines.flatMap((line) => line.values);
      const [low, high] = values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [0, -Infinity]);
      const x = (t) => (t / Math.max(1e-9, end)) * (target.width - 4) + 2;
      const y = (v) => target.height - 4 - ((v - low) / Math.max(1e-30, high - low)) * (target.height - 8);
      pen.clearRect(0, 0, target.width, target.height);
      lines.forEach((line) => {
        pen.strokeStyle = colourOf(line, lines);
        pen.lineWidth = 2;
        pen.setLineDash(line.dash);
        pen.beginPath();
        line.values.forEach((v, k) => pen.lineTo(x(line.times[k]), y(v)));
        pen.stroke();
      });
      pen.fillStyle = "#8888";
      pen.fillRect(x(time), 0, 2, target.height);
    }
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
  find("name").textContent = runs.map(({ name }) => name).join(" | ");
  document.title = `${find("name").textContent} – exemplar`;
  find("error").textContent = runs.map(({ name, frames, error }) =>
    `${name}: ${frames} frames; coordinates are rounded by ${error.toExponential(1)} m at most.`).join(" ");

  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  show(0);
  longest.geometry.computeBoundingSphere();
  const { center, radius } = longest.geometry.boundingSphere;
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
