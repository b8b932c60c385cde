#include "bench/platform.h"

#include <fmt/format.h>

namespace pb {

std::vector<PlatformDifference> platformDifferences(const Provenance& before, const Provenance& after) {
  std::vector<PlatformDifference> differences;
  const auto compare = [&](const std::string& what, const std::string& old, const std::string& now) {
    if (old != now) differences.push_back({what, old, now});
  };
  compare("GL renderer", before.glRenderer, after.glRenderer);
  compare("GL driver", before.glVersion, after.glVersion);
  for (const auto& [library, version] : before.libraries)
    if (const auto found = after.libraries.find(library); found != after.libraries.end())
      compare(library, version, found->second);
  return differences;
}

bool sameDriver(const Provenance& a, const Provenance& b) {
  return a.glRenderer == b.glRenderer && a.glVersion == b.glVersion;
}

std::string describe(const std::vector<PlatformDifference>& differences) {
  std::string text;
  for (const auto& [what, before, after] : differences)
    text += fmt::format("{}{} is '{}', was '{}'", text.empty() ? "" : "; ", what, after, before);
  return text;
}

}  // namespace pb
