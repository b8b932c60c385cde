#include "bench/cost.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <numeric>
#include <sstream>

#include "bench/cost_model.h"
#include "bench/interrupt.h"
#include "bench/statistics.h"
#include "scenes/error.h"

namespace pb {
namespace {

using Snapshots = std::vector<std::shared_ptr<const Snapshot>>;

constexpr std::size_t kPlainFrames = 4;  // before and after each block; their median ignores single disturbances
constexpr std::size_t kPassFrames = 3;   // at least so many frames are taken apart into passes

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double totalMs(const PassTimes& passes) {
  return std::accumulate(passes.captureMs.begin(), passes.captureMs.end(),
                         passes.shadowMs + passes.prefilterMs + passes.finalMs);
}

// Of all threads of the process. Time in which other programs had the processor is not in it.
double processorMs() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

// Milliseconds of frames. `processor`: what the threads of a software renderer worked; on a GPU the same as `wall`.
struct FrameTimes {
  std::vector<double> wall, processor;
};

// One technique on one scene over all repetitions.
class Measurement {
 public:
  Measurement(RasterDevice& device, const ImageSettings& image, const CostRequest& request)
      : software_(device.info().software),
        bounces_(request.technique.bounces),
        snapshots_(request.snapshots),
        sequence_(device, request.technique, image.widthPx, image.heightPx, 1),
        plain_(device, plainTechnique(request.technique), image.widthPx, image.heightPx, 1) {
    warmUp();
  }

  void measure(benchmark::State& state) {
    FrameTimes frames, plainFrames;
    std::size_t next = 1;
    measurePlain(plainFrames);
    for (auto iteration : state) {
      render(sequence_, *snapshots_[next++], frames);
      state.SetIterationTime(frames.wall.back() * 1e-3);
    }
    measurePlain(plainFrames);
    const double plainMs = median(plainFrames.wall);
    frameMs_.push_back(meanOf(frames.wall));
    allFramesMs_.insert(allFramesMs_.end(), frames.wall.begin(), frames.wall.end());
    plainMs_.push_back(plainMs);
    ratios_.push_back(frameMs_.back() / plainMs);
    processorRatios_.push_back(meanOf(frames.processor) / median(plainFrames.processor));
    state.counters["plain_ms"] = plainMs;
    state.counters["ratio"] = ratios_.back();
  }

  std::size_t repetitions() const { return ratios_.size(); }

  CostResult result(const RenderCount& model) {
    CostResult cost;
    cost.repetitions = static_cast<int>(ratios_.size());
    const MedianInterval frame = medianInterval(frameMs_);
    cost.frameMs = frame.median;
    cost.frameMsLow = frame.low;
    cost.frameMsHigh = frame.high;
    cost.plainMs = median(plainMs_);
    const MedianInterval ratio = medianInterval(ratios_);
    cost.ratio = ratio.median;
    cost.ratioLow = ratio.low;
    cost.ratioHigh = ratio.high;
    cost.ratios = processorRatios_;
    cost.peaks = peaksOf(allFramesMs_);
    cost.rendersPerFrame = model.perFrame;
    cost.rendersFormula = model.formula;
    cost.measuredRendersPerFrame = 1 + facesPerFrame_;
    addPassTimes(cost);
    return cost;
  }

 private:
  static Technique plainTechnique(Technique technique) {
    technique.probes = ProbeUse::environmentOnly;
    technique.refraction = Refraction::oneInterface;  // the others draw more than the frame
    return technique;
  }

  double frameCount() const { return static_cast<double>(snapshots_.size() - 1); }

  // Also counts the captures of a block, which every later block repeats.
  void warmUp() {
    sequence_.renderFrame(*snapshots_[0]);
    for (std::size_t i = 1; i < snapshots_.size(); ++i)
      facesPerFrame_ +=
          static_cast<double>(sequence_.renderFrame(*snapshots_[i]).counters.facesCaptured) / frameCount();
    sequence_.finish();
    FrameTimes notCounted;
    measurePlain(notCounted);
  }

  // Software renderers draw while the calls return: wall time up to the idle device. On a GPU timer queries leave the
  // waiting for submission out.
  void render(RasterSequence& sequence, const Snapshot& snapshot, FrameTimes& times) const {
    if (!software_) {
      times.wall.push_back(totalMs(sequence.renderFrameTimed(snapshot)));
      times.processor.push_back(times.wall.back());
      return;
    }
    const double processorStart = processorMs();
    const auto start = std::chrono::steady_clock::now();
    sequence.renderFrame(snapshot);
    sequence.finish();
    times.wall.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    times.processor.push_back(processorMs() - processorStart);
  }

  void measurePlain(FrameTimes& frames) {
    const std::size_t block = snapshots_.size() - 1;
    for (std::size_t i = 0; i < kPlainFrames; ++i) render(plain_, *snapshots_[1 + i % block], frames);
  }

  // Means over a block, because policies spread their work over it; medians over blocks.
  void addPassTimes(CostResult& cost) {
    const std::size_t block = snapshots_.size() - 1;
    std::vector<std::vector<double>> captureMs(static_cast<std::size_t>(bounces_));
    std::vector<double> shadowMs, prefilterMs, finalMs;
    for (std::size_t frames = 0; frames < kPassFrames; frames += block) {
      const PassTimes mean = measurePasses();
      for (std::size_t b = 0; b < captureMs.size(); ++b) captureMs[b].push_back(mean.captureMs[b]);
      shadowMs.push_back(mean.shadowMs);
      prefilterMs.push_back(mean.prefilterMs);
      finalMs.push_back(mean.finalMs);
    }
    for (std::vector<double>& iteration : captureMs) cost.captureMs.push_back(median(iteration));
    cost.shadowMs = median(shadowMs);
    cost.prefilterMs = median(prefilterMs);
    cost.finalMs = median(finalMs);
  }

  PassTimes measurePasses() {
    PassTimes mean;
    mean.captureMs.resize(static_cast<std::size_t>(bounces_), 0.0);
    for (std::size_t i = 1; i < snapshots_.size(); ++i) {
      const PassTimes passes = sequence_.renderFrameTimed(*snapshots_[i]);
      for (std::size_t b = 0; b < passes.captureMs.size(); ++b) mean.captureMs[b] += passes.captureMs[b] / frameCount();
      mean.shadowMs += passes.shadowMs / frameCount();
      mean.prefilterMs += passes.prefilterMs / frameCount();
      mean.finalMs += passes.finalMs / frameCount();
    }
    return mean;
  }

  bool software_;
  int bounces_;
  const Snapshots& snapshots_;
  RasterSequence sequence_, plain_;
  double facesPerFrame_ = 0;
  std::vector<double> frameMs_, plainMs_, ratios_, processorRatios_;  // one a repetition
  std::vector<double> allFramesMs_;                                   // of all repetitions
};

// Google Benchmark takes its flags' defaults from the environment, where users keep them for other programs; each of
// these would change what is measured or where it is written.
void fixFlags() {
  static std::array<std::string, 8> arguments = {"probebench",
                                                 "--benchmark_enable_random_interleaving=false",
                                                 "--benchmark_filter=all",
                                                 "--benchmark_list_tests=false",
                                                 "--benchmark_out=",
                                                 "--benchmark_perf_counters=",
                                                 "--benchmark_display_aggregates_only=false",
                                                 "--benchmark_report_aggregates_only=false"};
  std::array<char*, 9> pointers{};
  std::ranges::transform(arguments, pointers.begin(), [](std::string& argument) { return argument.data(); });
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, pointers.data());
}

// Runs the registered benchmarks. Google Benchmark does not expect exceptions: the first is kept, and what comes after
// it is skipped.
class CostSession {
 public:
  CostSession(RasterDevice& device, const ImageSettings& image, const std::vector<CostRequest>& requests,
              int repetitions, const std::function<void()>& finished)
      : device_(device), image_(image), requests_(requests), repetitions_(repetitions), finished_(finished) {}

  CostRun run() {
    registerAll();
    std::ostringstream json;
    benchmark::JSONReporter reporter;
    reporter.SetOutputStream(&json);
    benchmark::RunSpecifiedBenchmarks(&reporter, nullptr, "all");
    benchmark::ClearRegisteredBenchmarks();
    if (failure_) std::rethrow_exception(failure_);
    if (results_.size() != requests_.size())
      throwEnvironmentError("Google Benchmark ran {} of {} cost measurements", results_.size(), requests_.size());
    return {std::move(results_), json.str()};
  }

 private:
  void registerAll() {
    benchmark::ClearRegisteredBenchmarks();
    for (const CostRequest& request : requests_)
      benchmark::RegisterBenchmark(request.name.c_str(),
                                   [this, &request](benchmark::State& state) { repeat(state, request); })
          ->Iterations(static_cast<benchmark::IterationCount>(request.snapshots.size() - 1))
          ->Repetitions(repetitions_)
          ->UseManualTime()
          ->MeasureProcessCPUTime()
          ->Unit(benchmark::kMillisecond);
  }

  // Called once a repetition, the repetitions of a request one after the other.
  void repeat(benchmark::State& state, const CostRequest& request) {
    if (failure_) return state.SkipWithError("an earlier measurement failed");
    try {
      if (!current_) start(request);
      current_->measure(state);
      if (current_->repetitions() == static_cast<std::size_t>(repetitions_)) finish(request);
    } catch (...) {
      failure_ = std::current_exception();
      current_.reset();
      state.SkipWithError("the measurement failed");
    }
  }

  void start(const CostRequest& request) {
    throwIfInterrupted();
    current_ = std::make_unique<Measurement>(device_, image_, request);
  }

  void finish(const CostRequest& request) {
    results_.push_back(current_->result(modelRenders(request.technique, request.snapshots)));
    current_.reset();
    finished_();
  }

  RasterDevice& device_;
  const ImageSettings& image_;
  const std::vector<CostRequest>& requests_;
  int repetitions_;
  const std::function<void()>& finished_;
  std::unique_ptr<Measurement> current_;
  std::vector<CostResult> results_;
  std::exception_ptr failure_;
};

}  // namespace

CostPeaks peaksOf(std::span<const double> frameMs) {
  return {quantile(frameMs, 0.5), quantile(frameMs, 0.95), quantile(frameMs, 0.99), quantile(frameMs, 1.0)};
}

CostRun measureCosts(RasterDevice& device, const ImageSettings& image, const std::vector<CostRequest>& requests,
                     int repetitions, const std::map<std::string, std::string>& context,
                     const std::function<void()>& finished) {
  fixFlags();
  for (const auto& [key, value] : context) benchmark::AddCustomContext(key, value);
  return CostSession(device, image, requests, repetitions, finished).run();
}

}  // namespace pb
