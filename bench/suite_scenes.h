// The scenes of a suite file.
#pragma once

#include <string>
#include <vector>

#include "bench/suite.h"
#include "bench/toml_reader.h"

namespace pb {

// Reads [[scene]]. folder: of the suite, to which paths are relative. tolerance: the suite's, which scenes begin with.
// Throws input Errors.
std::vector<SuiteScene> readScenes(TomlReader& suite, const std::string& folder, const ToleranceLevels& tolerance);

}  // namespace pb
