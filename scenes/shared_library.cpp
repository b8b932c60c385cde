#include "scenes/shared_library.h"

#include <dlfcn.h>
#include <link.h>

#include "scenes/error.h"

namespace pb {

// All symbols at once: what is missing shows here and not in the middle of a run.
SharedLibrary::SharedLibrary(const std::string& fileName)
    : fileName_(fileName), handle_(dlopen(fileName.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) throwEnvironmentError("the library '{}' can't be loaded: {}", fileName, dlerror());
}

std::string SharedLibrary::path() const {
  const link_map* map = nullptr;
  return dlinfo(handle_, RTLD_DI_LINKMAP, &map) == 0 ? map->l_name : fileName_;
}

void* SharedLibrary::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (found == nullptr) throwEnvironmentError("the library '{}' has no '{}'", fileName_, name);
  return found;
}

}  // namespace pb
