// A folder that one process at a time may work in.
#pragma once

#include <filesystem>

namespace pb {

// Holds the folder until the object's end, or the process's, however that ends: nothing is left behind in the folder.
class FolderLock {
 public:
  // Throws an environment Error where somebody else holds the folder. File systems without locks let everybody in.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace pb
