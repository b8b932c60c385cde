#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/commands/commands.h"
#include "bench/metrics/metrics.h"
#include "bench/metrics/metrics_json.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

const std::map<std::string, ToneMapper> kToneMappers = {
    {"aces", ToneMapper::aces}, {"hable", ToneMapper::hable}, {"reinhard", ToneMapper::reinhard}};

struct CompareOptions {
  std::string reference, test, mask, heatmap;
  bool json = false;
  FlipSettings flip;
};

// Where images are inside: the mask's brightest channel is at least half of full.
Mask readMask(const std::string& path) {
  const Image image = rgbOf(readImage(path).pixels);
  Mask mask(image.width(), image.height());
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask[i] = std::max({image[i].x, image[i].y, image[i].z}) >= 0.5f ? 1 : 0;
  return mask;
}

// "key value" lines: the means of the table, then the pooled values of FLIP.
std::string printText(const nlohmann::ordered_json& metrics) {
  std::vector<std::pair<std::string, std::string>> rows;
  const nlohmann::ordered_json flat = metrics.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string key = pointer.substr(1);
    std::ranges::replace(key, '/', '.');
    const std::string text = value.is_string() ? value.get<std::string>() : value.is_null() ? "-" : value.dump();
    rows.emplace_back(std::move(key), text);
  }
  return printList(rows);
}

int compare(const CompareOptions& options) {
  if (!options.heatmap.empty() && std::filesystem::path(options.heatmap).extension() != ".png")
    throwInputError("--heatmap wants a file named .png, got '{}'", options.heatmap);
  const LoadedImage reference = readImage(options.reference);
  const LoadedImage test = readImage(options.test);
  if (reference.encoding != test.encoding)
    throwInputError("both images must be 8-bit (sRGB) or both float (linear), got '{}' and '{}'", options.reference,
                    options.test);
  const Image referencePixels = rgbOf(reference.pixels);
  const Image testPixels = rgbOf(test.pixels);
  std::optional<Mask> mask;
  if (!options.mask.empty()) mask = readMask(options.mask);

  MetricsInput input{referencePixels, testPixels};
  input.srgb = reference.encoding == Encoding::srgb;
  input.flip = options.flip;
  const MetricsResult result = computeMetrics(input, mask ? &*mask : nullptr);
  if (mask && !result.masked) throwInputError("mask '{}' has no pixel inside", options.mask);

  if (!options.heatmap.empty())
    writePngEncoded(options.heatmap, magma(input.srgb ? result.flipLdrMap : result.flipHdrMap));
  const nlohmann::ordered_json metrics = metricsToJson(mask ? *result.masked : result.whole);
  fmt::print("{}", options.json ? metrics.dump(2) + "\n" : printText(metrics));
  return 0;
}

}  // namespace

void addCompareCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("compare", "image error of a test image against a reference");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("REFERENCE", options->reference, "8-bit files are sRGB, float files linear")->required();
  command->add_option("TEST", options->test, "an image of the same size and kind")->required();
  command->add_option("--mask", options->mask, "average only where this image is white");
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_option("--heatmap", options->heatmap, "write the FLIP map as a PNG");
  command->add_option("--ppd", options->flip.ppd, "pixels per degree of the observer")->capture_default_str();
  const auto setToneMapper = [options](const std::string& name) { options->flip.toneMapper = kToneMappers.at(name); };
  command->add_option_function<std::string>("--tone-mapper", setToneMapper, "of HDR-FLIP")
      ->check(CLI::IsMember(kToneMappers));
  command->add_option("--start-exposure", options->flip.startExposure, "of HDR-FLIP, stops");
  command->add_option("--stop-exposure", options->flip.stopExposure, "of HDR-FLIP, stops");
  command->add_option("--num-exposures", options->flip.numExposures, "of HDR-FLIP");
  command->callback([&action, options] { action = [options] { return compare(*options); }; });
}

}  // namespace pb
