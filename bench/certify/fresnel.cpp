// Reflectances at angles where they are known in closed form, or by complex arithmetic in double precision.
#include <complex>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

Check ofModel(std::string name, std::string quantity, double measured, double expected, double tolerance) {
  return {std::move(name), "shading model", std::move(quantity), measured, expected, tolerance};
}

// Fresnel's equations with a complex index of refraction n (Born and Wolf, section 1.5.2 and 14.2).
double reflectance(double cosine, std::complex<double> n) {
  const double sin2 = 1.0 - cosine * cosine;
  const std::complex<double> transmitted = std::sqrt(1.0 - sin2 / (n * n));
  const std::complex<double> rs = (cosine - n * transmitted) / (cosine + n * transmitted);
  const std::complex<double> rp = (n * cosine - transmitted) / (n * cosine + transmitted);
  return 0.5 * (std::norm(rs) + std::norm(rp));
}

// Johnson and Christy, "Optical Constants of the Noble Metals" (1972), gold at 2.01, 2.26 and 2.50 eV.
constexpr glm::vec3 kGoldEta(0.21f, 0.43f, 1.04f);
constexpr glm::vec3 kGoldK(3.272f, 2.455f, 1.833f);

double conductorError() {
  double largest = 0.0;
  for (const float cosine : {0.05f, 0.2f, 0.5f, 0.8f, 1.0f}) {
    const glm::vec3 measured = shading::F_Conductor(cosine, kGoldEta, kGoldK);
    for (int c = 0; c < 3; ++c) {
      const std::complex<double> n(static_cast<double>(kGoldEta[c]), static_cast<double>(kGoldK[c]));
      largest =
          std::max(largest, std::abs(static_cast<double>(measured[c]) - reflectance(static_cast<double>(cosine), n)));
    }
  }
  return largest;
}

double dielectricError() {
  double largest = 0.0;
  for (const float ior : {0.7f, 1.33f, 1.5f, 2.42f})
    for (const float cosine : {0.05f, 0.2f, 0.5f, 0.8f, 0.95f, 1.0f})
      largest = std::max(largest, std::abs(static_cast<double>(shading::F_Dielectric(cosine, ior)) -
                                           reflectance(static_cast<double>(cosine), static_cast<double>(ior))));
  return largest;
}

// Where reflection inside of glass becomes total, in degrees, by bisection.
double criticalAngleDegrees(double ior) {
  double partial = 0.0, total = 0.5 * 3.14159265358979;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (partial + total);
    const bool isTotal =
        shading::F_Dielectric(static_cast<float>(std::cos(middle)), static_cast<float>(1.0 / ior)) >= 1.0f;
    (isTotal ? total : partial) = middle;
  }
  return glm::degrees(total);
}

int wrongCodes(int codes) {
  int wrong = 0;
  for (int code = 0; code < codes; ++code) {
    const float encoded = static_cast<float>(code) / static_cast<float>(codes - 1);
    const float back = shading::srgbEncode(shading::srgbDecode(encoded)) * static_cast<float>(codes - 1);
    if (static_cast<int>(std::lround(back)) != code) ++wrong;
  }
  return wrong;
}

}  // namespace

std::vector<Check> certifyFresnel(RasterDevice& /*device*/) {
  // At Brewster's angle tan = n only the s-polarised half is reflected: ((1 - n^2) / (1 + n^2))^2 / 2.
  const double brewsterCosine = 1.0 / std::sqrt(1.0 + 1.5 * 1.5);
  const double brewster = 0.5 * std::pow((1.0 - 1.5 * 1.5) / (1.0 + 1.5 * 1.5), 2.0);
  // Rounding of a float near 1 turns the critical angle by sqrt(2 epsilon): the cosine's slope there is finite, 0.67.
  return {
      ofModel("Fresnel, glass 1.5", "reflectance at normal incidence",
              static_cast<double>(shading::F_Dielectric(1.0f, 1.5f)), 0.04, 1e-7),
      ofModel("Fresnel, glass 1.5", "reflectance at Brewster's angle",
              static_cast<double>(shading::F_Dielectric(static_cast<float>(brewsterCosine), 1.5f)), brewster, 1e-6),
      ofModel("Fresnel, dielectrics", "largest error", dielectricError(), 0.0, 2e-6),
      ofModel("Fresnel, gold", "reflectance at normal incidence, 2.01 eV",
              static_cast<double>(shading::F_Conductor(1.0f, kGoldEta, kGoldK).x),
              (0.79 * 0.79 + 3.272 * 3.272) / (1.21 * 1.21 + 3.272 * 3.272), 1e-6),
      ofModel("Fresnel, gold", "largest error", conductorError(), 0.0, 2e-6),
      ofModel("total internal reflection, glass 1.5", "critical angle in degrees", criticalAngleDegrees(1.5),
              glm::degrees(std::asin(1.0 / 1.5)), 1e-3),
      ofModel("sRGB round trip", "8-bit codes that change", wrongCodes(256), 0.0, 0.0),
      ofModel("sRGB round trip", "16-bit codes that change", wrongCodes(65536), 0.0, 0.0),
  };
}

}  // namespace pb
