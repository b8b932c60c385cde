// Glass in closed form. Slab shift, ball and prism bind the reference only: what a cube map shows of them is the
// approximation, whose deviation is printed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

constexpr double kIor = 1.5;
constexpr double kPi = 3.14159265358979;

Check ofReference(std::string name, std::string quantity, double measured, double expected, double tolerance) {
  return {std::move(name), "reference", std::move(quantity), measured, expected, tolerance};
}

struct Estimate {
  glm::dvec3 mean{0.0};
  double standardError = 0.0;  // of the mean's green
};

// Paths along one ray choose between reflection and refraction.
Estimate estimateAlong(const ReferenceScene& scene, const glm::vec3& origin, const glm::vec3& direction, int samples) {
  Estimate estimate;
  double squares = 0.0;
  for (int s = 0; s < samples; ++s) {
    const glm::dvec3 value(scene.radiance(origin, direction, {}, static_cast<std::uint64_t>(s)));
    estimate.mean += value;
    squares += value.y * value.y;
  }
  estimate.mean /= samples;
  const double variance = std::max(squares / samples - estimate.mean.y * estimate.mean.y, 0.0);
  estimate.standardError = std::sqrt(variance / samples);
  return estimate;
}

// Of a ray that is mostly refracted: reflections are the few others.
double medianAlong(const ReferenceScene& scene, const glm::vec3& origin, const glm::vec3& direction, int channel = 1) {
  std::vector<float> values;
  for (std::uint64_t s = 0; s < 31; ++s) values.push_back(scene.radiance(origin, direction, {}, s)[channel]);
  std::ranges::nth_element(values, values.begin() + 15);
  return static_cast<double>(values[15]);
}

Mesh makeQuad(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
  return makeQuadMesh(centre - 0.5f * (u + v), u, v);
}

// A slab of thickness t shifts a ray at angle a sideways by t sin a (1 - cos a / sqrt(n^2 - sin^2 a)); along its plane
// that is 1 / cos a as much. The edge of an emitter behind it is searched by bisection.
std::vector<Check> slabChecks() {
  constexpr double kThickness = 0.5, kAngle = 0.7;
  Scene scene;
  scene.environment = makeConstantEnvironment(glm::vec3(0.0f));
  addInstance(scene, "Slab", finishMesh(makeBoxMesh({40.0f, 40.0f, static_cast<float>(kThickness)})),
              addMaterial(scene, makeGlassMaterial("Glass", static_cast<float>(kIor))));
  Material emitter = makeDiffuseMaterial("Emitter", glm::vec3(0.0f));
  emitter.constants.emission = {1.0f, 1.0f, 1.0f, 1.0f};
  addInstance(scene, "Half plane", finishMesh(makeQuad({-20, 0, -2}, {40, 0, 0}, {0, 40, 0})),
              addMaterial(scene, emitter));
  const ReferenceScene reference(snapshotOf(std::move(scene)));
  const glm::vec3 direction(std::sin(kAngle), 0.0f, -std::cos(kAngle));
  double lit = -8.0, dark = 2.0;
  while (dark - lit > 1e-5) {
    const double middle = 0.5 * (lit + dark);
    const bool isLit = medianAlong(reference, {static_cast<float>(middle), 0.1f, 2.0f}, direction) > 0.5;
    (isLit ? lit : dark) = middle;
  }
  const double sine = std::sin(kAngle), cosine = std::cos(kAngle);
  const double shift = kThickness * sine * (1.0 - cosine / std::sqrt(kIor * kIor - sine * sine)) / cosine;
  return {ofReference("glass slab", "sideways shift in metres", lit + 4.0 * std::tan(kAngle), shift, 5e-5)};
}

// Tells the sine of the elevation at which a ray leaves: radiance 1 + sine.
Environment makeElevationSky() { return makeLinearSky(1.0, 1.0); }

// A ray at height h below the axis of a unit ball leaves it turned upwards by 2 (asin h - asin(h / n)): the image is
// inverted, and rays near the axis cross it at the effective focal length n / (2 (n - 1)) from the centre.
std::vector<Check> ballChecks() {
  Scene scene;
  scene.environment = makeElevationSky();
  addInstance(scene, "Ball", finishMesh(makeSphereMesh(1.0f, 512, 256)),
              addMaterial(scene, makeGlassMaterial("Glass", static_cast<float>(kIor))));
  const ReferenceScene reference(snapshotOf(std::move(scene)));
  std::vector<Check> checks;
  for (const double height : {0.1, 0.3, 0.5, 0.7}) {
    const double turned = 2.0 * (std::asin(height) - std::asin(height / kIor));
    const double radiance = medianAlong(reference, {0.01f, static_cast<float>(-height), 3.0f}, {0, 0, -1});
    const std::string name = fmt::format("glass ball, ray {} below the axis", height);
    // Two refractions at chords of 1/512 turn: (2 pi / 512)^2 = 1.5e-4.
    checks.push_back(ofReference(name, "sine of the angle upwards", radiance - 1.0, std::sin(turned), 2e-4));
    if (height > 0.1) continue;
    // The paraxial law holds to third order in the height: by 0.4 % here, by series of the exact form.
    checks.push_back(ofReference(name, "focal distance in radii", height / (radiance - 1.0), height / std::sin(turned),
                                 2e-4 * height / (std::sin(turned) * std::sin(turned))));
    checks.push_back({"glass ball, paraxial", "reference", "focal distance in radii", height / (radiance - 1.0),
                      kIor / (2.0 * (kIor - 1.0)), 0.02});
  }
  return checks;
}

// What the raster makes of the ball: mean absolute difference of radiance from the reference's picture.
std::vector<Check> rasterBallChecks(RasterDevice& device) {
  Scene scene;
  scene.environment = makeElevationSky();
  addInstance(scene, "Ball", finishMesh(makeSphereMesh(1.0f, 128, 64)),
              addMaterial(scene, makeGlassMaterial("Glass", static_cast<float>(kIor), 2.0f)));
  addCamera(scene, "Camera", {0.0f, 0.0f, 5.0f}, glm::vec3(0.0f), 0.42f, 0.1f);
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(std::move(scene));
  const Image truth =
      ReferenceScene(snapshot).render(snapshot->camera, 96, 96, {.samplesPerAxis = 2, .spp = 16}).mean();
  std::vector<Check> checks;
  for (const auto& [name, refraction] :
       {std::pair("one-interface", Refraction::oneInterface), std::pair("two-interface", Refraction::twoInterface),
        std::pair("cubemap-backface", Refraction::cubemapBackface), std::pair("thick-slab", Refraction::thickSlab)}) {
    Technique technique;
    technique.resolution = 256;
    technique.refraction = refraction;
    const Image image = renderRaster(device, *snapshot, technique, 96, 96, 2);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i)
      sum += std::abs(static_cast<double>(image[i].y) - static_cast<double>(truth[i].y));
    checks.push_back({fmt::format("glass ball, {}", name), "raster", "mean absolute difference from the reference",
                      sum / static_cast<double>(image.size()), 0.0, 0.0, false});
  }
  return checks;
}

// Reflects a quarter at normal incidence: so much that what is reflected several times stands out of the tolerances
// below, at ior 1.5 it would not.
constexpr double kDenseIor = 3.0;

// Light through an absorbing slab and between its faces, in uniform light of 1: with F the reflectance at normal
// incidence and t the transmittance of the thickness, F + (1 - F)^2 t (1 + F t) / (1 - F^2 t^2) = F + (1 - F)^2 t / (1
// - F t).
std::vector<Check> absorptionChecks() {
  constexpr double kThickness = 0.8, kDistance = 0.5, kColor = 0.3;
  Scene scene;
  scene.environment = makeConstantEnvironment(glm::vec3(1.0f));
  Material glass = makeGlassMaterial("Glass", static_cast<float>(kDenseIor));
  setAttenuation(glass, glm::vec3(static_cast<float>(kColor)), static_cast<float>(kDistance));
  addInstance(scene, "Slab", finishMesh(makeBoxMesh({40.0f, 40.0f, static_cast<float>(kThickness)})),
              addMaterial(scene, glass));
  const ReferenceScene reference(snapshotOf(std::move(scene)));
  const Estimate e = estimateAlong(reference, {0.1f, 0.2f, 3.0f}, {0, 0, -1}, 20'000);
  const double t = std::pow(kColor, kThickness / kDistance);
  const double f = std::pow((kDenseIor - 1.0) / (kDenseIor + 1.0), 2.0);
  return {ofReference("absorbing slab, Beer-Lambert", "radiance in uniform light", e.mean.y,
                      f + (1.0 - f) * (1.0 - f) * t / (1.0 - f * t), 4.0 * e.standardError + 1e-6)};
}

// A thin wall reflects 2 F / (1 + F) and lets the rest go straight on.
std::vector<Check> thinWallChecks() {
  Scene scene;
  scene.environment = makeConstantEnvironment(glm::vec3(0.0f));
  addInstance(scene, "Pane", finishMesh(makeQuad({0, 0, 0}, {4, 0, 0}, {0, 4, 0})),
              addMaterial(scene, makeGlassMaterial("Thin glass", static_cast<float>(kDenseIor), 0.0f)));
  Material emitter = makeDiffuseMaterial("Emitter", glm::vec3(0.0f));
  emitter.constants.emission = {1.0f, 1.0f, 1.0f, 1.0f};
  emitter.doubleSided = true;
  addInstance(scene, "Behind", finishMesh(makeQuad({0, 0, -2}, {4, 0, 0}, {0, 4, 0})), addMaterial(scene, emitter));
  const ReferenceScene reference(snapshotOf(std::move(scene)));
  const Estimate e = estimateAlong(reference, {0.1f, 0.2f, 3.0f}, {0, 0, -1}, 20'000);
  const double f = std::pow((kDenseIor - 1.0) / (kDenseIor + 1.0), 2.0);
  return {ofReference("thin wall", "share that goes straight on", e.mean.y, 1.0 - 2.0 * f / (1.0 + f),
                      4.0 * e.standardError + 1e-6)};
}

// A wedge along z whose edge of angle `apex` points down, the middle of its faces at y = 0.
Mesh makePrismMesh(double apex) {
  const auto half = static_cast<float>(std::tan(0.5 * apex));
  const glm::vec3 edge(0, -1, 0), left(-2.0f * half, 1, 0), right(2.0f * half, 1, 0), near(0, 0, 10), far(0, 0, -10);
  Mesh mesh;
  mesh.name = "Prism";
  const auto triangle = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    for (const glm::vec3& p : {a, b, c}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(p);
    }
  };
  const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    triangle(a, b, c);
    triangle(a, c, d);
  };
  triangle(edge + near, right + near, left + near);
  triangle(edge + far, left + far, right + far);
  quad(edge + far, edge + near, left + near, left + far);
  quad(edge + near, edge + far, right + far, right + near);
  quad(left + near, right + near, right + far, left + far);
  return mesh;
}

Scene makePrismScene(double apex, double dispersion, const Environment& environment) {
  Scene scene;
  scene.environment = environment;
  Material glass = makeGlassMaterial("Flint", static_cast<float>(kIor));
  glass.constants.kind.w = static_cast<float>(dispersion);
  addInstance(scene, "Prism", finishMesh(makePrismMesh(apex)), addMaterial(scene, glass));
  return scene;
}

// A ray that meets a prism of angle A at angle i is turned towards its base by i - A + asin(n sin(A - asin(sin i /
// n))): upwards here, in the three indices that Cauchy's formula gives a glass of Abbe number 20.
std::vector<Check> prismChecks() {
  constexpr double kApex = 0.7, kIncidence = 0.6, kDispersion = 1.0;
  const ReferenceScene underElevation(snapshotOf(makePrismScene(kApex, kDispersion, makeElevationSky())));
  const ReferenceScene underWhite(
      snapshotOf(makePrismScene(kApex, kDispersion, makeConstantEnvironment(glm::vec3(1.0f)))));
  // Angles anticlockwise from +x. The right face's normal points right and down by half the angle between the faces;
  // the ray comes from the side of the base.
  const double heading = kPi - 0.5 * kApex + kIncidence;
  const glm::vec3 direction(static_cast<float>(std::cos(heading)), static_cast<float>(std::sin(heading)), 0.0f);
  const glm::vec3 met(static_cast<float>(std::tan(0.5 * kApex)), 0.0f, 0.01f);
  constexpr std::array<double, 3> kWavelengthsNm = {656.3, 587.6, 486.1};
  std::vector<Check> checks;
  for (int channel = 0; channel < 3; ++channel) {
    const double wavelengthNm = kWavelengthsNm[static_cast<std::size_t>(channel)];
    const double n = kIor + (kIor - 1.0) * kDispersion / 20.0 * (523655.0 / (wavelengthNm * wavelengthNm) - 1.5168);
    const double turned = kIncidence - kApex + std::asin(n * std::sin(kApex - std::asin(std::sin(kIncidence) / n)));
    // Paths of one channel only; the same path under a white sky tells its weight.
    std::vector<double> values;
    for (std::uint64_t sample = 0; sample < 400; ++sample) {
      const glm::vec3 origin = met - 3.0f * direction;
      const glm::vec3 weight = underWhite.radiance(origin, direction, {}, sample);
      if (weight[(channel + 1) % 3] == 0.0f && weight[(channel + 2) % 3] == 0.0f)
        values.push_back(static_cast<double>(underElevation.radiance(origin, direction, {}, sample)[channel]) /
                         static_cast<double>(weight[channel]));
    }
    std::ranges::sort(values);
    // The faces are flat: float's rounding is all.
    checks.push_back(
        ofReference(fmt::format("prism, {} nm", wavelengthNm), "sine of the elevation of the ray that leaves",
                    (values.empty() ? 0.0 : values[values.size() / 2]) - 1.0, std::sin(heading - turned), 2e-5));
  }
  return checks;
}

}  // namespace

std::vector<Check> certifyGlass(RasterDevice& device) {
  std::vector<Check> all;
  for (const std::vector<Check>& checks :
       {slabChecks(), ballChecks(), rasterBallChecks(device), absorptionChecks(), thinWallChecks(), prismChecks()})
    all.insert(all.end(), checks.begin(), checks.end());
  return all;
}

}  // namespace pb
