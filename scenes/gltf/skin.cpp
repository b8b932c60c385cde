#include "scenes/gltf/skin.h"

#include <cmath>

#include "scenes/error.h"
#include "scenes/gltf/accessor.h"

namespace pb::gltf {
namespace {

void checkAffine(const std::vector<glm::mat4>& matrices) {
  for (std::size_t i = 0; i < matrices.size(); ++i)
    for (int column = 0; column < 4; ++column) {
      if (matrices[i][column].w != (column == 3 ? 1.0f : 0.0f))
        throwInputError("inverse bind matrix {} is not affine", i);
      for (int row = 0; row < 3; ++row)
        if (!(std::abs(matrices[i][column][row]) <= kLargestTransform))
          throwInputError("inverse bind matrix {} wants numbers from -{:g} to {:g}, got {:g}", i, kLargestTransform,
                          kLargestTransform, matrices[i][column][row]);
    }
}

// Without matrices of its own a skin is bound where its joints have no transform (glTF 2.0, section 5.28.1).
std::vector<glm::mat4> readInverseBindMatrices(const Document& document, const tinygltf::Skin& skin) {
  if (skin.inverseBindMatrices < 0) return std::vector<glm::mat4>(skin.joints.size(), glm::mat4(1.0f));
  std::vector<glm::mat4> matrices = readMatrices(document, skin.inverseBindMatrices);
  if (matrices.size() < skin.joints.size())
    throwInputError("{} inverse bind matrices for {} joints", matrices.size(), skin.joints.size());
  matrices.resize(skin.joints.size());
  checkAffine(matrices);
  return matrices;
}

Skin readSkin(const Document& document, std::size_t index, std::span<const int> sceneNodes) {
  const tinygltf::Skin& source = document.model.skins[index];
  return atPlace("skin " + label(source.name, index), [&] {
    Skin skin;
    skin.name = source.name.empty() ? fmt::format("skin {}", index) : source.name;
    if (source.joints.empty()) throwInputError("a skin has at least one joint");
    for (const int joint : source.joints) {
      skin.joints.push_back(sceneNodes[static_cast<std::size_t>(joint)]);
      if (skin.joints.back() < 0) throwInputError("joints are nodes of the scene, node {} is none", joint);
    }
    skin.inverseBindMatrices = readInverseBindMatrices(document, source);
    return skin;
  });
}

}  // namespace

void readSkins(const Document& document, std::span<const int> sceneNodes, Scene& scene) {
  std::vector<int> indices(document.model.skins.size(), -1);
  for (std::size_t n = 0; n < sceneNodes.size(); ++n) {
    const int skin = document.model.nodes[n].skin;
    if (sceneNodes[n] < 0 || skin < 0 || document.model.nodes[n].mesh < 0) continue;
    int& index = indices[static_cast<std::size_t>(skin)];
    if (index < 0) {
      index = static_cast<int>(scene.skins.size());
      scene.skins.push_back(readSkin(document, static_cast<std::size_t>(skin), sceneNodes));
    }
    scene.nodes[static_cast<std::size_t>(sceneNodes[n])].skin = index;
  }
}

}  // namespace pb::gltf
