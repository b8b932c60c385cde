// Constants and guards of the shading model, compiled as GLSL 4.50 and as C++20 through GLM (see shading.h).

const float kPi = 3.14159265358979f;

// GLM and GLSL both leave normalize(0) undefined; the model answers +Z.
PB_FUNC vec3 safeNormalize(vec3 v) {
  float lengthSquared = dot(v, v);
  return lengthSquared > 1e-30f ? v / sqrt(lengthSquared) : vec3(0.0f, 0.0f, 1.0f);
}

// x^5 by multiplication: pow() differs between compilers.
PB_FUNC float pow5(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}
