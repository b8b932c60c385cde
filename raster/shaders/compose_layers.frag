#version 450 core
// The layers of a sample in front of each other: rgb what they send together, a what they let through from behind.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/layers.glsl"

layout(location = 0) out vec4 lightAndTransmittance;

uint nextOf(uint layer) { return layers[layer - 1u].key.w; }

// Nearest first; ties of depth by instance, then by triangle. No two layers of a sample are equal: a triangle covers a
// sample once.
bool isBefore(uint a, uint b) {
  uvec4 p = layers[a - 1u].key;
  uvec4 q = layers[b - 1u].key;
  if (p.x != q.x) return p.x > q.x;
  if (p.y != q.y) return p.y < q.y;
  return p.z < q.z;
}

struct SortedList {
  uint head;
  bool complete;  // false: the driver left a loop early (llvmpipe after 65535 iterations, which is some 2300 layers)
};

// Merge sort from runs of one layer on, in place: n log n, so that no number of layers is too slow or needs memory.
SortedList sortList(uint head) {
  uint runs = 2u;
  for (uint length = 1u; runs > 1u; length *= 2u) {
    uint a = head;
    uint tail = 0u;
    runs = 0u;
    while (a != 0u) {
      ++runs;
      uint b = a;
      uint aLeft = 0u;
      while (aLeft < length && b != 0u) {
        ++aLeft;
        b = nextOf(b);
      }
      uint bLeft = length;
      while (aLeft > 0u || (bLeft > 0u && b != 0u)) {
        bool takesA = aLeft > 0u && (bLeft == 0u || b == 0u || isBefore(a, b));
        uint taken = takesA ? a : b;
        if (takesA) {
          a = nextOf(a);
          --aLeft;
        } else {
          b = nextOf(b);
          --bLeft;
        }
        if (tail == 0u) head = taken;
        else layers[tail - 1u].key.w = taken;
        tail = taken;
      }
      a = b;
    }
    layers[tail - 1u].key.w = 0u;
  }
  return SortedList(head, runs == 1u);
}

void main() {
  uint head = imageLoad(layerHeads, ivec2(gl_FragCoord.xy)).x;
  if (head == 0u) discard;
  SortedList list = sortList(head);
  vec3 light = vec3(0.0f);
  float transmittance = 1.0f;
  uint i = list.head;
  while (i != 0u) {
    vec4 layer = layers[i - 1u].light;
    light += transmittance * layer.w * vec3(layer);
    transmittance *= 1.0f - layer.w;
    i = nextOf(i);
  }
  if (!list.complete || i != 0u) atomicAdd(layerCount.y, 1u);
  lightAndTransmittance = vec4(light, transmittance);
}
