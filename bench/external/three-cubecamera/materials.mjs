// What stands for the materials of a scene of probebench.
import * as THREE from 'three';

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

export function isMirror(definition) {
  const pbr = definition.pbrMetallicRoughness ?? {};
  const textured = pbr.baseColorTexture || pbr.metallicRoughnessTexture || definition.normalTexture;
  return (pbr.metallicFactor ?? 1) === 1 && (pbr.roughnessFactor ?? 1) === 0 && !textured;
}

export function isMatte(definition) {
  const extensions = definition.extensions ?? {};
  return definition.pbrMetallicRoughness?.metallicFactor === 0 && !extensions.KHR_materials_transmission &&
    extensions.KHR_materials_specular?.specularFactor === 0;
}

export function makeMatte(loaded) {
  const shared = ['color', 'map', 'emissive', 'emissiveMap', 'emissiveIntensity', 'normalMap', 'normalScale', 'aoMap',
    'aoMapIntensity', 'vertexColors', 'side', 'alphaTest', 'transparent', 'opacity', 'depthWrite', 'flatShading'];
  const material = new THREE.MeshLambertMaterial();
  for (const key of shared) material[key] = loaded[key];
  return material;
}

// Materials that are neither matte nor mirrors keep three.js's own model.
export function replaceMaterial(mesh, definition) {
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
export function setReflection(mesh, texture) {
  if (mesh.material.isShaderMaterial) mesh.material.uniforms.cube.value = texture;
  else if (mesh.material.isMeshStandardMaterial) mesh.material.envMap = texture;
}
