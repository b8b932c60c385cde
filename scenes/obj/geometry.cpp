#include "scenes/obj/geometry.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <sstream>

#include "scenes/error.h"
#include "scenes/obj/statements.h"
#include "scenes/polygon.h"

namespace pb::obj {
namespace {

constexpr std::size_t kMaxCorners = 4096;  // of a face: triangulation takes up to their cube of steps

}  // namespace

// What tinyobjloader calls back for every statement, with the Geometry as `self`.
struct Geometry::Callbacks : tinyobj::callback_t {
  Callbacks() {
    vertex_cb = [](void* self, float x, float y, float z, float) { of(self).positions_.emplace_back(x, y, z); };
    normal_cb = [](void* self, float x, float y, float z) { of(self).normals_.emplace_back(x, y, z); };
    texcoord_cb = [](void* self, float u, float v, float) { of(self).uvs_.emplace_back(u, 1.0f - v); };
    index_cb = [](void* self, tinyobj::index_t* indices, int count) {
      of(self).addFace({indices, static_cast<std::size_t>(count)});
    };
    usemtl_cb = [](void* self, const char* material, int) { of(self).material_ = trimmed(material); };
    object_cb = [](void* self, const char* object) { of(self).name_ = trimmed(object); };
    group_cb = [](void* self, const char** names, int count) {
      if (count > 0) of(self).name_ = fmt::format("{}", fmt::join(names, names + count, " "));
    };
  }
  static Geometry& of(void* self) { return *static_cast<Geometry*>(self); }
};

Geometry::Geometry(const std::string& text, std::string name) : name_(std::move(name)) {
  std::istringstream stream(text);
  tinyobj::LoadObjWithCallback(stream, Callbacks(), this);
}

Mesh Geometry::meshOf(const Part& part) const {
  Mesh mesh;
  mesh.name = part.name;
  const bool hasNormals = std::ranges::all_of(part.corners, [&](const Corner& c) { return normalOf(c).has_value(); });
  const bool hasUvs = std::ranges::any_of(part.corners, [](const Corner& c) { return c.uv >= 0; });
  std::map<Corner, std::uint32_t> vertices;
  for (const Corner& c : part.corners) {
    const auto [found, isNew] = vertices.try_emplace(c, static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.indices.push_back(found->second);
    if (!isNew) continue;
    mesh.positions.push_back(positions_[static_cast<std::size_t>(c.position)]);
    if (hasNormals) mesh.normals.push_back(*normalOf(c));
    if (hasUvs) mesh.uvs[0].push_back(c.uv < 0 ? glm::vec2(0.0f) : uvs_[static_cast<std::size_t>(c.uv)]);
  }
  return mesh;
}

// Unit; none where the file has none, or one of length 0.
std::optional<glm::vec3> Geometry::normalOf(const Corner& corner) const {
  if (corner.normal < 0) return std::nullopt;
  const glm::dvec3 normal = normals_[static_cast<std::size_t>(corner.normal)];
  const double length = glm::length(normal);
  if (!(length > 0.0)) return std::nullopt;
  return glm::vec3(normal / length);
}

// Written indices count from 1, or from the end of what was there by then if they are negative; 0 is absence.
int Geometry::resolved(int index, std::size_t count, const char* what) const {
  if (index == 0) return -1;
  const std::int64_t n = static_cast<std::int64_t>(count), i = index > 0 ? index - std::int64_t{1} : n + index;
  if (i < 0 || i >= n) throwInputError("face {} wants {} {} of {} before it", faces_, what, index, count);
  return static_cast<int>(i);
}

void Geometry::addFace(std::span<const tinyobj::index_t> indices) {
  ++faces_;
  if (indices.size() < 3 || indices.size() > kMaxCorners)
    throwInputError("face {} wants 3 to {} corners, got {}", faces_, kMaxCorners, indices.size());
  std::vector<Corner> corners;
  std::vector<glm::vec3> positions;
  for (const tinyobj::index_t& i : indices) {
    if (i.vertex_index == 0) throwInputError("face {} wants vertices from 1 on, got 0", faces_);
    corners.push_back({resolved(i.vertex_index, positions_.size(), "vertex"),
                       resolved(i.texcoord_index, uvs_.size(), "texture coordinate"),
                       resolved(i.normal_index, normals_.size(), "normal")});
    positions.push_back(positions_[static_cast<std::size_t>(corners.back().position)]);
  }
  const auto triangles = triangulate(positions);
  if (triangles.empty()) ++facesWithoutArea_;
  for (const auto& triangle : triangles)
    for (const std::uint32_t k : triangle) currentPart().corners.push_back(corners[k]);
}

Part& Geometry::currentPart() {
  const auto [found, isNew] = partIndices_.try_emplace({name_, material_}, parts_.size());
  if (isNew) parts_.push_back({name_, material_, {}});
  return parts_[found->second];
}

}  // namespace pb::obj
