// Isotropic GGX (Trowbridge-Reitz) microfacets. alpha is the square of the perceptual roughness, at least kSmoothAlpha:
// smoother surfaces are perfect mirrors (Surface.alpha = 0) and never come here. Cosines are those between unit vectors;
// N the surface's normal, H a microfacet's, V towards the viewer, L towards the light.

const float kSmoothAlpha = 1e-3f;

// Orthonormal vectors around n. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct Frame {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
};

PB_FUNC Frame makeFrame(vec3 n) {
  float s = n.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + n.z);
  float b = n.x * n.y * a;
  Frame f;
  f.tangent = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
  f.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
  f.normal = n;
  return f;
}

PB_FUNC vec3 toWorld(Frame f, vec3 v) { return v.x * f.tangent + v.y * f.bitangent + v.z * f.normal; }
PB_FUNC vec3 toLocal(Frame f, vec3 v) { return vec3(dot(v, f.tangent), dot(v, f.bitangent), dot(v, f.normal)); }

// Density of microfacet normals, per steradian: its integral times NoH over the hemisphere is 1.
// Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007), eq. 33. NxH2 is the square of the sine,
// |N x H|^2: 1 - NoH^2 is nothing but rounding where the lobe is narrow.
PB_FUNC float D_GGX(float NoH, float NxH2, float alpha) {
  if (NoH <= 0.0f) return 0.0f;
  float a2 = alpha * alpha;
  float t = NxH2 + a2 * NoH * NoH;
  return a2 / (kPi * t * t);
}

// |N x H|^2 of unit vectors.
PB_FUNC float crossSquared(vec3 n, vec3 h) {
  vec3 c = cross(n, h);
  return dot(c, c);
}

// Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014, eq. 72.
PB_FUNC float lambda_GGX(float cosine, float alpha) {
  float c2 = cosine * cosine;
  float tan2 = max(1.0f - c2, 0.0f) / max(c2, 1e-12f);
  return 0.5f * (sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

// Masking of one direction: Heitz 2014, eq. 43.
PB_FUNC float G1_SmithGGX(float cosine, float alpha) { return 1.0f / (1.0f + lambda_GGX(cosine, alpha)); }

// Height-correlated masking and shadowing of directions on the same side: Heitz 2014, eq. 99.
PB_FUNC float G2_SmithGGXCorrelated(float NoL, float NoV, float alpha) {
  return 1.0f / (1.0f + lambda_GGX(NoL, alpha) + lambda_GGX(NoV, alpha));
}

// G2 / (4 NoL NoV).
PB_FUNC float V_SmithGGXCorrelated(float NoL, float NoV, float alpha) {
  return G2_SmithGGXCorrelated(NoL, NoV, alpha) / max(4.0f * NoL * NoV, 1e-12f);
}

// Geometry terms that rasterisers use; see geometryTerm().
const float kGeometrySmithCorrelated = 0.0f;
const float kGeometryOne = 1.0f;
const float kGeometrySmithK = 2.0f;
const float kGeometryCookTorrance = 3.0f;

PB_FUNC float schlickG1(float cosine, float k) { return cosine / max(cosine * (1.0f - k) + k, 1e-12f); }

// G of a microfacet BRDF F D G / (4 NoL NoV). kGeometrySmithK: Schlick's form of Smith with k = roughness^2 / 2 = alpha / 2
// (Karis, "Real Shading in Unreal Engine 4" (2013), for image-based light). kGeometryCookTorrance: Cook and Torrance,
// "A Reflectance Model for Computer Graphics" (1982), the V-cavities' min().
PB_FUNC float geometryTerm(float term, float NoL, float NoV, float NoH, float VoH, float alpha) {
  if (term == kGeometryOne) return 1.0f;
  if (term == kGeometrySmithK) return schlickG1(NoL, 0.5f * alpha) * schlickG1(NoV, 0.5f * alpha);
  if (term == kGeometryCookTorrance) return min(1.0f, 2.0f * NoH * min(NoV, NoL) / max(VoH, 1e-12f));
  return G2_SmithGGXCorrelated(NoL, NoV, alpha);
}

// A microfacet normal that is visible from V (local frame, V.z > 0), from two uniform numbers in [0,1).
// Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8), 2023.
PB_FUNC vec3 sampleVisibleNormal(vec3 V, float alpha, vec2 u) {
  vec3 stretched = safeNormalize(vec3(alpha * V.x, alpha * V.y, V.z));
  float phi = 2.0f * kPi * u.x;
  float z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
  float sinTheta = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  vec3 h = vec3(sinTheta * cos(phi), sinTheta * sin(phi), z) + stretched;
  return safeNormalize(vec3(alpha * h.x, alpha * h.y, max(h.z, 0.0f)));
}

// Density of sampleVisibleNormal() per steradian of microfacet normals: Heitz 2014, eq. 2. The density of the direction
// reflected there is this over 4 VoH (Walter et al. 2007, eq. 14).
PB_FUNC float pdfVisibleNormal(float NoV, float NoH, float NxH2, float VoH, float alpha) {
  return G1_SmithGGX(NoV, alpha) * D_GGX(NoH, NxH2, alpha) * max(VoH, 0.0f) / max(NoV, 1e-12f);
}

// What an ideal specular lobe reflects of uniform light, as x F0 + y F90 with Schlick's Fresnel: the directional albedo's
// split sum (Karis 2013). The first and last texels of the table (scenes/dfg_table.h) stand for 0 and 1 of NoV
// along x and of perceptual roughness along y; linear between texels.
PB_FUNC vec2 sampleDfg(sampler2D table, float NoV, float roughness) {
  int n = textureSize(table, 0).x;
  float size = float(n);
  float x = clamp(NoV, 0.0f, 1.0f) * (size - 1.0f);
  float y = clamp(roughness, 0.0f, 1.0f) * (size - 1.0f);
  int x0 = min(int(x), n - 2);
  int y0 = min(int(y), n - 2);
  float fx = x - float(x0);
  float fy = y - float(y0);
  vec4 low = mix(texelFetch(table, ivec2(x0, y0), 0), texelFetch(table, ivec2(x0 + 1, y0), 0), fx);
  vec4 high = mix(texelFetch(table, ivec2(x0, y0 + 1), 0), texelFetch(table, ivec2(x0 + 1, y0 + 1), 0), fx);
  vec4 dfg = mix(low, high, fy);
  return vec2(dfg.x, dfg.y);
}
