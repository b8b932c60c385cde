// Which level of a filtered cube map stands for which lobe: compiled as GLSL and as C++ (raster/prefilter.cpp).

// ggx-prefiltered: level 0 is unfiltered, `last` stands for roughness 1. The lobe of level 1 is about as wide as two of
// that level's texels when the last level has 8 texels along an edge, and lobes between levels grow by about the same
// factor (Filament's mapping: Guy and Agopian, "Physically Based Rendering in Filament", 2018).
PB_FUNC float ggxLod(float roughness, float last) { return last * roughness * (2.0f - roughness); }

// Perceptual roughness of a level: the inverse of ggxLod().
PB_FUNC float ggxLevelRoughness(float level, float last) { return 1.0f - sqrt(max(1.0f - level / last, 0.0f)); }

// box-mips: the level whose mean texel, 4 pi / (6 n^2) for n texels along an edge, has the solid angle of a box as high as
// the lobe's peak and with its integral. That is 4 pi alpha^2: the density of GGX's reflected direction along the mirror
// direction is D(1) / 4 = 1 / (4 pi alpha^2) where N = V.
PB_FUNC float boxLod(float alpha, float resolution) {
  float texels = 2.44948974f * resolution * alpha;  // sqrt(6): edge of the lobe's square in texels of level 0
  return clamp(log2(max(texels, 1.0f)), 0.0f, log2(resolution));
}
