// Whole files as text or bytes, with errors that name the file; folders for a while.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pb {

// The bytes of the file. Throws an input Error when it can't be read.
std::string readFile(const std::string& path);

// Writes a temporary file beside `path` and renames it, so that the file is complete or as it was before. Symbolic
// links are followed; what is no regular file (a pipe, /dev/stdout) is written in place. Throws an environment Error
// and leaves nothing behind when that fails. Safe from several threads and processes: the last one wins.
void writeFileAtomically(const std::string& path, std::string_view bytes);

// A fresh folder among the system's temporary ones, removed at its end with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws an environment Error when it can't be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace pb
