#include "scenes/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include "scenes/error.h"

namespace pb {
namespace {

std::string reason(int errorNumber) { return std::generic_category().message(errorNumber); }

// Owns a file descriptor. close() reports what the destructor must ignore: some file systems say "full" only then.
class File {
 public:
  File(const std::string& path, int flags, mode_t mode = 0)
      : descriptor_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool isOpen() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  bool close() { return descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

bool writeAll(const File& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.descriptor(), bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Returns the error number of the first step that failed, 0 for none. fsync before rename: otherwise a power cut may
// leave the new name with no content.
int writeNewFile(const std::string& path, std::string_view bytes, bool durable) {
  const int flags = durable ? O_WRONLY | O_CREAT | O_TRUNC : O_WRONLY;
  File file(path, flags, 0666);
  if (!file.isOpen() || !writeAll(file, bytes) || (durable && ::fsync(file.descriptor()) != 0) || !file.close())
    return errno;
  return 0;
}

std::string temporaryNameBeside(const std::string& path) {
  static std::atomic<unsigned> count{0};
  return fmt::format("{}.{}-{}.tmp", path, ::getpid(), count++);
}

// What `path` leads to, so that a rename replaces the file and not a link to it.
std::string withoutLinks(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path resolved = std::filesystem::canonical(path, ignored);
  return resolved.empty() ? path : resolved.string();
}

bool existsAndIsNoRegularFile(const std::string& path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

}  // namespace

std::string readFile(const std::string& path) {
  const File file(path, O_RDONLY);
  if (!file.isOpen()) throwInputError("can't read '{}': {}", path, reason(errno));
  std::string bytes;
  std::array<char, 1 << 16> chunk;
  for (;;) {
    const ssize_t count = ::read(file.descriptor(), chunk.data(), chunk.size());
    if (count == 0) return bytes;
    if (count > 0) bytes.append(chunk.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) throwInputError("can't read '{}': {}", path, reason(errno));
  }
}

void writeFileAtomically(const std::string& path, std::string_view bytes) {
  const auto check = [&](int errorNumber) {
    if (errorNumber != 0) throwEnvironmentError("can't write '{}': {}", path, reason(errorNumber));
  };
  if (existsAndIsNoRegularFile(path)) return check(writeNewFile(path, bytes, false));

  const std::string target = withoutLinks(path);
  const std::string temporary = temporaryNameBeside(target);
  int failure = writeNewFile(temporary, bytes, true);
  if (failure == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) failure = errno;
  if (failure != 0) ::unlink(temporary.c_str());
  check(failure);
}

TemporaryFolder::TemporaryFolder() {
  const auto parent = std::filesystem::temp_directory_path();
  std::string name = (parent / "probebench-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throwEnvironmentError("can't make a temporary folder in '{}': {}", parent.string(), reason(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // what can't be removed, as a program has locked it, stays behind
  std::filesystem::permissions(path_, std::filesystem::perms::owner_all, std::filesystem::perm_options::add, ignored);
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace pb
