// SPDX-License-Identifier: GPL-3.0-or-later
// A ground with a soft shadow: the scene's floor, or, without one, for the eye alone.
import * as THREE from "./three/build/three.module.js";

const SIZE = 256; // of the shadow [pixels]

// Shader: nearness of a point to the ground, as opacity.
const CAST = {
  vertexShader: "uniform vec3 up; uniform float level; varying float height;" +
    "void main() { height = dot(position, up) - level; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
  fragmentShader: "uniform float reach; varying float height;" +
    "void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, exp(-max(height, 0.0) / reach)); }",
};
const WHOLE = "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";
const BLUR = "uniform sampler2D before; uniform vec2 pitch; varying vec2 at; void main() { float sum = 0.0; float all = 0.0;" +
  "for (int i = -8; i <= 8; ++i) { float share = exp(-float(i * i) / 24.0); all += share; sum += share * texture2D(before, at + float(i) * pitch).a; }" +
  "gl_FragColor = vec4(0.0, 0.0, 0.0, sum / all); }";
const FLAT = "varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
// Shader: noise of one grey level, which prevents banding.
const DISC = "uniform vec3 colour; uniform float opacity; varying vec2 at; void main() {" +
  "float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;" +
  "gl_FragColor = vec4(colour, opacity * (1.0 - smoothstep(0.1, 0.5, distance(at, vec2(0.5)))) + noise / 255.0); }";
const SHADE = "uniform sampler2D shadow; uniform float opacity; varying vec2 at; void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, opacity * texture2D(shadow, at).a); }";

const material = (vertexShader, fragmentShader, uniforms, more = {}) => new THREE.ShaderMaterial({ vertexShader, fragmentShader,
  uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])), ...more });

export class Ground {
  constructor(renderer) {
    this.renderer = renderer;
    this.targets = [0, 1].map(() => new THREE.WebGLRenderTarget(SIZE, SIZE));
    this.cast = material(CAST.vertexShader, CAST.fragmentShader, { up: new THREE.Vector3(0, 0, 1), level: 0, reach: 1 },
      { side: THREE.DoubleSide, blending: THREE.NoBlending });
    this.blur = material(WHOLE, BLUR, { before: null, pitch: new THREE.Vector2() }, { depthTest: false, blending: THREE.NoBlending });
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.casting = new THREE.Scene();
    this.blurring = new THREE.Scene();
    const sheet = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), this.blur);
    sheet.frustumCulled = false;
    this.blurring.add(sheet);
    const plane = new THREE.PlaneBufferGeometry(1, 1);
    const lies = { transparent: true, depthWrite: false };
    this.disc = new THREE.Mesh(plane, material(FLAT, DISC, { colour: new THREE.Color(), opacity: 0 }, lies));
    this.shade = new THREE.Mesh(plane, material(FLAT, SHADE, { shadow: this.targets[0].texture, opacity: 0 }, lies));
    this.disc.renderOrder = 1;
    this.shade.renderOrder = 2;
    this.group = new THREE.Group();
    this.group.add(this.disc, this.shade);
    this.group.visible = false;
  }

  setColours({ ground, opacity, shadow }) {
    this.disc.material.uniforms.colour.value.set(ground);
    this.disc.material.uniforms.opacity.value = opacity;
    this.shade.material.uniforms.opacity.value = shadow;
  }

  // Places the ground at the level of a floor, or below the lowest point of a body at rest.
  place(geometry, up, floor) {
    this.geometry = geometry;
    const { center, radius } = geometry.boundingSphere;
    const { array } = geometry.attributes.position;
    let level = Infinity;
    for (let i = 0; i < array.length; i += 3)
      level = Math.min(level, array[i] * up.x + array[i + 1] * up.y + array[i + 2] * up.z);
    level = Number.isFinite(floor) ? floor : level - 0.003 * radius; // or soles would flicker
    const { uniforms } = this.cast;
    uniforms.up.value.copy(up);
    uniforms.level.value = level;
    uniforms.reach.value = 0.3 * radius;
    this.radius = radius;
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
    for (const mesh of [this.disc, this.shade])
      mesh.quaternion.copy(turn);
    this.disc.scale.setScalar(8 * radius);
    this.disc.position.copy(this.below(center));
    this.casting.remove(this.caster);
    this.caster = new THREE.Mesh(geometry, this.cast);
    this.caster.frustumCulled = false;
    this.casting.add(this.caster);
    this.group.visible = true;
    this.isOld = true;
  }

  below(point) {
    const { up, level } = this.cast.uniforms;
    return point.clone().addScaledVector(up.value, level.value - point.dot(up.value));
  }

  // The shadow is rendered from far below, so that the nearest parts to the ground count; it goes along with the body.
  castShadow() {
    if (!this.isOld || !this.geometry)
      return;
    this.isOld = false;
    this.geometry.computeBoundingSphere();
    const { center, radius } = this.geometry.boundingSphere;
    const half = 1.3 * radius;
    const { up } = this.cast.uniforms;
    this.shade.position.copy(this.below(center)).addScaledVector(up.value, 0.001 * this.radius);
    this.shade.scale.setScalar(2 * half);
    Object.assign(this.camera, { left: -half, right: half, top: half, bottom: -half, near: 0, far: 4 * radius });
    this.camera.quaternion.copy(this.shade.quaternion).multiply(new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 1, 0), Math.PI));
    this.camera.position.copy(center).addScaledVector(up.value, -2 * radius);
    this.camera.updateProjectionMatrix();
    this.render(this.casting, this.targets[0]);
    for (const axis of [0, 1]) {
      this.blur.uniforms.before.value = this.targets[axis].texture;
      this.blur.uniforms.pitch.value.set(axis === 0 ? 1 / SIZE : 0, axis === 1 ? 1 / SIZE : 0);
      this.render(this.blurring, this.targets[1 - axis]);
    }
  }

  render(scene, target) {
    this.renderer.setRenderTarget(target);
    this.renderer.clear();
    this.renderer.render(scene, this.camera);
    this.renderer.setRenderTarget(null);
  }
}
