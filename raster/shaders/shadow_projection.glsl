// A face of a shadow map: clip position of a point, with reversed depth. View directions as in scenes/shading/view.glsl.
vec4 shadowClipPosition(ShadowFace face, vec3 p) {
  vec4 clip = clipFromWorldPosition(face.view, p);  // w: metres along forward
  if (face.values.x < 0.5f) return clip;
  return vec4(clip.x, clip.y, 1.0f - clip.w / face.values.y, 1.0f);
}
