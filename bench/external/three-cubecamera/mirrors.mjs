// Draws builtin:mirrors as a page that shows it to a person would, for timing: 1280x720 to the canvas, three.js's own perfect
// mirror material, a CubeCamera for each mirror. Sky, light and matte materials are those of page.mjs.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { makeAmbient, makeSky } from './environment.mjs';
import { isMirror, makeMatte } from './materials.mjs';

const kWidthPx = 1280, kHeightPx = 720;
const kNear = 0.1, kFar = 100;
const kSkyFacePx = 256;

let renderer, gl, scene, camera, mirrors;

function cubeTarget(resolution, type) {
  return new THREE.WebGLCubeRenderTarget(resolution, {
    type, generateMipmaps: false, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter,
  });
}

// Eight bits a channel, as pages have their skies; drawn once, shown as the scene's background.
async function bakeSky(parser, environment) {
  const target = cubeTarget(kSkyFacePx, THREE.UnsignedByteType);
  const sky = new THREE.Scene().add(await makeSky(parser, environment));
  new THREE.CubeCamera(kNear, kFar, target).update(renderer, sky);
  return target.texture;
}

// Tight bounds and short indices, as the loader leaves neither.
function tidy(geometry) {
  geometry.computeBoundingSphere();
  geometry.setIndex([...geometry.index.array]);
}

function makeMirror(mesh, resolution) {
  const target = cubeTarget(resolution, THREE.HalfFloatType);
  mesh.material = new THREE.MeshBasicMaterial({ envMap: target.texture, reflectivity: 1 });
  const cube = new THREE.CubeCamera(kNear, kFar, target);
  cube.position.copy(mesh.position);
  scene.add(cube);
  target.clear(renderer, true, true, false);
  return { mesh, cube };
}

async function load(resolution) {
  const canvas = document.body.appendChild(document.createElement('canvas'));
  renderer = new THREE.WebGLRenderer({ canvas, antialias: false, alpha: false, powerPreference: 'high-performance' });
  renderer.setPixelRatio(1);
  renderer.setSize(kWidthPx, kHeightPx);
  renderer.info.autoReset = false;
  gl = renderer.getContext();

  const { scene: root, parser, cameras } = await new GLTFLoader().loadAsync('/scene.glb');
  const { environment } = parser.json.scenes[0].extras.probebench;
  scene = new THREE.Scene().add(root, makeAmbient(environment.ambient));
  scene.background = await bakeSky(parser, environment);
  scene.updateMatrixWorld(true);
  mirrors = [];
  const meshes = [];
  root.traverse((object) => { if (object.isMesh) meshes.push(object); });
  for (const mesh of meshes) {
    tidy(mesh.geometry);
    const definition = parser.json.materials[parser.associations.get(mesh.material).materials];
    if (isMirror(definition)) mirrors.push(makeMirror(mesh, resolution));
    else mesh.material = makeMatte(mesh.material);
  }
  [camera] = cameras;
  Object.assign(camera, { aspect: kWidthPx / kHeightPx, near: kNear, far: kFar });
  camera.updateProjectionMatrix();
  scene.updateMatrixWorld(true);
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return { three: THREE.REVISION, renderer: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'an unnamed renderer' };
}

function drawFrame(bounces) {
  renderer.info.reset();
  for (let b = 0; b < bounces; b++)
    for (const { mesh, cube } of mirrors) {
      mesh.visible = false;
      cube.update(renderer, scene);
      mesh.visible = true;
    }
  renderer.render(scene, camera);
}

// All frames within one task, so that the browser shows none of them. A frame ends when a pixel can be read.
function measure(bounces, minFrames, minMs) {
  const pixel = new Uint8Array(4);
  const frameMs = [];
  const start = performance.now();
  while (frameMs.length < minFrames || performance.now() - start < minMs) {
    const begin = performance.now();
    drawFrame(bounces);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    frameMs.push(performance.now() - begin);
  }
  const error = gl.getError();
  if (error !== 0) throw new Error(`WebGL reports error ${error}`);
  const { calls, triangles } = renderer.info.render;
  return { frameMs, draws: calls, triangles };
}

window.technique = { load, measure };
