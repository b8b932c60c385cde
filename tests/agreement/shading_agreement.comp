#version 450 core
#define PB_FUNC
#include "scenes/shading/common.glsl"
#include "scenes/shading/cubemap.glsl"
#include "scenes/shading/environment.glsl"
#include "scenes/shading/fresnel.glsl"
#include "scenes/shading/light.glsl"
#include "scenes/shading/area_light.glsl"
#include "scenes/shading/microfacet.glsl"
#include "scenes/shading/probe_map.glsl"
#include "scenes/shading/proxy.glsl"
#include "scenes/shading/screen.glsl"
#include "scenes/shading/srgb.glsl"
#include "scenes/shading/surface.glsl"
#include "scenes/shading/texture.glsl"
#include "scenes/shading/view.glsl"
#include "scenes/shading/volume.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Inputs { vec4 inputs[]; };
layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };
layout(location = 0) uniform int chosen;
layout(binding = 0) uniform sampler2D image;
layout(binding = 1) uniform sampler2DArray faces;

#define AGREEMENT_CASES_BEGIN vec4 evaluate(vec4 a, vec4 b) { switch (chosen) {
#define AGREEMENT_CASE(index, expression) case index: return expression;
#define AGREEMENT_CASES_END } return vec4(0.0f); }
#include "tests/agreement/cases.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (2u * i + 1u < uint(inputs.length())) outputs[i] = evaluate(inputs[2u * i], inputs[2u * i + 1u]);
}
