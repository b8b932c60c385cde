// sRGB transfer functions, IEC 61966-2-1:1999 (exact two-piece curves). Inputs are clamped to [0,1].

PB_FUNC float srgbEncode(float linearValue) {
  float x = clamp(linearValue, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}

PB_FUNC float srgbDecode(float encoded) {
  float x = clamp(encoded, 0.0f, 1.0f);
  return x <= 0.04045f ? x / 12.92f : pow((x + 0.055f) / 1.055f, 2.4f);
}
