#include "raster/refresh/policies.h"

namespace pb {
namespace {

RefreshPolicy::Function make(const Spec& spec) {
  policyReader(spec).finish();
  // The first capture, due under any policy, is the only one.
  return [](const RefreshHistory&, const Snapshot&) { return std::vector<ProbeFace>{}; };
}

}  // namespace

RefreshPolicy staticPolicy() {
  return {.name = "static",
          .parameters = "",
          .description = "Captures all faces once, in the first frame.",
          .source = "Unity: Refresh Mode 'On awake'",
          .make = make,
          .cycle = [](const Spec&, int) { return 1; }};
}

}  // namespace pb
