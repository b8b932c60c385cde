// Texture filtering in full float precision by texelFetch: the same texels with the same weights in both renderers.

// Sampler settings, in a vec4 so that they travel in GPU buffers: x wrap of u, y wrap of v (kWrap*), z magnification and
// w minification filter (kFilter*).
const float kWrapRepeat = 0.0f;
const float kWrapMirror = 1.0f;
const float kWrapClamp = 2.0f;
const float kFilterNearest = 0.0f;
const float kFilterLinear = 1.0f;
const float kFilterNearestMipNearest = 2.0f;
const float kFilterLinearMipNearest = 3.0f;
const float kFilterNearestMipLinear = 4.0f;
const float kFilterLinearMipLinear = 5.0f;

PB_FUNC int wrapTexel(int i, int n, float wrap) {
  if (wrap == kWrapClamp) return clamp(i, 0, n - 1);
  if (wrap == kWrapRepeat) return ((i % n) + n) % n;
  int period = 2 * n;
  int m = ((i % period) + period) % period;
  return m < n ? m : period - 1 - m;
}

// Integer texel coordinates stay exact (and in range of int) when u is brought near [0,1) first.
PB_FUNC float wrapCoordinate(float u, float wrap) {
  if (wrap == kWrapClamp) return clamp(u, -1.0f, 2.0f);
  return u - 2.0f * floor(0.5f * u);
}

PB_FUNC vec2 wrapCoordinates(vec2 uv, vec4 settings) {
  return vec2(wrapCoordinate(uv.x, settings.x), wrapCoordinate(uv.y, settings.y));
}

PB_FUNC ivec2 nearestTexel(vec2 uv, ivec2 size, vec4 settings) {
  ivec2 p = ivec2(floor(wrapCoordinates(uv, settings) * vec2(size)));
  return ivec2(wrapTexel(p.x, size.x, settings.x), wrapTexel(p.y, size.y, settings.y));
}

// Of a level from the size of level 0: llvmpipe's textureSize() takes one invocation's level for all that run side by side.
PB_FUNC ivec2 levelSize(sampler2D image, int level) { return max(textureSize(image, 0) >> level, ivec2(1)); }

PB_FUNC vec4 sampleNearest(sampler2D image, vec2 uv, int level, vec4 settings) {
  return texelFetch(image, nearestTexel(uv, levelSize(image, level), settings), level);
}

PB_FUNC vec4 sampleBilinear(sampler2D image, vec2 uv, int level, vec4 settings) {
  ivec2 size = levelSize(image, level);
  vec2 p = wrapCoordinates(uv, settings) * vec2(size) - vec2(0.5f);
  vec2 corner = floor(p);
  vec2 f = p - corner;
  ivec2 i = ivec2(corner);
  int x0 = wrapTexel(i.x, size.x, settings.x);
  int x1 = wrapTexel(i.x + 1, size.x, settings.x);
  int y0 = wrapTexel(i.y, size.y, settings.y);
  int y1 = wrapTexel(i.y + 1, size.y, settings.y);
  vec4 top = mix(texelFetch(image, ivec2(x0, y0), level), texelFetch(image, ivec2(x1, y0), level), f.x);
  vec4 bottom = mix(texelFetch(image, ivec2(x0, y1), level), texelFetch(image, ivec2(x1, y1), level), f.x);
  return mix(top, bottom, f.y);
}

PB_FUNC vec4 sampleLevel(sampler2D image, vec2 uv, int level, bool bilinear, vec4 settings) {
  return bilinear ? sampleBilinear(image, uv, level, settings) : sampleNearest(image, uv, level, settings);
}

// lod <= 0 magnifies. Levels beyond the last are clamped.
PB_FUNC vec4 sampleTexture(sampler2D image, vec2 uv, float lod, vec4 settings) {
  if (lod <= 0.0f) return sampleLevel(image, uv, 0, settings.z != kFilterNearest, settings);
  float filter_ = settings.w;
  bool bilinear = filter_ == kFilterLinear || filter_ == kFilterLinearMipNearest || filter_ == kFilterLinearMipLinear;
  if (filter_ == kFilterNearest || filter_ == kFilterLinear) return sampleLevel(image, uv, 0, bilinear, settings);
  int last = textureQueryLevels(image) - 1;
  float level = min(lod, float(last));
  if (filter_ == kFilterNearestMipNearest || filter_ == kFilterLinearMipNearest)
    return sampleLevel(image, uv, int(floor(level + 0.5f)), bilinear, settings);
  int lower = min(int(floor(level)), last);
  int upper = min(lower + 1, last);
  return mix(sampleLevel(image, uv, lower, bilinear, settings), sampleLevel(image, uv, upper, bilinear, settings),
             level - float(lower));
}

// 1 + index of the texel that a lookup reads if it reads a single one of level 0 (a nearest filter), else 0.
PB_FUNC int nearestTexelId(sampler2D image, vec2 uv, float lod, vec4 settings) {
  bool single = lod <= 0.0f ? settings.z == kFilterNearest : settings.w == kFilterNearest;
  if (!single) return 0;
  ivec2 size = textureSize(image, 0);
  ivec2 p = nearestTexel(uv, size, settings);
  return p.y * size.x + p.x + 1;
}

// KHR_texture_transform and the UV set. matrix: columns (x,y) and (z,w); offset: x y offset, z UV set (0 or 1).
PB_FUNC vec2 textureCoordinates(vec4 matrix, vec4 offset, vec2 uv0, vec2 uv1) {
  vec2 uv = offset.z < 0.5f ? uv0 : uv1;
  return vec2(matrix.x * uv.x + matrix.z * uv.y + offset.x, matrix.y * uv.x + matrix.w * uv.y + offset.y);
}

// Level of detail from a ray cone: Akenine-Moller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing",
// Ray Tracing Gems (2019), chapter 20, eq. 20.5 and 20.9, with the texel density given a vertex instead of a triangle.
// coneWidth: metres at the hit; cosine: of the angle between ray and normal; uvPerMetre: sqrt(UV area / world area).
PB_FUNC float coneLod(float coneWidth, float cosine, float uvPerMetre, ivec2 textureSizePx, vec4 matrix) {
  float stretch = sqrt(abs(matrix.x * matrix.w - matrix.y * matrix.z));
  float texelsPerMetre = uvPerMetre * stretch * sqrt(float(textureSizePx.x) * float(textureSizePx.y));
  return log2(max(coneWidth * texelsPerMetre / max(abs(cosine), 1e-3f), 1e-9f));
}
