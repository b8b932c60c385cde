#include "bench/kept_pictures.h"

#include <algorithm>
#include <iterator>

#include "bench/external_sequence.h"
#include "bench/interrupt.h"
#include "bench/task_queue.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxWaitingPictures = 8;  // that are being written

fs::path pathOf(const RunDirectory& directory, const std::string& name) {
  return directory.keptFolder() / (name + ".exr");
}

Image readLossless(const fs::path& path) {
  try {
    return rgbOf(readImage(path.string()).pixels);
  } catch (const Error& error) {
    throwInputError("{}; a run without --resume renders it again", error.what());
  }
}

// Renders what is missing of one scene.
class SceneKeeper {
 public:
  SceneKeeper(const RunContext& context, KeptPictures& kept, std::size_t scene)
      : c_(context), kept_(kept), scene_(scene) {}

  SkippedExternals keep() {
    Sequences sequences;
    std::size_t frames = 0;
    for (const PlannedSequence& sequence : c_.plan.sequences)
      if (sequence.scene == scene_)
        if (const std::vector<int> missing = missingFrames(sequence); !missing.empty()) {
          sequences.push_back(&sequence);
          missing_[&sequence] = missing;
          frames += missing.size();
        }
    if (sequences.empty()) return {};
    c_.progress.begin("pictures of " + c_.scenes[scene_]->name, frames);
    TaskQueue queue(kMaxWaitingPictures);
    for (const Sequences& group : renderedTogether(c_, sequences)) keepGroup(group, queue);
    for (const PlannedSequence* sequence : sequences)
      if (sequence->external) keepExternal(*sequence, queue);
    queue.wait();
    c_.progress.end();
    return std::move(skipped_);
  }

 private:
  // The last ones in the same objects, which IntegrityMeter asks for.
  std::shared_ptr<const Snapshot> snapshot(int frame) {
    const bool isLast = std::ranges::any_of(c_.plan.sequences, [&](const PlannedSequence& sequence) {
      return sequence.scene == scene_ && sequence.frames.back() == frame;
    });
    if (!isLast) return makeSnapshot(c_, scene_, frame);
    std::shared_ptr<const Snapshot>& last = last_[frame];
    if (!last) last = makeSnapshot(c_, scene_, frame);
    return last;
  }

  std::vector<int> missingFrames(const PlannedSequence& sequence) const {
    std::vector<int> missing;
    std::ranges::copy_if(sequence.frames, std::back_inserter(missing),
                         [&](int frame) { return kept_.find(sequence, frame) == nullptr; });
    return missing;
  }

  bool isMissing(const PlannedSequence* sequence, int frame) const {
    return std::ranges::binary_search(missing_.at(sequence), frame);
  }

  void keepGroup(const Sequences& group, TaskQueue& queue) {
    RasterSource source(
        c_, group, [this](int frame) { return snapshot(frame); }, integrity_);
    int last = 0;
    for (const PlannedSequence* sequence : group) last = std::max(last, missing_.at(sequence).back());
    for (int frame = c_.suite.scenes[scene_].startFrame(); frame <= last; ++frame) {
      throwIfInterrupted();
      source.advance(frame, std::ranges::any_of(group, [&](const auto* s) { return isMissing(s, frame); }));
      for (std::size_t i = 0; i < group.size(); ++i)
        if (isMissing(group[i], frame))
          queue.run([this, &sequence = *group[i], shown = source.show(i)] {
            kept_.keep(sequence, shown);
            c_.progress.step();
          });
    }
  }

  void keepExternal(const PlannedSequence& sequence, TaskQueue& queue) {
    throwIfInterrupted();
    queue.wait();
    std::optional<Skipped> skipped = renderExternal(c_, sequence, missing_.at(&sequence), [&](const ShownFrame& shown) {
      kept_.keep(sequence, shown);
      c_.progress.step();
    });
    if (skipped) skipped_.push_back(*std::move(skipped));
  }

  const RunContext& c_;
  KeptPictures& kept_;
  std::size_t scene_;
  std::map<const PlannedSequence*, std::vector<int>> missing_;  // frames, of those that have any
  IntegrityMeter integrity_;
  std::map<int, std::shared_ptr<const Snapshot>> last_;
  SkippedExternals skipped_;
};

}  // namespace

bool isAttributed(const PlannedSequence& sequence, int frame) {
  return std::ranges::find(sequence.attributedFrames, frame) != sequence.attributedFrames.end();
}

void keepPicture(const RunDirectory& directory, const std::string& name, const Image& image) {
  const fs::path path = pathOf(directory, name);
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  if (failure) throwEnvironmentError("folder '{}' can't be made: {}", path.parent_path().string(), failure.message());
  writeExr(path.string(), image);
}

Image readPictureOf(const RunDirectory& directory, const CellResult& cell, const std::string& name) {
  const std::string& rendered = cell.pictures.rendered;
  return readLossless(rendered.empty() ? pathOf(directory, name) : directory.folder() / rendered);
}

KeptPictures::KeptPictures(const RunContext& context) : c_(context), names_(context.suite, context.scenes) {
  for (const CellResult& cell : c_.directory.keptCells())
    if (fs::exists(c_.directory.folder() / cell.pictures.rendered)) cells_.insert_or_assign(cell.key(), cell);
}

void KeptPictures::keep(const PlannedSequence& sequence, const ShownFrame& shown) {
  CellResult cell = shown.cell;
  const std::string name = names_.ofFrame(sequence, cell.frame);
  cell.pictures.rendered = pathOf(c_.directory, name).lexically_relative(c_.directory.folder()).generic_string();
  keepPicture(c_.directory, name, shown.image);
  c_.directory.appendKept(cell);
  const std::lock_guard lock(mutex_);
  cells_.insert_or_assign(cell.key(), std::move(cell));
}

const CellResult* KeptPictures::find(const PlannedSequence& sequence, int frame) const {
  const auto found = cells_.find(makeCell(c_.suite, sequence, frame).key());
  return found == cells_.end() ? nullptr : &found->second;
}

bool KeptPictures::haveAll(const PlannedSequence& sequence, const std::vector<int>& frames) const {
  return std::ranges::all_of(frames, [&](int frame) { return find(sequence, frame) != nullptr; });
}

ShownFrame KeptPictures::read(const PlannedSequence& sequence, int frame) const {
  const CellResult& kept = *find(sequence, frame);
  ShownFrame shown{readLossless(c_.directory.folder() / kept.pictures.rendered), kept};
  shown.cell.pictures = {};
  return shown;
}

SkippedExternals renderAndKeep(const RunContext& context, KeptPictures& kept) {
  SkippedExternals skipped;
  for (std::size_t scene = 0; scene < context.suite.scenes.size(); ++scene)
    std::ranges::move(SceneKeeper(context, kept, scene).keep(), std::back_inserter(skipped));
  return skipped;
}

}  // namespace pb
