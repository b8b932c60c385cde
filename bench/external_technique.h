// Techniques of other programs, as the [[external]] tables of a suite state them. Format: docs/external.md.
#pragma once

#include <string>
#include <vector>

#include "bench/toml_reader.h"

namespace pb {

struct ExternalTechnique {
  std::string name;  // letters, digits and . _ -: stands in keys and file names
  // Program and arguments; the path of the job comes last. Empty for pictures that were made earlier.
  std::vector<std::string> command;
  std::string images;  // pattern of those pictures' files, see pictureFile(); empty with a command
  std::string timing;  // the file with their times, a pattern too; empty for none
  int timeoutS = 600;
  std::string settings = "{}";  // what the suite tells the program, a JSON object on one line
  std::string canonical;        // all of this as the suite spells it, without the time-out
};

// Reads all [[external]] tables. Relative paths are relative to `folder`, the suite's, for which {suite} stands in
// arguments. Throws input Errors.
std::vector<ExternalTechnique> readExternalTechniques(TomlReader& suite, const std::string& folder);

// What a pattern's placeholders stand for.
struct PictureName {
  std::string scene;  // Scene::name
  std::string camera;
  std::size_t number = 0;  // of the scene in the suite, from 0
  int frame = 0;
};

// The pattern with {scene}, {camera}, {number} and {frame} replaced; {frame:05} has at least five digits.
std::string pictureFile(const std::string& pattern, const PictureName& name);

}  // namespace pb
