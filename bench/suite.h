// Suites: what is rendered and measured, as a TOML file says it. Format: docs/suites.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/external_technique.h"
#include "bench/suite_attribution.h"
#include "bench/suite_axes.h"
#include "bench/tolerance.h"
#include "raster/technique.h"
#include "reference/renderer.h"

namespace pb {

struct SuiteScene {
  std::string name;               // as the suite or the command line spells it; stands in results
  std::string reference;          // what loadScene() gets: environment added, paths relative to the suite made absolute
  std::vector<int> frames = {0};  // measured frames, increasing
  std::optional<int> warmup;      // frames rendered before the first measured one; none: from frame 0 on
  std::string camera;             // empty: the scene's first
  double exposure = 0;            // stops, for LDR-FLIP, PSNR and SSIM
  ToleranceLevels tolerance;      // in place of the suite's
  std::vector<Variation> vary;    // beside the grid

  // The frame at which a sequence starts; frames before 0 show frame 0.
  int startFrame() const { return warmup ? frames.front() - *warmup : 0; }
};

struct ImageSettings {
  int widthPx = 640;
  int heightPx = 360;
  int samplesPerAxis = 2;  // S of the S x S primary points of a pixel

  double aspect() const { return static_cast<double>(widthPx) / heightPx; }
  friend bool operator==(const ImageSettings&, const ImageSettings&) = default;
};

// Samples per primary point beyond which the runner does not refine a reference.
inline constexpr int kMaxSpp = 1024;

struct TruthSettings {
  std::optional<int> depth;  // specular bounces; none: converged
  DiffuseTransport diffuse = DiffuseTransport::local;
  std::optional<int> diffuseDepth{};  // diffuse bounces of traced light; none: unlimited
  int spp = 16;                       // samples per primary point to begin with
  std::optional<double> maxNoise;     // relMSE of the noise floor; samples are added until it is met
  bool matched = true;                // cells are scored against the truth with as many bounces as they have, too
};

struct PictureSettings {
  bool everyFrame = false;  // keeps the pictures of every measured frame, else of a sequence's last one
};

struct CostSettings {
  int repetitions = 10;  // 0: no cost is measured
};

struct Suite {
  std::string name;
  ImageSettings image;
  TruthSettings reference;
  CostSettings cost;
  PictureSettings pictures;
  Technique technique;  // base values of every axis
  std::vector<SuiteScene> scenes;
  std::vector<GridAxis> grid;                      // in the order of the axis table
  std::vector<ExternalTechnique> externals;        // of other programs, each once on every scene
  std::optional<AttributionSettings> attribution;  // none: not wanted
  Tolerances tolerance;
  Tolerances warnTolerance;
};

// Parses TOML; `place` names the file in messages, and scene paths are relative to `folder`. Throws input Errors of the
// form "place:line: sentence".
Suite parseSuite(const std::string& toml, const std::string& place, const std::string& folder);

// A file or the name of a shipped suite.
Suite loadSuite(const std::string& fileOrName);

// Names of the shipped suites.
std::vector<std::string> shippedSuites();

// Those of the scenes that have their own, by toleranceScope(); for scenes whose cameras are named.
SceneTolerances sceneTolerancesOf(const Suite& suite);

// Puts a grid axis in the place of the suite's, wherever it had one.
void setGridAxis(Suite& suite, GridAxis axis);

// A scene of the command line, with the frames and exposure of `like`.
SuiteScene sceneLike(const SuiteScene& like, const std::string& reference);

// Everything that determines the numbers of a run (not the tolerances), one setting a line.
std::string canonicalText(const Suite& suite);

// "640x360", "4 samples" and the like, parsed alike in suites and on the command line; input Errors otherwise.
std::pair<int, int> parseSize(std::string_view text);
int samplesPerAxisOf(long long samples);
std::optional<int> parseDepth(std::string_view text);

// "local" or "traced"; throws an input Error otherwise.
DiffuseTransport parseDiffuse(std::string_view text);
std::string printDiffuse(DiffuseTransport diffuse);

}  // namespace pb
