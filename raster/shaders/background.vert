#version 450 core

// One triangle over the whole viewport, at infinite distance: reversed depth 0.
void main() {
  vec2 corner = vec2(float(gl_VertexID % 2), float(gl_VertexID / 2));
  gl_Position = vec4(4.0f * corner - vec2(1.0f), 0.0f, 1.0f);
}
