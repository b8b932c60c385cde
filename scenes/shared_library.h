// Libraries that are loaded when they are first needed, as loading them would make every command start late.
#pragma once

#include <string>

namespace pb {

// Found as the dynamic linker finds a program's libraries: in LD_LIBRARY_PATH, then in the program's RUNPATH
// (CMAKE_INSTALL_RPATH), then in the system's folders (ld.so(8)); so it may be another than the one that was built.
// Stays loaded until the process ends, so that what it made may outlive this object.
class SharedLibrary {
 public:
  // Throws an environment Error when it is missing or lacks libraries of its own.
  explicit SharedLibrary(const std::string& fileName);

  std::string path() const;  // where it was found

  // A function or constant of the library by its C name; throws an environment Error when it has none of that name.
  template <class T>
  T* symbol(const char* name) const {
    return reinterpret_cast<T*>(address(name));
  }

 private:
  void* address(const char* name) const;

  std::string fileName_;
  void* handle_;
};

}  // namespace pb
