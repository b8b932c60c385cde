// Materials of .mtl files as ours.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "scenes/obj/library.h"
#include "scenes/scene.h"

namespace pb::obj {

// Adds materials, textures and warnings to the scene.
class Materials {
 public:
  Materials(MtlMaterials source, std::filesystem::path folder, Scene& scene);

  // The scene's material of that name, made when first wanted by a mesh of these bounds.
  int indexOf(const std::string& name, const Bounds& bounds);

 private:
  Material make(const std::string& name, const Bounds& bounds);
  Material makeGlass(const std::string& name, const MtlMaterial& m, const Bounds& bounds);
  Material makeOpaque(const std::string& name, const MtlMaterial& m);
  glm::vec3 reflectance(const std::string& name, const char* statement, const float (&v)[3]);
  glm::vec3 baseColor(const std::string& name, const MtlMaterial& m);
  void addTexture(const tinyobj::material_t& values, Material& material);
  int textureOf(std::string file);
  void warnOfIgnored(const std::string& name, const MtlMaterial& m);
  void warn(const std::string& material, const std::string& what);

  MtlMaterials source_;
  std::filesystem::path folder_;
  Scene& scene_;
  std::map<std::string, int> indices_;
  std::map<std::string, int> textures_;
};

}  // namespace pb::obj
