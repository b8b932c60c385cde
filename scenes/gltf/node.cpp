#include "scenes/gltf/node.h"

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "scenes/error.h"
#include "scenes/gltf/extras.h"

namespace pb::gltf {
namespace {

glm::vec3 vec3Of(const std::vector<double>& v) { return glm::vec3(glm::make_vec3(v.data())); }

glm::mat4 affineMatrix(const std::vector<double>& values) {
  const glm::mat4 matrix(glm::make_mat4(values.data()));
  if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f)
    throwInputError("a node's matrix is affine, got the last row {} {} {} {}", matrix[0].w, matrix[1].w, matrix[2].w,
                    matrix[3].w);
  return matrix;
}

void readTransform(const tinygltf::Node& source, Node& node) {
  if (!source.matrix.empty()) node.matrix = affineMatrix(source.matrix);
  if (!source.translation.empty()) node.translation = vec3Of(source.translation);
  if (!source.scale.empty()) node.scale = vec3Of(source.scale);
  if (source.rotation.empty()) return;
  const glm::vec4 q = unitQuaternion(glm::vec4(glm::make_vec4(source.rotation.data())));
  node.rotation = {q.w, q.x, q.y, q.z};
}

// The node's own weights, else its mesh's (glTF 2.0, section 3.7.2.2).
void readMorphWeights(const tinygltf::Model& model, const tinygltf::Node& source, Node& node) {
  if (source.mesh < 0) return;
  const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(source.mesh)];
  const std::vector<double>& weights = source.weights.empty() ? mesh.weights : source.weights;
  for (const double weight : weights) node.morphWeights.push_back(static_cast<float>(weight));
}

std::string nameOf(const Document& document, std::size_t node) {
  const std::string& name = document.model.nodes[node].name;
  return name.empty() ? fmt::format("node {}", node) : name;
}

float kindOf(const std::string& type) {
  static const std::map<std::string, float> kKinds = {
      {"directional", shading::kLightDirectional}, {"point", shading::kLightPoint}, {"spot", shading::kLightSpot}};
  const auto kind = kKinds.find(type);
  if (kind == kKinds.end()) throwInputError("lights are directional, point or spot, got '{}'", type);
  return kind->second;
}

PunctualLight lightOf(const tinygltf::Light& source) {
  PunctualLight light;
  light.kind = kindOf(source.type);
  light.intensity =
      static_cast<float>(source.intensity) * (source.color.empty() ? glm::vec3(1.0f) : vec3Of(source.color));
  light.range = static_cast<float>(source.range);
  light.innerConeAngle = static_cast<float>(source.spot.innerConeAngle);
  light.outerConeAngle = static_cast<float>(source.spot.outerConeAngle);
  if (light.kind == shading::kLightSpot && !(light.innerConeAngle < light.outerConeAngle))
    throwInputError("a spot light's inner cone angle is below its outer one, got {} and {}", light.innerConeAngle,
                    light.outerConeAngle);
  return light;
}

}  // namespace

std::string placeOfNode(const Document& document, std::size_t node) {
  return "node " + label(document.model.nodes[node].name, node);
}

Node readNode(const Document& document, std::size_t n, std::vector<std::string>& warnings) {
  const std::string place = placeOfNode(document, n);
  return atPlace(place, [&] {
    Node node;
    node.name = nameOf(document, n);
    readTransform(document.model.nodes[n], node);
    readMorphWeights(document.model, document.model.nodes[n], node);
    const nlohmann::json& json = document.json["nodes"][n];
    if (!json.contains("extras")) return node;
    node.probe = readProbeExtras(json["extras"], place, warnings);
    node.wave = readWaveExtras(json["extras"], place, warnings);
    return node;
  });
}

std::optional<Camera> readCamera(const Document& document, std::size_t n, int sceneNode,
                                 std::vector<std::string>& warnings) {
  const int index = document.model.nodes[n].camera;
  if (index < 0) return std::nullopt;
  const tinygltf::Camera& source = document.model.cameras[static_cast<std::size_t>(index)];
  if (source.type != "perspective") {
    warnings.push_back(fmt::format("{}: {} cameras are ignored", placeOfNode(document, n), source.type));
    return std::nullopt;
  }
  Camera camera;
  camera.name = nameOf(document, n);
  camera.node = sceneNode;
  camera.verticalFov = static_cast<float>(source.perspective.yfov);
  camera.zNear = static_cast<float>(source.perspective.znear);
  return camera;
}

std::optional<PunctualLight> readLight(const Document& document, std::size_t n, int sceneNode) {
  const auto& extensions = document.model.nodes[n].extensions;
  const auto extension = extensions.find("KHR_lights_punctual");
  if (extension == extensions.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt());
  PunctualLight light = atPlace(placeOfNode(document, n), [&] { return lightOf(document.model.lights.at(index)); });
  light.node = sceneNode;
  return light;
}

glm::vec4 unitQuaternion(glm::vec4 xyzw) {
  const float length = glm::length(xyzw);
  if (!(length > 1e-6f)) throwInputError("a rotation wants a quaternion of length 1, got one of {}", length);
  // Dividing what is unit already would change its last bits.
  return std::abs(length - 1.0f) < 1e-6f ? xyzw : xyzw / length;
}

}  // namespace pb::gltf
