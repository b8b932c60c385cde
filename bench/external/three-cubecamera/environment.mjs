// Sky and ambient light of a scene of probebench, from the scene's extras: glTF can't say them.
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

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
export async function makeSky(parser, environment) {
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

export function makeAmbient(coefficients) {
  const [constant, ...others] = coefficients.map(colorOf);
  // The same from all sides is cheaper as three.js's ambient light.
  if (others.every((c) => c.length() === 0))
    return new THREE.AmbientLight(new THREE.Color(constant.x, constant.y, constant.z), Math.PI);
  const probe = new THREE.LightProbe();
  [constant, ...others].forEach((c, i) => probe.sh.coefficients[i].copy(c).multiplyScalar(Math.PI / kShFactors[i]));
  return probe;
}
