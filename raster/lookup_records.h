// The texels of captures that show what other probes' maps show, kept so that the later bounce iterations of a frame
// look up those texels again and draw nothing.
//
// A captured texel shows rest + weight * radiance(direction), of which only the radiance changes from one iteration to
// the next. It is settled, and left alone, as soon as all texels that its lookup filters were settled; those that show
// no probe's map are so from the start. So the first repetition looks up all records, and each one after it only those
// that show reflections of reflections of one more order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/limits.h"
#include "raster/programs.h"
#include "raster/refresh.h"
#include "raster/texel_rect.h"

namespace pb {

class ProbeMaps;

// Whether incremental iterations differ from brute force: else everything is captured again.
bool repeatsLookups(const Technique& technique);

// Whether the device has room for lookups of maps of that size.
bool lookupRecordsFit(const DeviceLimits& limits, int resolution);

// What later bounce iterations of the frame change of a probe's map: numbered as in raster/shaders/settled.glsl.
enum class MapState { settled, changes, unsettled };

// What a capture shows of other probes.
struct CaptureLookups {
  bool any = false;
  bool areShown = true;          // the maps that are looked up
  bool isRecordable = true;      // each texel shows one lookup of an opaque surface at most
  std::vector<TexelRect> areas;  // by probe looked up: where the texels are that show it
};

class LookupRecords {
 public:
  // resolution: of the largest map. probes: how many there are.
  LookupRecords(gl::Context& context, Programs& programs, const DeviceLimits& limits, const Technique& technique,
                int resolution, int probes);

  // What recording surfaces are drawn to besides the colour; see scene.frag.
  std::array<const gl::Texture*, 3> targets() const { return {&targets_[0], &targets_[1], &targets_[2]}; }

  // Forgets all records.
  void beginFrame();

  // Makes room for the records of a captured probe. texels: by probe looked up, the most there are. False if the device
  // has none.
  bool reserve(int probe, const std::vector<std::int64_t>& texels);

  // A capture is drawn between the two. What is drawn next says which map it looks up, or that what it covers shows
  // none, or leaves the targets alone (the state after beginCapture()).
  void beginCapture();
  void markDraw(GLuint program, int lookedUp, MapState map) const;
  void hideMarks() const;
  void keepMarks() const;
  void endCapture(const ProbeFace& face, const CaptureLookups& lookups);

  // Looks up what the probe's texels show of the others once more. states: by probe looked up. isLast: no other
  // repetition follows in this frame.
  void repeat(int probe, const ProbeMaps& maps, const std::vector<MapState>& states, float largestRadiance,
              bool isLast);

  // Of all buffers.
  std::int64_t bytes() const;

 private:
  struct Region {
    std::int64_t first = 0;
    std::int64_t records = 0;
  };
  struct Captured {
    std::vector<Region> regions;  // by probe looked up
    std::int64_t capacity = 0;
    gl::Buffer records;
    gl::Buffer entries;
    int repetitions = 0;  // in this frame
  };
  // As in raster/shaders/lookup_records.glsl: work groups, then number of entries.
  using List = std::array<std::uint32_t, 4>;

  std::size_t listOf(int repetition, int probe, int lookedUp) const;
  void bind(const Captured& captured, const Region& region) const;
  void writeTo(int targets) const;

  const gl::Functions& gl_;
  std::int64_t largestBlock_;  // bytes of a buffer that shaders see
  std::int64_t allowedBytes_;
  int resolution_;
  int probes_;
  int repetitions_;  // most in a frame
  GLuint collect_;
  GLuint repeat_;
  std::array<gl::Texture, 3> targets_;
  int marker_ = 0;                  // of the first probe in the current capture
  std::vector<Captured> captured_;  // by probe
  gl::Buffer lists_;                // by repetition, probe and probe looked up
};

}  // namespace pb
