#include "bench/version.h"

#include <fmt/chrono.h>
#include <meshoptimizer.h>
#include <tbb/version.h>

#include <ctime>
#include <fstream>
#include <glm/detail/setup.hpp>

#include "bench/git_hash.h"
#include "reference/renderer.h"

namespace pb {

std::string toolVersion() { return PROBEBENCH_VERSION; }

std::string gitHash() { return PROBEBENCH_GIT_HASH; }

std::map<std::string, std::string> libraryVersions() {
  return {{"Embree", embreeVersion()},
          {"Google Benchmark", PROBEBENCH_BENCHMARK_VERSION},
          {"OpenImageIO", PROBEBENCH_OPENIMAGEIO_VERSION},
          {"TBB", TBB_runtime_version()},
          {"compiler", __VERSION__},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"meshoptimizer", fmt::format("{}.{}", MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100)},
          {"glm", fmt::format("{}.{}.{}", GLM_VERSION_MAJOR, GLM_VERSION_MINOR, GLM_VERSION_PATCH)}};
}

std::string cpuName() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
  return "unknown";
}

std::string timestamp() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace pb
