// Draws a scene of probebench with three.js: a CubeCamera for each probe, all of them anew in every frame, B times in turn.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { makeAmbient, makeSky } from './environment.mjs';
import { replaceMaterial, setReflection } from './materials.mjs';

const kFarPerNear = 1e5; // of cube cameras: 24 bits of depth still part surfaces 0.1 mm from each other at ten metres

// ---- The scene

let job, renderer, scene, skyScene, environments, camera, mixer, mirrors, skyTarget, skyCube, meshes, bounces, feedback;

function cubeTarget(resolution) {
  return new THREE.WebGLCubeRenderTarget(resolution, {
    type: THREE.HalfFloatType, generateMipmaps: false, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter,
  });
}

// Meshes by "node primitive", as the job names them.
function meshesByPlace(gltf) {
  const places = new Map();
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    const own = gltf.parser.associations.get(object) ?? {};
    const node = own.nodes ?? gltf.parser.associations.get(object.parent)?.nodes;
    places.set(`${node} ${own.primitives ?? 0}`, object);
  });
  return places;
}

function makeMirror(probe, places, resolution, far) {
  const target = cubeTarget(resolution);
  const cube = new THREE.CubeCamera(probe.z_near, Math.max(kFarPerNear * probe.z_near, far), target);
  const owners = probe.owners.map(({ node, primitive }) => {
    const mesh = places.get(`${node} ${primitive}`);
    if (!mesh) throw new Error(`the scene has no mesh of node ${node}, primitive ${primitive}`);
    setReflection(mesh, target.texture);
    return mesh;
  });
  return { target, cube, owners };
}

function captureSky(mirror) {
  mirror.cube.update(renderer, skyScene);
}

// The environment from that time on, as long as no other follows.
async function addEnvironment(parser, fromSeconds, environment) {
  const objects = [await makeSky(parser, environment)];
  if (environment.ambient) objects.push(makeAmbient(environment.ambient));
  scene.add(...objects);
  const alone = await makeSky(parser, environment);
  skyScene.add(alone);
  objects.push(alone);
  setVisible(objects, false);
  environments.push({ fromSeconds, objects, isShown: false });
}

function showEnvironment(timeS) {
  const current = environments.findLast(({ fromSeconds }) => fromSeconds <= timeS);
  if (current.isShown) return;
  for (const environment of environments) {
    environment.isShown = environment === current;
    setVisible(environment.objects, environment.isShown);
  }
  skyCube.update(renderer, skyScene);
}

async function load(theJob) {
  job = theJob;
  const { settings, axes } = job.technique;
  const resolution = Number(settings.resolution ?? axes.resolution);
  bounces = Number(settings.bounces ?? axes.bounces);
  feedback = settings.feedback ?? axes.feedback;

  renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: 'high-performance' });
  renderer.toneMapping = THREE.NoToneMapping;
  const gl = renderer.getContext();
  const largest = Math.min(gl.getParameter(gl.MAX_TEXTURE_SIZE), gl.getParameter(gl.MAX_RENDERBUFFER_SIZE));
  const side = Math.max(job.image.width, job.image.height) * Math.sqrt(job.image.samples);
  if (side > largest) throw new Error(`WebGL draws at most ${largest} samples along a side here, the job wants ${side}`);

  const gltf = await new GLTFLoader().loadAsync('/scene.glb');
  const root = gltf.parser.json.scenes[gltf.parser.json.scene ?? 0];
  const extras = root.extras?.probebench ?? {};
  scene = new THREE.Scene().add(gltf.scene);
  skyScene = new THREE.Scene();
  environments = [];
  await addEnvironment(gltf.parser, -Infinity, extras.environment ?? { constant: 0 });
  for (const change of extras.environmentChanges ?? []) await addEnvironment(gltf.parser, change.fromSeconds, change.environment);

  mixer = new THREE.AnimationMixer(gltf.scene);
  for (const clip of gltf.animations) mixer.clipAction(clip).play();

  const places = meshesByPlace(gltf);
  meshes = [...places.values()];
  for (const mesh of meshes) {
    const { materials } = gltf.parser.associations.get(mesh.material) ?? {};
    replaceMaterial(mesh, gltf.parser.json.materials?.[materials] ?? {});
  }

  const far = 4 * new THREE.Box3().setFromObject(gltf.scene).getSize(new THREE.Vector3()).length();
  skyTarget = cubeTarget(resolution);
  skyCube = new THREE.CubeCamera(0.1, 10, skyTarget);
  showEnvironment(job.frames[0].time_s);
  for (const mesh of meshes) setReflection(mesh, skyTarget.texture);
  mirrors = job.frames[0].probes.map((probe) => makeMirror(probe, places, resolution, far));
  mirrors.forEach(captureSky);

  camera = new THREE.Camera();
  camera.matrixAutoUpdate = false;
  camera.projectionMatrix.fromArray(job.camera.clip_from_camera);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();

  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return { three: THREE.REVISION, renderer: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'an unnamed renderer' };
}

// ---- Frames

function showTime(frame) {
  mixer.setTime(frame.time_s);
  showEnvironment(frame.time_s);
  scene.updateMatrixWorld(true);
  camera.matrix.fromArray(frame.world_from_camera);
  camera.updateMatrixWorld(true);
  mirrors.forEach((mirror, i) => mirror.cube.position.fromArray(frame.probes[i].position));
}

function setVisible(objects, visible) {
  for (const object of objects) object.visible = visible;
}

function captureAll() {
  if (feedback === 'sky') mirrors.forEach(captureSky);
  for (let b = 0; b < bounces; b++)
    for (const mirror of mirrors) {
      setVisible(mirror.owners, false);
      mirror.cube.update(renderer, scene);
      setVisible(mirror.owners, true);
    }
}

function drawImage(target) {
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
}

const imageTarget = (scale) =>
  new THREE.WebGLRenderTarget(job.image.width * scale, job.image.height * scale, {
    type: THREE.FloatType, generateMipmaps: false, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
  });

// Mean of scale x scale samples a pixel, top row first.
function readAveraged(target, scale) {
  const { width, height } = job.image;
  const samples = new Float32Array(4 * target.width * scale);
  const rgb = new Float32Array(3 * width * height);
  for (let y = 0; y < height; y++) {
    renderer.readRenderTargetPixels(target, 0, (height - 1 - y) * scale, target.width, scale, samples);
    for (let x = 0; x < width; x++)
      for (let c = 0; c < 3; c++) {
        let sum = 0;
        for (let j = 0; j < scale; j++)
          for (let i = 0; i < scale; i++) sum += samples[4 * (j * target.width + x * scale + i) + c];
        rgb[3 * (y * width + x) + c] = sum / (scale * scale);
      }
  }
  return rgb;
}

function requireNoError() {
  const error = renderer.getContext().getError();
  if (error !== 0) throw new Error(`WebGL reports error ${error}`);
}

async function renderPictures() {
  const scale = Math.round(Math.sqrt(job.image.samples));
  const target = imageTarget(scale);
  for (const [index, frame] of job.frames.entries()) {
    showTime(frame);
    captureAll();
    if (frame.image === null) continue;
    drawImage(target);
    requireNoError();
    const answer = await fetch(`/picture/${index}`, { method: 'POST', body: readAveraged(target, scale) });
    if (!answer.ok) throw new Error(`picture ${frame.image} can't be written: ${await answer.text()}`);
  }
  target.dispose();
}

// One sample a pixel. A frame ends when one of its pixels can be read. Plain frames stand between the others.
function measure(repetitions) {
  const target = imageTarget(1);
  const pixel = new Float32Array(4);
  const timed = (draw) => {
    const start = performance.now();
    draw();
    renderer.readRenderTargetPixels(target, 0, 0, 1, 1, pixel);
    return performance.now() - start;
  };
  const frameMs = [], plainMs = [];
  const kWarmUp = 2, count = kWarmUp + Math.max(10, repetitions);
  for (let i = 0; i < count; i++) {
    const frame = job.frames[i % job.frames.length];
    showTime(frame);
    for (const { owners } of mirrors) for (const mesh of owners) setReflection(mesh, skyTarget.texture);
    plainMs.push(timed(() => drawImage(target)));
    for (const { owners, target: cube } of mirrors) for (const mesh of owners) setReflection(mesh, cube.texture);
    frameMs.push(timed(() => { captureAll(); drawImage(target); }));
  }
  requireNoError();
  return { frame_ms: frameMs.slice(kWarmUp), plain_ms: plainMs.slice(kWarmUp) };
}

window.technique = { load, renderPictures, measure };
