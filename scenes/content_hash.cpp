// contentHash() and referenceHash() of scenes/snapshot.h.
#include <xxhash.h>

#include <type_traits>

#include "scenes/snapshot.h"

namespace pb {
namespace {

// Feeds plain values to one streaming hash.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
  ~Hasher() { XXH3_freeState(state_); }
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void bytes(const void* data, std::size_t size) { XXH3_64bits_update(state_, data, size); }
  template <class T>
  void value(const T& v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T> || std::is_class_v<T>);
    bytes(&v, sizeof v);
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_); }

 private:
  XXH3_state_t* state_;
};

void hashTexels(Hasher& hasher, const Texture& texture) {
  const ImageRgba& level0 = texture.levels.front();  // determines the others
  hasher.value(level0.width());
  hasher.value(level0.height());
  hasher.bytes(level0.data(), level0.size() * sizeof(glm::vec4));
}

void hashTexture(Hasher& hasher, const Scene& scene, int texture) {
  hasher.value(texture);
  if (texture >= 0) hashTexels(hasher, scene.textures[static_cast<std::size_t>(texture)]);
}

void hashMaterial(Hasher& hasher, const Scene& scene, const Material& m) {
  hasher.value(m.constants);
  for (const int texture :
       {m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture, m.emissionTexture, m.occlusionTexture})
    hashTexture(hasher, scene, texture);
  hasher.value(m.screen);
  hasher.value(m.doubleSided);
  hasher.value(m.isSpecularDominant);
}

void hashSurfacesAndLight(Hasher& hasher, const Snapshot& snapshot) {
  const Scene& scene = *snapshot.scene;
  for (const SnapshotInstance& instance : snapshot.instances) {
    hasher.value(instance.mesh->contentHash);
    hasher.value(instance.worldFromObject);
    hasher.value(instance.material);
    hasher.value(instance.probe);
  }
  for (const Material& material : scene.materials) hashMaterial(hasher, scene, material);
  for (const shading::Light& light : snapshot.lights) hasher.value(light);
  for (const Texture& screen : snapshot.screens) hashTexels(hasher, screen);
  hasher.value(scene.castsShadows);
  hasher.value(snapshot.environment().sky);
  hasher.value(snapshot.environment().ambient);
  for (const ImageRgba& face : snapshot.environment().faces) hasher.bytes(face.data(), face.size() * sizeof(glm::vec4));
  for (const Probe& probe : snapshot.probes) {
    hasher.value(probe.position);
    hasher.value(probe.zNear);
  }
  hasher.value(snapshot.camera);
}

}  // namespace

std::uint64_t contentHash(const Snapshot& snapshot) {
  Hasher hasher;
  hashSurfacesAndLight(hasher, snapshot);
  for (const Probe& probe : snapshot.probes)
    if (probe.proxyBox) hasher.value(*probe.proxyBox);
  return hasher.digest();
}

std::uint64_t referenceHash(const Snapshot& snapshot) {
  Hasher hasher;
  hashSurfacesAndLight(hasher, snapshot);
  return hasher.digest();
}

}  // namespace pb
