#include "scenes/obj/library.h"

#include <sstream>
#include <utility>
#include <vector>

#include "scenes/files.h"
#include "scenes/obj/statements.h"
#include "scenes/place.h"

namespace pb::obj {
namespace {

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

}  // namespace

// The rest of the line is one name, which may hold spaces, or several.
MtlMaterials readLibraries(std::string_view text, const std::filesystem::path& folder) {
  MtlMaterials materials;
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
  return materials;
}

}  // namespace pb::obj
