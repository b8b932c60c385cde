// A glTF file under construction, for tests of the loader.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/files.h"
#include "scenes/gltf/document.h"
#include "scenes/gltf_load.h"
#include "scenes/image_io.h"

namespace pb {

// Starts with one node that shows one mesh of one triangle in the plane z = 0.
class GltfFile {
 public:
  GltfFile() {
    json = {{"asset", {{"version", "2.0"}}},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"name", "triangle"}, {"mesh", 0}}}}};
    primitive() = {{"attributes", {{"POSITION", add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 5126)}}}};
  }

  nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }

  // Gives the triangle a material of its own and returns that.
  nlohmann::json& material() {
    primitive()["material"] = 0;
    return json["materials"][0];
  }

  int addBufferView(const std::string& bytes) {
    data_.resize((data_.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
    data_ += bytes;
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  // A new accessor's index.
  template <class T>
  int add(const std::vector<T>& values, const std::string& type, int componentType) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    json["accessors"].push_back({{"bufferView", addBufferView(bytes)},
                                 {"componentType", componentType},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  // A new texture's index; the image is in a buffer view.
  int addTexture(const std::string& imageBytes) {
    json["images"].push_back({{"bufferView", addBufferView(imageBytes)}, {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return static_cast<int>(json["textures"].size()) - 1;
  }

  Scene load() {
    json["buffers"] = {{{"byteLength", data_.size()}}};
    writeFileAtomically(folder_.file("test.glb"), gltf::packGlb(json, data_));
    return loadGltf(folder_.file("test.glb"));
  }

  const std::string& data() const { return data_; }
  const TemporaryFolder& folder() const { return folder_; }

  nlohmann::json json;

 private:
  std::string data_;
  TemporaryFolder folder_;
};

inline const Mesh& onlyMesh(const Scene& scene) { return *scene.instances.at(0).mesh; }

// Of the file's first material.
inline shading::MaterialConstants constantsOf(GltfFile& file) { return file.load().materials.at(0).constants; }

inline std::string grayPng(float value) { return encodePng(ImageRgba(2, 2, {value, value, value, 1.0f}), 8); }

}  // namespace pb
