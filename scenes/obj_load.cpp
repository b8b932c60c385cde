#include "scenes/obj_load.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <new>
#include <set>
#include <span>
#include <sstream>
#include <tuple>
#include <utility>

#include "scenes/closed_mesh.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/image_io.h"
#include "scenes/polygon.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr std::size_t kMaxCorners = 4096;  // of a face: triangulation takes up to their cube of steps
constexpr float kLargestIor = 5.0f;        // as of glTF's materials

template <class Action>
auto atPlace(const std::string& place, const Action& action) {
  try {
    return action();
  } catch (const Error& e) {
    throw Error(e.kind(), place + ": " + e.what());
  }
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t length = std::min(line.find_first_of(" \t\r"), line.size());
    result.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
  return result;
}

// Calls visit(line number, line without its end).
template <class Visit>
void forEachLine(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    visit(number, text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
}

// Statements that consist of numbers, and how many there are at least.
using Numeric = std::map<std::string_view, std::size_t>;
const Numeric kObjNumbers = {{"v", 3}, {"vn", 3}, {"vt", 1}};
const Numeric kMtlNumbers = {{"Ka", 1}, {"Kd", 1}, {"Ks", 1}, {"Ke", 1}, {"Tf", 1}, {"Ns", 1},
                             {"Ni", 1}, {"d", 1},  {"Tr", 1}, {"Pm", 1}, {"Pr", 1}, {"illum", 1}};

bool isNumber(std::string_view word) { return parseNumber(word.starts_with('+') ? word.substr(1) : word).has_value(); }

// tinyobjloader takes what is no number for 0.
void checkNumbers(std::string_view text, const Numeric& statements) {
  forEachLine(text, [&](std::size_t number, std::string_view line) {
    std::vector<std::string_view> w = words(line);
    const auto found = w.empty() ? statements.end() : statements.find(w.front());
    if (found == statements.end()) return;
    const auto end = std::ranges::find_if(w, [](std::string_view word) { return word.starts_with('#'); });
    if (static_cast<std::size_t>(end - w.begin()) <= found->second || !std::all_of(w.begin() + 1, end, isNumber))
      throwInputError("line {}: '{}' wants {} or more finite numbers, got '{}'", number, w.front(), found->second,
                      trimmed(line));
  });
}

void checkFaces(std::string_view text) {
  forEachLine(text, [](std::size_t number, std::string_view line) {
    const std::vector<std::string_view> w = words(line);
    if (w.empty() || w.front() != "f") return;
    for (std::size_t i = 1; i < w.size() && !w[i].starts_with('#'); ++i)
      if (w[i].find_first_not_of("0123456789-/") != w[i].npos || w[i].starts_with('/'))
        throwInputError("line {}: faces consist of indices such as 1, 1/2, 1//3 or 1/2/3, got '{}'", number, w[i]);
  });
}

// A material of a library, and which of its statements were there.
struct MtlMaterial {
  tinyobj::material_t values;
  std::set<std::string, std::less<>> statements;

  bool has(std::string_view statement) const { return statements.contains(statement); }
};
using MtlMaterials = std::map<std::string, MtlMaterial, std::less<>>;

void readLibrary(const std::string& path, MtlMaterials& materials) {
  const std::string text = readFile(path);
  atPlace(path, [&] { checkNumbers(text, kMtlNumbers); });
  std::map<std::string, int> indices;
  std::vector<tinyobj::material_t> values;
  std::string warning, error;
  std::istringstream stream(text);
  tinyobj::LoadMtl(&indices, &values, &stream, &warning, &error);
  for (const tinyobj::material_t& v : values) materials.try_emplace(std::string(trimmed(v.name)), MtlMaterial{v, {}});
  MtlMaterial* current = nullptr;
  forEachLine(text, [&](std::size_t, std::string_view line) {
    const std::vector<std::string_view> w = words(line);
    if (w.empty()) return;
    if (w.front() == "newmtl") {
      const auto found = materials.find(trimmed(trimmed(line).substr(w.front().size())));
      current = found == materials.end() ? nullptr : &found->second;
    } else if (current != nullptr) {
      current->statements.emplace(w.front());
    }
  });
}

// The rest of the line is one name, which may hold spaces, or several.
void readLibraries(std::string_view text, const std::filesystem::path& folder, MtlMaterials& materials) {
  std::set<std::string> read;
  const auto readOnce = [&](const std::filesystem::path& path) {
    if (read.insert(path.string()).second) readLibrary(path.string(), materials);
  };
  forEachLine(text, [&](std::size_t, std::string_view line) {
    const std::vector<std::string_view> w = words(line);
    if (w.size() < 2 || w.front() != "mtllib") return;
    const std::filesystem::path whole = folder / trimmed(trimmed(line).substr(w.front().size()));
    if (std::filesystem::exists(whole)) return readOnce(whole);
    for (std::size_t i = 1; i < w.size(); ++i) readOnce(folder / w[i]);
  });
}

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

// What tinyobjloader calls back for every statement.
class Geometry {
 public:
  void read(const std::string& text, std::string name) {
    name_ = std::move(name);
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, float x, float y, float z, float) {
      of(self).positions_.emplace_back(x, y, z);
    };
    callbacks.normal_cb = [](void* self, float x, float y, float z) { of(self).normals_.emplace_back(x, y, z); };
    callbacks.texcoord_cb = [](void* self, float u, float v, float) { of(self).uvs_.emplace_back(u, 1.0f - v); };
    callbacks.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
      of(self).addFace({indices, static_cast<std::size_t>(count)});
    };
    callbacks.usemtl_cb = [](void* self, const char* material, int) { of(self).material_ = trimmed(material); };
    callbacks.object_cb = [](void* self, const char* object) { of(self).name_ = trimmed(object); };
    callbacks.group_cb = [](void* self, const char** names, int count) {
      if (count > 0) of(self).name_ = fmt::format("{}", fmt::join(names, names + count, " "));
    };
    std::istringstream stream(text);
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
  }

  const std::vector<Part>& parts() const { return parts_; }
  std::size_t facesWithoutArea() const { return facesWithoutArea_; }

  Mesh meshOf(const Part& part) const {
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

 private:
  static Geometry& of(void* self) { return *static_cast<Geometry*>(self); }

  // Unit; none where the file has none, or one of length 0.
  std::optional<glm::vec3> normalOf(const Corner& corner) const {
    if (corner.normal < 0) return std::nullopt;
    const glm::dvec3 normal = normals_[static_cast<std::size_t>(corner.normal)];
    const double length = glm::length(normal);
    if (!(length > 0.0)) return std::nullopt;
    return glm::vec3(normal / length);
  }

  // Written indices count from 1, or from the end of what was there by then if they are negative; 0 is absence.
  int resolved(int index, std::size_t count, const char* what) const {
    if (index == 0) return -1;
    const std::int64_t n = static_cast<std::int64_t>(count), i = index > 0 ? index - std::int64_t{1} : n + index;
    if (i < 0 || i >= n) throwInputError("face {} wants {} {} of {} before it", faces_, what, index, count);
    return static_cast<int>(i);
  }

  void addFace(std::span<const tinyobj::index_t> indices) {
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

  Part& currentPart() {
    const auto [found, isNew] = partIndices_.try_emplace({name_, material_}, parts_.size());
    if (isNew) parts_.push_back({name_, material_, {}});
    return parts_[found->second];
  }

  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::vector<Part> parts_;
  std::map<std::pair<std::string, std::string>, std::size_t> partIndices_;
  std::string name_, material_;
  std::size_t faces_ = 0, facesWithoutArea_ = 0;
};

// How light goes on, by the illumination model (Wavefront's "Object Files" appendix B1) or by Pm and Pr.
struct Optics {
  bool transmits, refracts, isMetal;
};
Optics opticsOf(const MtlMaterial& m) {
  const int illum = m.values.illum;
  const bool isPbr = m.has("Pm") || m.has("Pr");
  return {.transmits = illum == 4 || illum == 6 || illum == 7 || illum == 9,
          .refracts = illum == 6 || illum == 7,
          .isMetal = !isPbr && (illum == 3 || illum == 5 || illum == 8)};
}

// Turns materials of .mtl files into ours.
class Materials {
 public:
  Materials(MtlMaterials source, std::filesystem::path folder, Scene& scene)
      : source_(std::move(source)), folder_(std::move(folder)), scene_(scene) {}

  // The scene's material of that name, made when first wanted by a mesh of these bounds.
  int indexOf(const std::string& name, const Bounds& bounds) {
    const auto [found, isNew] = indices_.try_emplace(name, static_cast<int>(scene_.materials.size()));
    if (!isNew) return found->second;
    scene_.materials.push_back(make(name, bounds));
    return found->second;
  }

 private:
  Material make(const std::string& name, const Bounds& bounds) {
    const auto found = source_.find(name);
    if (found == source_.end()) {
      if (!name.empty()) warn(name, "is in none of the file's libraries, grey stands for it");
      return twoSided(makeDiffuseMaterial(name.empty() ? "default" : name, glm::vec3(0.8f)));
    }
    const MtlMaterial& m = found->second;
    Material material = opticsOf(m).transmits ? makeGlass(name, m, bounds) : makeOpaque(name, m);
    material.constants.emission = glm::vec4(glm::max(vector(m.values.emission), glm::vec3(0.0f)), 1.0f);
    warnOfIgnored(name, m);
    return material;
  }

  static Material twoSided(Material material) {
    material.doubleSided = true;
    return material;
  }

  static glm::vec3 vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

  glm::vec3 reflectance(const std::string& name, const char* statement, const float (&v)[3]) {
    const glm::vec3 value = vector(v), cut = glm::clamp(value, glm::vec3(0.0f), glm::vec3(1.0f));
    if (cut != value) warn(name, fmt::format("{} is from 0 to 1, what exceeds that is cut", statement));
    return cut;
  }

  // Blender's exporter and importer take Ns for 1000 (1 - roughness)^2.
  static float roughnessOf(const MtlMaterial& m, float otherwise) {
    if (m.has("Pr")) return glm::clamp(m.values.roughness, 0.0f, 1.0f);
    if (m.has("Ns")) return 1.0f - std::sqrt(glm::clamp(m.values.shininess / 1000.0f, 0.0f, 1.0f));
    return otherwise;
  }

  Material makeGlass(const std::string& name, const MtlMaterial& m, const Bounds& bounds) {
    const bool refracts = opticsOf(m).refracts;
    const float ior = m.has("Ni") && m.values.ior > 1.0f ? std::min(m.values.ior, kLargestIor) : 1.5f;
    const glm::vec3 size = bounds.extent();
    Material material = makeGlassMaterial(name, ior, refracts ? std::min({size.x, size.y, size.z}) : 0.0f);
    material.constants.factors.y = roughnessOf(m, 0.0f);
    if (m.has("Tf")) material.constants.baseColor = glm::vec4(reflectance(name, "Tf", m.values.transmittance), 1.0f);
    material.doubleSided = !refracts;
    return material;
  }

  Material makeOpaque(const std::string& name, const MtlMaterial& m) {
    Material material = twoSided(makeDiffuseMaterial(name, baseColor(name, m)));
    shading::MaterialConstants& c = material.constants;
    const bool isPbr = m.has("Pm") || m.has("Pr"), isMetal = opticsOf(m).isMetal;
    c.factors.x = isMetal ? 1.0f : isPbr ? glm::clamp(m.values.metallic, 0.0f, 1.0f) : 0.0f;
    c.factors.y = roughnessOf(m, isMetal ? 0.0f : 0.5f);
    c.specular.w = isPbr ? 1.0f : coatOf(m);
    setKind(material);
    if (!m.values.diffuse_texname.empty()) addTexture(m.values, material);
    addCoverage(m, material);
    return material;
  }

  glm::vec3 baseColor(const std::string& name, const MtlMaterial& m) {
    const glm::vec3 ks = reflectance(name, "Ks", m.values.specular);
    if (opticsOf(m).isMetal && ks != glm::vec3(0.0f)) return ks;
    if (m.has("Kd")) return reflectance(name, "Kd", m.values.diffuse);
    return glm::vec3(m.values.diffuse_texname.empty() ? 0.8f : 1.0f);
  }

  // A Ks of 0.5 is what Blender writes for a dielectric of index 1.5.
  static float coatOf(const MtlMaterial& m) {
    const bool hasHighlights = !m.has("illum") || m.values.illum >= 2;
    const glm::vec3 ks = vector(m.values.specular);
    return hasHighlights ? glm::clamp(2.0f * (ks.x + ks.y + ks.z) / 3.0f, 0.0f, 1.0f) : 0.0f;
  }

  static void setKind(Material& material) {
    shading::MaterialConstants& c = material.constants;
    if (c.factors.x == 1.0f && shading::ggxAlpha(c.factors.y) == 0.0f)
      c.kind.x = shading::kSurfaceMirror;
    else if (c.factors.x > 0.0f || c.specular.w > 0.0f)
      c.kind.x = shading::kSurfaceGlossy;
    material.isSpecularDominant = c.factors.x > 0.5f && c.factors.y < kSmoothRoughness;
  }

  // Texture coordinates were turned upside down: scale and offset, too.
  void addTexture(const tinyobj::material_t& values, Material& material) {
    const tinyobj::texture_option_t& options = values.diffuse_texopt;
    const glm::vec2 scale(options.scale[0], options.scale[1]);
    shading::TextureSlot& slot = material.constants.baseColorSlot;
    slot.matrix = {scale.x, 0.0f, 0.0f, scale.y};
    slot.offset = {options.origin_offset[0], 1.0f - scale.y - options.origin_offset[1], 0.0f, 1.0f};
    const float wrap = options.clamp ? shading::kWrapClamp : shading::kWrapRepeat;
    slot.sampler_ = {wrap, wrap, shading::kFilterLinear, shading::kFilterLinearMipLinear};
    material.baseColorTexture = textureOf(values.diffuse_texname);
  }

  int textureOf(std::string file) {
    std::ranges::replace(file, '\\', '/');
    const auto [found, isNew] = textures_.try_emplace(file, static_cast<int>(scene_.textures.size()));
    if (!isNew) return found->second;
    LoadedImage image = readImage((folder_ / file).string());
    if (image.encoding == Encoding::srgb)
      for (glm::vec4& p : image.pixels) p = {linearFromSrgb(p.x), linearFromSrgb(p.y), linearFromSrgb(p.z), p.w};
    scene_.textures.push_back(makeTexture(file, std::move(image.pixels)));
    return found->second;
  }

  static void addCoverage(const MtlMaterial& m, Material& material) {
    const bool isTextured = !m.values.alpha_texname.empty() && m.values.alpha_texname == m.values.diffuse_texname;
    material.constants.baseColor.w = glm::clamp(m.values.dissolve, 0.0f, 1.0f);
    if (isTextured || material.constants.baseColor.w < 1.0f) material.constants.alpha.x = shading::kAlphaBlend;
  }

  void warnOfIgnored(const std::string& name, const MtlMaterial& m) {
    for (const char* statement : {"map_Ks", "map_Ns", "map_Ke", "map_Pr", "map_Pm", "map_Bump", "map_bump", "bump",
                                  "norm", "disp", "refl", "Pc", "Ps", "aniso"})
      if (m.has(statement)) warn(name, fmt::format("{} is ignored", statement));
    if (m.has("map_d") && m.values.alpha_texname != m.values.diffuse_texname)
      warn(name, "map_d is ignored: it is not the image of map_Kd");
  }

  void warn(const std::string& material, const std::string& what) {
    scene_.warnings.push_back(fmt::format("material '{}': {}", material, what));
  }

  MtlMaterials source_;
  std::filesystem::path folder_;
  Scene& scene_;
  std::map<std::string, int> indices_;
  std::map<std::string, int> textures_;
};

void addParts(const Geometry& geometry, Materials& materials, Scene& scene) {
  std::map<std::string, int> nodes;
  for (const Part& part : geometry.parts()) {
    const auto mesh = finishMesh(geometry.meshOf(part));
    if (mesh->triangleCount() == 0) {
      scene.warnings.push_back(fmt::format("'{}' is left out: its triangles have no area", part.name));
      continue;
    }
    const auto [node, isNew] = nodes.try_emplace(part.name, static_cast<int>(scene.nodes.size()));
    if (isNew) scene.nodes.emplace_back().name = part.name;
    scene.instances.push_back({part.name, node->second, mesh, materials.indexOf(part.material, mesh->bounds)});
  }
  if (geometry.facesWithoutArea() > 0)
    scene.warnings.push_back(fmt::format("{} faces without area are left out", geometry.facesWithoutArea()));
  if (scene.instances.empty()) throwInputError("the file draws no triangle");
}

Scene buildScene(const std::filesystem::path& path, const std::string& text,
                 const std::optional<Environment>& environment) {
  checkNumbers(text, kObjNumbers);
  checkFaces(text);
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  MtlMaterials libraries;
  readLibraries(text, folder, libraries);
  Scene scene;
  scene.name = path.stem().string();
  Geometry geometry;
  geometry.read(text, scene.name);
  Materials materials(std::move(libraries), folder, scene);
  addParts(geometry, materials, scene);
  scene.environment = environment ? *environment : makeProceduralSky();
  if (!environment) scene.notes.emplace_back("no light and no environment in the file: added the procedural sky");
  finishScene(scene);
  warnOfOpenGlass(scene);
  return scene;
}

}  // namespace

Scene loadObj(const std::string& path, const std::optional<Environment>& environment) {
  const std::string text = readFile(path);
  return atPlace(path, [&] {
    try {
      return buildScene(path, text, environment);
    } catch (const std::bad_alloc&) {
      throwInputError("the scene doesn't fit into memory");
    }
  });
}

}  // namespace pb
