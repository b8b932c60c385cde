// The faces of an .obj file, by name and material.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace tinyobj {
struct index_t;
}

namespace pb::obj {

// Indices from 0; -1 for none.
struct Corner {
  int position = -1, uv = -1, normal = -1;

  friend auto operator<=>(const Corner&, const Corner&) = default;
};

// Faces of one name and material; three corners a triangle.
struct Part {
  std::string name, material;
  std::vector<Corner> corners;
};

// Throws an input Error naming the face for indices of what isn't there.
class Geometry {
 public:
  // Faces before the first object or group are called `name`.
  Geometry(const std::string& text, std::string name);

  const std::vector<Part>& parts() const { return parts_; }
  std::size_t facesWithoutArea() const { return facesWithoutArea_; }
  Mesh meshOf(const Part& part) const;

 private:
  // The surface of what tinyobjloader calls back for every statement; `self` is the Geometry.
  struct Callbacks;

  std::optional<glm::vec3> normalOf(const Corner& corner) const;
  int resolved(int index, std::size_t count, const char* what) const;
  void addFace(std::span<const tinyobj::index_t> indices);
  Part& currentPart();

  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::vector<Part> parts_;
  std::map<std::pair<std::string, std::string>, std::size_t> partIndices_;
  std::string name_, material_;
  std::size_t faces_ = 0, facesWithoutArea_ = 0;
};

}  // namespace pb::obj
