// The implementation part of the header-only tinygltf, compiled once. Its image readers stay out: images go through
// image_io.h. So does its Draco reader, which trusts indices that the file gives (see gltf/draco.h for ours).
#define TINYGLTF_IMPLEMENTATION
#include "scenes/gltf/tinygltf.h"
