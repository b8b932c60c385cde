// Whether later bounce iterations of the frame change what a lookup shows, 1 if they may. Level 0 of a map has it as the
// alpha of each texel, of which the lookup filters some; other levels have 1.

// Of the whole map: no later iteration changes anything of it, only its unsettled texels, or whatever texels.
const float kMapSettled = 0.0f;
const float kMapChanges = 1.0f;
const float kMapUnsettled = 2.0f;

PB_FUNC float unsettledLookup(float alpha, float map) {
  if (map == kMapChanges) return alpha > 0.0f ? 1.0f : 0.0f;
  return map == kMapSettled ? 0.0f : 1.0f;
}
