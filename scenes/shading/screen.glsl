// Pictures of emissive screens: small signed-distance scenes, drawn by sphere tracing with a bounded number of steps.
// Hart, "Sphere Tracing: A Geometric Method for the Antialiased Ray Tracing of Implicit Surfaces" (1996). Distances are lower
// bounds in the scene's own units. `turn` is the time as an angle: everything moves with sines of whole multiples of it, so
// that a picture at 2 pi is that at 0.

const float kScreenMelt = 0.0f;     // balls that melt into each other over a floor
const float kScreenTwist = 1.0f;    // a twisting block with a ball cut out of it
const float kScreenRipples = 2.0f;  // a ball over rippling water
const float kScreenRings = 3.0f;    // rings that glow where rays need many steps
const float kScreenPrograms = 4.0f;

const int kScreenSteps = 64;
const int kScreenShadowSteps = 20;
const float kScreenFar = 12.0f;
const float kScreenHit = 1e-3f;

PB_FUNC float sphereDistance(vec3 p, float radius) { return sqrt(dot(p, p)) - radius; }

PB_FUNC float boxDistance(vec3 p, vec3 halfEdges) {
  vec3 q = abs(p) - halfEdges;
  vec3 outside = max(q, vec3(0.0f));
  return sqrt(dot(outside, outside)) + min(max(q.x, max(q.y, q.z)), 0.0f);
}

// Around +Z.
PB_FUNC float torusDistance(vec3 p, float majorRadius, float minorRadius) {
  float ring = sqrt(p.x * p.x + p.y * p.y) - majorRadius;
  return sqrt(ring * ring + p.z * p.z) - minorRadius;
}

// Quilez, "Smooth minimum" (2008), the quadratic polynomial: bodies within `blend` of each other grow together.
PB_FUNC float smoothUnion(float a, float b, float blend) {
  float h = max(blend - abs(a - b), 0.0f) / blend;
  return min(a, b) - 0.25f * blend * h * h;
}

PB_FUNC float subtraction(float body, float cutter) { return max(body, -cutter); }

// Turns p around +Y by an angle that grows with height: a shear by s = radiansPerUnit times the distance r to the axis.
// Distances behind it must be divided by its stretch L = s / 2 + sqrt(1 + s^2 / 4) on the way to the body; the L of r0 is
// enough for larger r, too, if from r0 on (r - inner) / L < r - outer, for a body between two cylinders (or two spheres).
PB_FUNC vec3 twisted(vec3 p, float radiansPerUnit) {
  float c = cos(radiansPerUnit * p.y);
  float s = sin(radiansPerUnit * p.y);
  return vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
}

// Height of rings that run outwards on water; its slope stays below 0.315.
PB_FUNC float rippleHeight(vec3 p, float turn) {
  float radius = sqrt(p.x * p.x + p.z * p.z);
  return 0.05f * sin(6.0f * radius - 2.0f * turn) / (1.0f + 0.3f * radius);
}

PB_FUNC float meltDistance(vec3 p, float turn) {
  vec3 a = vec3(0.9f * sin(turn), 0.25f * sin(2.0f * turn), 0.0f);
  vec3 b = vec3(-0.8f * sin(turn), 0.5f * cos(turn), 0.3f * cos(turn));
  vec3 c = vec3(0.3f * cos(2.0f * turn), -0.35f, 0.6f * sin(turn));
  float balls = smoothUnion(sphereDistance(p - a, 0.45f), sphereDistance(p - b, 0.4f), 0.5f);
  balls = smoothUnion(balls, sphereDistance(p - c, 0.35f), 0.5f);
  return smoothUnion(balls, p.y + 0.9f, 0.3f);
}

PB_FUNC float twistDistance(vec3 p, float turn) {
  vec3 q = twisted(p, 1.2f * sin(turn));
  // Inner radius 0.55, outer 0.78: r0 = 1.07.
  float block = boxDistance(q, vec3(0.55f, 0.9f, 0.55f)) / 1.83f;
  vec3 hole = vec3(0.5f * cos(turn), 0.5f * sin(turn), 0.5f);
  return min(subtraction(block, sphereDistance(p - hole, 0.5f)), p.y + 0.95f);
}

PB_FUNC float ripplesDistance(vec3 p, float turn) {
  // 1.05 is the length of the vector (slope, 1).
  float water = (p.y + 0.6f - rippleHeight(p, turn)) / 1.05f;
  return min(water, sphereDistance(p - vec3(0.0f, 0.25f + 0.2f * sin(turn), 0.0f), 0.5f));
}

PB_FUNC float ringsDistance(vec3 p, float turn) {
  vec3 q = twisted(p, 0.4f * sin(turn));
  float c = cos(turn);
  float s = sin(turn);
  vec3 r = vec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z);
  float outer = torusDistance(q, 1.05f, 0.08f);
  float inner = torusDistance(r, 0.7f, 0.07f);
  // Inner radius 0.2, outer 1.14: r0 = 2.6.
  return min(smoothUnion(outer, inner, 0.25f), sphereDistance(r, 0.2f)) / 1.65f;
}

PB_FUNC float screenDistance(float program, vec3 p, float turn) {
  if (program == kScreenMelt) return meltDistance(p, turn);
  if (program == kScreenTwist) return twistDistance(p, turn);
  if (program == kScreenRipples) return ripplesDistance(p, turn);
  return ringsDistance(p, turn);
}

struct ScreenHit {
  float distance;  // along the ray, kScreenFar for a miss
  float steps;     // taken
};

PB_FUNC ScreenHit traceScreen(float program, vec3 origin, vec3 direction, float turn) {
  ScreenHit hit;
  hit.distance = 0.0f;
  hit.steps = 0.0f;
  for (int i = 0; i < kScreenSteps; ++i) {
    float d = screenDistance(program, origin + hit.distance * direction, turn);
    if (d < kScreenHit) return hit;
    hit.distance += d;
    hit.steps += 1.0f;
    if (hit.distance > kScreenFar) break;
  }
  hit.distance = kScreenFar;
  return hit;
}

// Central differences.
PB_FUNC vec3 screenNormal(float program, vec3 p, float turn) {
  const float h = 2e-3f;
  vec3 x = vec3(h, 0.0f, 0.0f);
  vec3 y = vec3(0.0f, h, 0.0f);
  vec3 z = vec3(0.0f, 0.0f, h);
  return safeNormalize(vec3(screenDistance(program, p + x, turn) - screenDistance(program, p - x, turn),
                            screenDistance(program, p + y, turn) - screenDistance(program, p - y, turn),
                            screenDistance(program, p + z, turn) - screenDistance(program, p - z, turn)));
}

// Share of a light of angular radius 1 / sharpness that no body covers, from the closest approach of the ray to its centre.
// Quilez, "Soft shadows in raymarched SDFs" (2010).
PB_FUNC float softShadow(float program, vec3 origin, vec3 toLight, float turn, float sharpness) {
  float open = 1.0f;
  float t = 0.05f;
  for (int i = 0; i < kScreenShadowSteps; ++i) {
    float d = screenDistance(program, origin + t * toLight, turn);
    open = min(open, sharpness * d / t);
    t += clamp(d, 0.02f, 0.4f);
    if (open <= 0.0f || t > 4.0f) break;
  }
  return clamp(open, 0.0f, 1.0f);
}

PB_FUNC vec3 screenAlbedo(float program, vec3 p) {
  if (program == kScreenMelt) return p.y < -0.8f ? vec3(0.15f, 0.3f, 0.5f) : vec3(0.95f, 0.35f, 0.1f);
  if (program == kScreenTwist) return p.y < -0.94f ? vec3(0.35f, 0.1f, 0.45f) : vec3(0.2f, 0.85f, 0.5f);
  if (program == kScreenRipples) return p.y < -0.5f ? vec3(0.1f, 0.45f, 0.6f) : vec3(0.95f, 0.8f, 0.2f);
  return vec3(0.3f, 0.1f, 0.4f);
}

PB_FUNC vec3 screenSky(float program, vec3 direction) {
  if (program == kScreenRings) return vec3(0.01f, 0.01f, 0.04f);
  return mix(vec3(0.5f, 0.25f, 0.35f), vec3(0.08f, 0.1f, 0.3f), clamp(2.0f * direction.y, 0.0f, 1.0f));
}

// Glow of a ray that needed many steps, so that passed close to a surface: the share squared, in the program's colour.
PB_FUNC vec3 screenGlow(float program, float steps) {
  float share = steps / float(kScreenSteps);
  vec3 color = program == kScreenRings ? vec3(2.5f, 1.2f, 3.5f) : vec3(0.15f, 0.2f, 0.3f);
  return share * share * color;
}

// Radiance in W/(sr m^2), before the material's factor, at uv (0,0 in the upper left corner); aspect is width / height.
PB_FUNC vec3 screenRadiance(float program, vec2 uv, float aspect, float turn) {
  vec3 eye = vec3(0.0f, 0.3f, 3.0f);
  vec3 direction = safeNormalize(vec3(0.55f * aspect * (2.0f * uv.x - 1.0f), 0.55f * (1.0f - 2.0f * uv.y) - 0.1f, -1.0f));
  ScreenHit hit = traceScreen(program, eye, direction, turn);
  vec3 glow = screenGlow(program, hit.steps);
  if (hit.distance >= kScreenFar) return screenSky(program, direction) + glow;
  vec3 p = eye + hit.distance * direction;
  vec3 n = screenNormal(program, p, turn);
  vec3 toLight = vec3(0.48f, 0.8f, 0.36f);
  float light = max(dot(n, toLight), 0.0f);
  if (light > 0.0f) light *= softShadow(program, p + 0.01f * n, toLight, turn, 8.0f);
  return screenAlbedo(program, p) * (1.2f * light + 0.15f * (1.0f + n.y)) + glow;
}
