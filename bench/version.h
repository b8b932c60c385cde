// What this program is made of, for --version and for the circumstances of results.
#pragma once

#include <map>
#include <string>

namespace pb {

std::string toolVersion();
std::string gitHash();  // of the source tree at build time, "unknown" outside of git, with "+" if it was changed

// Name -> version of the libraries that take part in numbers.
std::map<std::string, std::string> libraryVersions();

std::string cpuName();

// Now, UTC, ISO 8601.
std::string timestamp();

}  // namespace pb
