// External techniques at work: a program gets a job as a JSON file (results/schema/job.schema.json), renders, and its
// pictures and times (results/schema/timing.schema.json) are read; or those that were made earlier are. Explained in
// docs/external.md.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/external_technique.h"
#include "bench/json_document.h"
#include "bench/results.h"
#include "bench/suite.h"
#include "scenes/snapshot.h"

namespace pb {

struct ExternalFrame {
  int frame = 0;
  bool isMeasured = false;  // its picture is wanted; the others lead up to it
  std::shared_ptr<const Snapshot> snapshot;
};

struct ExternalRequest {
  const ExternalTechnique& technique;
  PictureName name;  // of the scene; the frame does not count
  ImageSettings image;
  AxisValues axes;                    // of the suite's base technique, which the program may follow
  std::vector<ExternalFrame> frames;  // in order, at least one
  int repetitions = 0;                // of the cost; 0: no times are wanted
};

// The job as it is handed over, all files in `folder`.
Json makeJob(const ExternalRequest& request, const std::string& folder);

// What a program says about its times. Throws an input Error for what breaks the schema.
ReportedCost readTiming(const std::string& path);

// A picture of the size of `image`. Throws an input Error that names `who` for any other, for pixels that are no linear
// float values, and for NaN and infinities.
Image readPicture(const std::string& path, const ImageSettings& image, const std::string& who);

// Throws an environment Error if the technique's program can't be found, an input Error if a picture that was to be
// there is not. To be called before anything is rendered.
void requireAvailable(const ExternalTechnique& technique, const PictureName& name, const std::vector<int>& frames);

struct ExternalOutcome {
  std::optional<std::string> skipped;  // why the program could not take the job, if it said so
  std::string messages;                // the end of what the program wrote to standard error
};

// Called for each measured frame, in order.
using TakePicture = std::function<void(int frame, Image picture, const std::optional<ReportedCost>& cost)>;

// Runs the program, or reads what is there. Throws an input Error for a program that fails, takes too long or leaves
// something else than the pictures and times that were asked for, an environment Error if it can't be started, and
// Error(Failure::interrupted) after an interrupt.
ExternalOutcome runExternal(const ExternalRequest& request, const TakePicture& take);

}  // namespace pb
