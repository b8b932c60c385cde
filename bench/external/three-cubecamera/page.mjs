// Draws a scene of probebench with three.js: a CubeCamera for each probe, all of them anew in every frame, B times in turn.
// What glTF can't say (sky, ambient light) comes from the scene's extras.
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const kFarPerNear = 1e5; // of cube cameras: 24 bits of depth still part surfaces 0.1 mm from each other at ten metres

// ---- The environment

const directionShader = /* glsl */ `
  varying vec3 vDirection;
  void main() {
    vDirection = position;
    gl_Position = (projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0)).xyww;
  }`;

// scenes/shading/environment.glsl, gradientSky().
const gradientShader = /* glsl */ `
  uniform vec3 horizon, zenith, below, glow, toGlow;
  uniform float glowPower, limit;
  varying vec3 vDirection;
  void main() {
    vec3 d = normalize(vDirection);
    vec3 base = d.y >= 0.0 ? mix(horizon, zenith, d.y) : below;
    float c = max(dot(d, toGlow), 0.0);
    vec3 radiance = base + (c > 0.0 ? pow(c, glowPower) : 0.0) * glow;
    gl_FragColor = vec4(limit > 0.0 ? min(radiance, vec3(limit)) : radiance, 1.0);
  }`;

const facesShader = /* glsl */ `
  uniform samplerCube faces;
  varying vec3 vDirection;
  void main() { gl_FragColor = vec4(textureCube(faces, normalize(vDirection)).rgb, 1.0); }`;

// A colour may be one number.
const colorOf = (value) => (typeof value === 'number' ? new THREE.Vector3(value, value, value) : new THREE.Vector3(...value));

async function facesTexture(parser, bufferViews) {
  const faces = [];
  for (const index of bufferViews) {
    const { data, width, height } = new EXRLoader().setDataType(THREE.FloatType).parse(await parser.getDependency('bufferView', index));
    // The loader puts the bottom row first; the file's first row is the first that GL takes.
    const rows = new Float32Array(data.length);
    const n = data.length / height;
    for (let y = 0; y < height; y++) rows.set(data.subarray((height - 1 - y) * n, (height - y) * n), y * n);
    const face = new THREE.DataTexture(rows, width, height, THREE.RGBAFormat, THREE.FloatType);
    face.needsUpdate = true;
    faces.push(face);
  }
  const texture = new THREE.CubeTexture(faces);
  Object.assign(texture, { format: THREE.RGBAFormat, type: THREE.FloatType, generateMipmaps: false });
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

// A box around the viewer, drawn behind everything.
async function makeSky(parser, environment) {
  const material = new THREE.ShaderMaterial({
    vertexShader: directionShader, side: THREE.BackSide, depthTest: false, depthWrite: false,
  });
  if (environment.faces) {
    material.fragmentShader = facesShader;
    material.uniforms = { faces: { value: await facesTexture(parser, environment.faces) } };
  } else {
    const sky = environment.sky ?? { horizon: environment.constant, zenith: environment.constant, below: environment.constant };
    material.fragmentShader = gradientShader;
    material.uniforms = {
      glow: { value: colorOf(sky.glow ?? 0) }, glowPower: { value: sky.glowPower ?? 1 },
      toGlow: { value: new THREE.Vector3(...(sky.toGlow ?? [0, 1, 0])).normalize() }, limit: { value: sky.limit ?? 0 },
    };
    for (const key of ['horizon', 'zenith', 'below']) material.uniforms[key] = { value: colorOf(sky[key]) };
  }
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(2, 2, 2), material);
  mesh.frustumCulled = false;
  mesh.renderOrder = -1e9;
  return mesh;
}

// The extras hold irradiance / pi as a polynomial of the normal; three.js wants irradiance as coefficients of spherical
// harmonics, which its shader multiplies by these.
const kShFactors = [0.886227, ...Array(3).fill(2 * 0.511664), 2 * 0.429043, 2 * 0.429043, 0.247708, 2 * 0.429043, 0.429043];

function makeAmbient(coefficients) {
  const probe = new THREE.LightProbe();
  coefficients.forEach((c, i) => probe.sh.coefficients[i].copy(colorOf(c)).multiplyScalar(Math.PI / kShFactors[i]));
  return probe;
}

// ---- Materials

const mirrorVertexShader = /* glsl */ `
  varying vec3 vNormal, vPosition;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    vPosition = world.xyz;
    vNormal = transpose(inverse(mat3(modelMatrix))) * normal;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;

// A smooth metal: Schlick's law from its base colour. The lookup takes the direction alone, as CubeCamera is used.
const mirrorFragmentShader = /* glsl */ `
  uniform samplerCube cube;
  uniform vec3 f0;
  varying vec3 vNormal, vPosition;
  void main() {
    vec3 n = normalize(vNormal);
    if (!gl_FrontFacing) n = -n;
    vec3 v = normalize(cameraPosition - vPosition);
    float c = 1.0 - max(dot(n, v), 0.0);
    vec3 fresnel = f0 + (1.0 - f0) * c * c * c * c * c;
    gl_FragColor = vec4(fresnel * textureCube(cube, reflect(-v, n)).rgb, 1.0);
  }`;

function isMirror(definition) {
  const pbr = definition.pbrMetallicRoughness ?? {};
  const textured = pbr.baseColorTexture || pbr.metallicRoughnessTexture || definition.normalTexture;
  return (pbr.metallicFactor ?? 1) === 1 && (pbr.roughnessFactor ?? 1) === 0 && !textured;
}

function isMatte(definition) {
  const extensions = definition.extensions ?? {};
  return definition.pbrMetallicRoughness?.metallicFactor === 0 && !extensions.KHR_materials_transmission &&
    extensions.KHR_materials_specular?.specularFactor === 0;
}

function makeMatte(loaded) {
  const shared = ['color', 'map', 'emissive', 'emissiveMap', 'emissiveIntensity', 'normalMap', 'normalScale', 'aoMap',
    'aoMapIntensity', 'vertexColors', 'side', 'alphaTest', 'transparent', 'opacity', 'depthWrite', 'flatShading'];
  const material = new THREE.MeshLambertMaterial();
  for (const key of shared) material[key] = loaded[key];
  return material;
}

// Materials that are neither matte nor mirrors keep three.js's own model.
function replaceMaterial(mesh, definition) {
  const loaded = mesh.material;
  if (isMirror(definition)) {
    const f0 = new THREE.Vector3(loaded.color.r, loaded.color.g, loaded.color.b);
    mesh.material = new THREE.ShaderMaterial({
      vertexShader: mirrorVertexShader, fragmentShader: mirrorFragmentShader, side: loaded.side,
      uniforms: { cube: { value: null }, f0: { value: f0 } },
    });
  } else if (isMatte(definition)) {
    mesh.material = makeMatte(loaded);
  } else {
    mesh.material = loaded.clone(); // each shows a cube map of its own
  }
}

// What a mesh reflects; matte ones reflect nothing.
function setReflection(mesh, texture) {
  if (mesh.material.isShaderMaterial) mesh.material.uniforms.cube.value = texture;
  else if (mesh.material.isMeshStandardMaterial) mesh.material.envMap = texture;
}

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
