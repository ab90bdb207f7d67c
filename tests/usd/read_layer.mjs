// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a USD file by tinyusdz (npm), as a layer and as a scene:
// node read_layer.mjs DIRECTORY_OF_TINYUSDZ FILE.usda LAYER.txt SCENE.json
import fs from 'fs';

const [directory, file, layerFile, sceneFile] = process.argv.slice(2);
const wasmBinary = fs.readFileSync(`${directory}/tinyusdz.wasm`);
const bytes = new Uint8Array(fs.readFileSync(file));

// the package is built for browsers alone, and looks where it is
globalThis.window = globalThis;
globalThis.location = { href: 'file:///' };
globalThis.document = { currentScript: null };
const end = process.exit.bind(process);
Object.defineProperty(globalThis, 'process', { value: undefined });

const { default: start } = await import(`${directory}/tinyusdz.js`);
const tinyusdz = await start({ wasmBinary });
const layer = new tinyusdz.TinyUSDZLoaderNative();
const scene = new tinyusdz.TinyUSDZLoaderNative();
if (!layer.loadAsLayerFromBinary(bytes, 'layer.usda') || !scene.loadFromBinary(bytes, 'scene.usda')) {
  console.error(layer.error(), scene.error());
  end(1);
}
fs.writeFileSync(layerFile, layer.layerToString());
const mesh = scene.getMesh(0);
fs.writeFileSync(sceneFile, JSON.stringify({ meshes: scene.numMeshes(), path: mesh.absPath, points: Array.from(mesh.points) }));
