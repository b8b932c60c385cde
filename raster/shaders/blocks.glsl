// The buffers of every shader that draws the scene.
#include "scenes/shading/common.glsl"
#include "scenes/shading/view.glsl"
#include "scenes/shading/cubemap.glsl"
#include "scenes/shading/environment.glsl"
#include "scenes/shading/fresnel.glsl"
#include "scenes/shading/light.glsl"
#include "scenes/shading/area_light.glsl"
#include "scenes/shading/microfacet.glsl"
#include "scenes/shading/proxy.glsl"
#include "scenes/shading/texture.glsl"
#include "scenes/shading/surface.glsl"
#include "scenes/shading/volume.glsl"
#include "raster/shaders/gpu_structs.glsl"

layout(std140, binding = kPassBlock) uniform PassBlock { PassConstants pass; };
layout(std140, binding = kSceneBlock) uniform SceneBlock { SceneConstants scene; };
layout(std140, binding = kInstanceBlock) uniform InstanceBlock { InstanceConstants instance; };
layout(std140, binding = kMaterialBlock) uniform MaterialBlock { MaterialConstants material; };
