// Checks of a glTF document's JSON before anything is read from it.
#pragma once

#include <nlohmann/json.hpp>

namespace pb::gltf {

// Types, required members, number ranges and the range of every index that the loader follows, and that each node has
// at most one parent and descends from a root. Throws an input Error naming the place ("accessors/3/count").
void validate(const nlohmann::json& document);

// Refuses versions other than 2 and required extensions that the loader doesn't know, by name.
void checkRequirements(const nlohmann::json& document);

// True for extensions that the loader reads.
bool isSupportedExtension(const std::string& name);

}  // namespace pb::gltf
