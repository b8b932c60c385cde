// Punctual lights of KHR_lights_punctual. Intensities are radiometric: W/m^2 for directional lights, W/sr for the others.

const float kLightDirectional = 0.0f;
const float kLightPoint = 1.0f;
const float kLightSpot = 2.0f;

struct Light {
  vec4 positionKind;    // xyz world position; w: kLight*
  vec4 directionRange;  // xyz unit vector along which the light shines; w: range in metres, 0 for none
  vec4 intensity;       // rgb
  vec4 cone;            // x scale, y offset of the spot's angular falloff; z w are the renderer's
};

// Unit vector from p towards the light.
PB_FUNC vec3 lightDirection(Light light, vec3 p) {
  if (light.positionKind.w == kLightDirectional) return -vec3(light.directionRange);
  return safeNormalize(vec3(light.positionKind) - p);
}

// Irradiance on a surface at p that faces the light, in W/m^2 (no cosine).
PB_FUNC vec3 lightIrradiance(Light light, vec3 p) {
  vec3 intensity = vec3(light.intensity);
  if (light.positionKind.w == kLightDirectional) return intensity;
  vec3 toLight = vec3(light.positionKind) - p;
  float distanceSquared = max(dot(toLight, toLight), 1e-8f);
  float attenuation = 1.0f / distanceSquared;
  if (light.directionRange.w > 0.0f) {
    float ratioSquared = distanceSquared / (light.directionRange.w * light.directionRange.w);
    attenuation = attenuation * clamp(1.0f - ratioSquared * ratioSquared, 0.0f, 1.0f);
  }
  if (light.positionKind.w == kLightSpot) {
    float cosine = -dot(safeNormalize(toLight), vec3(light.directionRange));
    float angular = clamp(cosine * light.cone.x + light.cone.y, 0.0f, 1.0f);
    attenuation = attenuation * angular * angular;
  }
  return attenuation * intensity;
}

// Irradiance at p with normal n, cosine included.
PB_FUNC vec3 lightIrradianceOn(Light light, vec3 p, vec3 n) {
  return max(dot(n, lightDirection(light, p)), 0.0f) * lightIrradiance(light, p);
}
