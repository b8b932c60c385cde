// The fragments of blended surfaces, as one linked list a sample: Yang et al., "Real-Time Concurrent Linked List
// Construction on the GPU" (2010), section 3. Lists are in no particular order.

struct Layer {
  vec4 light;  // rgb radiance; w opacity
  uvec4 key;   // x bits of the depth (near is large), y instance, z triangle, w the next layer of the list (0: the last)
};

// A list's links and its head are numbers of layers, counted from 1. layerCount.x counts also the layers that there was no
// room for, y the samples that could not be composed.
layout(std430, binding = kLayerBlock) buffer LayerBlock {
  uvec4 layerCount;
  Layer layers[];
};
layout(r32ui, binding = kLayerHeadImage) uniform uimage2D layerHeads;

void addLayer(vec3 radiance, float opacity) {
  uint index = atomicAdd(layerCount.x, 1u);
  if (index >= uint(layers.length())) return;
  uint next = imageAtomicExchange(layerHeads, ivec2(gl_FragCoord.xy), index + 1u);
  layers[index].light = vec4(radiance, opacity);
  layers[index].key = uvec4(floatBitsToUint(gl_FragCoord.z), uint(instance.values.z), uint(gl_PrimitiveID), next);
}
