// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the frames of a page that exemplar export has written. Three.js is there already.
"use strict";
(() => {
  const find = (id) => document.getElementById(id);
  const bytes = (id) => Uint8Array.from(atob(find(id).textContent), (letter) => letter.charCodeAt(0)).buffer;
  const data = JSON.parse(find("data").textContent);
  const COLOURS = ["#1f6feb", "#e5484d", "#2f9e44", "#b45309", "#8250df", "#0e8a93"];
  const HEAD = 64;

  const topology = bytes("topology");
  const triangles = new Uint32Array(topology, 12);
  const all = bytes("frames");
  const view = new DataView(all);
  const n = view.getUint32(48, true);
  const stride = HEAD + 6 * n;
  const timeOf = (frame) => view.getFloat64(frame * stride + 16, true);

  const canvas = find("canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  camera.up.set(0, 0, 1);
  const light = new THREE.DirectionalLight("#ffffff", 0.75);
  scene.add(new THREE.HemisphereLight("#ffffff", "#8890a0", 0.65), light, light.target);
  const controls = new THREE.OrbitControls(camera, canvas);
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  const positions = new THREE.BufferAttribute(new Float32Array(3 * n), 3);
  geometry.setAttribute("position", positions);
  geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(3 * n), 3));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({ color: "#e08a3c", side: THREE.DoubleSide, shininess: 15, specular: "#222222" }));
  mesh.frustumCulled = false;
  scene.add(mesh);

  function show(frame) {
    const begin = frame * stride;
    const shorts = new DataView(all, begin + HEAD);
    for (let i = 0; i < 3 * n; ++i) {
      const c = i % 3;
      positions.array[i] = view.getFloat32(begin + 24 + 4 * c, true) +
        ((shorts.getInt16(2 * i, true) / 32767 + 1) / 2) * view.getFloat32(begin + 36 + 4 * c, true);
    }
    positions.needsUpdate = true;
    geometry.computeVertexNormals();
    find("scrub").value = frame;
    find("time").value = `t = ${timeOf(frame).toFixed(2)} s`;
    drawPlots(frame);
  }

  function resize() {
    const { clientWidth, clientHeight } = canvas.parentElement;
    renderer.setSize(clientWidth, clientHeight, false);
    camera.aspect = clientWidth / Math.max(1, clientHeight);
    camera.updateProjectionMatrix();
  }

  // Of plots: one of the weights, one of the energies.
  const plots = ["weight_", "energy_"].map((prefix) => ({
    title: prefix === "weight_" ? "Weights of the examples" : "Energies [J]",
    names: Object.keys(data.plots).filter((name) => name.startsWith(prefix)) })).filter(({ names }) => names.length);
  for (const plot of plots) {
    const box = document.createElement("fieldset");
    const title = Object.assign(document.createElement("legend"), { textContent: plot.title });
    plot.canvas = Object.assign(document.createElement("canvas"), { className: "plot", width: 480, height: 300 });
    const key = Object.assign(document.createElement("div"), { className: "key" });
    plot.names.forEach((name, i) => {
      const entry = Object.assign(document.createElement("span"), { textContent: `— ${name.slice(7).replace(/_/g, " ")}` });
      entry.style.color = COLOURS[i % COLOURS.length];
      key.append(entry);
    });
    box.append(title, plot.canvas, key);
    find("plots").append(box);
  }

  function drawPlots(frame) {
    for (const { names, canvas: target } of plots) {
      const pen = target.getContext("2d");
      const values = names.flatMap((name) => data.plots[name]);
      const [low, high] = [Math.min(0, ...values), Math.max(...values)];
      const times = data.plots.time;
      const x = (t) => (t / Math.max(1e-9, times[times.length - 1])) * (target.width - 4) + 2;
      const y = (v) => target.height - 4 - ((v - low) / Math.max(1e-30, high - low)) * (target.height - 8);
      pen.clearRect(0, 0, target.width, target.height);
      names.forEach((name, i) => {
        pen.strokeStyle = COLOURS[i % COLOURS.length];
        pen.lineWidth = 2;
        pen.beginPath();
        data.plots[name].forEach((v, k) => pen.lineTo(x(times[k]), y(v)));
        pen.stroke();
      });
      pen.fillStyle = "#8888";
      pen.fillRect(x(timeOf(frame)), 0, 2, target.height);
    }
  }

  let playing = true;
  let clock = 0;
  let last = performance.now();
  const setPlaying = (on) => {
    playing = on;
    find("play").textContent = on ? "Pause" : "Play";
  };
  find("scrub").max = data.frames - 1;
  find("scrub").oninput = ({ target }) => {
    setPlaying(false);
    clock = timeOf(Number(target.value));
    show(Number(target.value));
  };
  find("play").onclick = () => setPlaying(!playing);
  addEventListener("keydown", (event) => {
    if (event.key === " " && !event.target.matches("button, input")) {
      event.preventDefault();
      setPlaying(!playing);
    }
  });
  find("name").textContent = data.name;
  document.title = `${data.name} – exemplar`;
  find("error").textContent = `${data.frames} frames; coordinates are rounded by ${data.error.toExponential(1)} m at most.`;

  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  show(0);
  geometry.computeBoundingSphere();
  const { center, radius } = geometry.boundingSphere;
  controls.target.copy(center);
  camera.position.copy(center).add(new THREE.Vector3(0.35, -1, 0.3).normalize().multiplyScalar((1.35 * radius) / Math.sin(Math.PI / 9) / Math.min(1, camera.aspect)));
  camera.near = 0.01 * radius;
  camera.far = 100 * radius;
  camera.updateProjectionMatrix();
  controls.update();

  let shown = 0;
  (function draw(now = performance.now()) {
    requestAnimationFrame(draw);
    if (playing) {
      clock += Math.min(0.1, (now - last) / 1000);
      if (clock > timeOf(data.frames - 1) + 0.5)
        clock = 0;
      let frame = clock < timeOf(shown) ? 0 : shown;
      while (frame + 1 < data.frames && timeOf(frame + 1) <= clock)
        ++frame;
      if (frame !== shown)
        show((shown = frame));
    } else
      shown = Number(find("scrub").value);
    last = now;
    light.position.copy(camera.position);
    light.target.position.copy(controls.target);
    renderer.render(scene, camera);
  })();
})();
