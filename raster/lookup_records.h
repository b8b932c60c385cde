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
#include <functional>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/gpu_structs.h"
#include "raster/limits.h"
#include "raster/programs.h"
#include "raster/refresh.h"
#include "raster/texel_rect.h"

namespace pb {

class ProbeMaps;

// Whether incremental iterations differ from brute force: else everything is captured again.
bool repeatsLookups(const Technique& technique);

// Surfaces whose lookups are kept together: all that look one probe's map up, of one material if they are mirrors of
// which less is kept (LookupRecord::mirror).
struct LookupGroup {
  static constexpr int kNoMirror = -1;
  int probe;
  int mirror;  // its material

  LookupRecord record() const { return mirror == kNoMirror ? LookupRecord::general : LookupRecord::mirror; }
  friend bool operator==(const LookupGroup&, const LookupGroup&) = default;
};

// Whether the device has room for lookups of maps of that size.
bool lookupRecordsFit(const DeviceLimits& limits, int resolution);

// What later bounce iterations of the frame change of a probe's map: numbered as in raster/shaders/settled.glsl.
enum class MapState { settled, changes, unsettled };

// What a capture shows of other probes.
struct CaptureLookups {
  bool any = false;
  bool areShown = true;          // the maps that are looked up
  bool isRecordable = true;      // each texel shows one lookup of an opaque surface at most
  std::vector<TexelRect> areas;  // by group: where the texels are that show it
};

class LookupRecords {
 public:
  // resolution: of the largest map. probes: how many there are.
  LookupRecords(gl::Context& context, Programs& programs, const DeviceLimits& limits, const Technique& technique,
                int resolution, int probes);

  // What recording surfaces are drawn to besides the colour; see scene.frag.
  std::array<const gl::Texture*, 3> targets() const { return {&targets_[0], &targets_[1], &targets_[2]}; }
  // The same of mirrors, six layers; nullptr if the probe has none to record.
  const gl::Texture* mirrors(int probe) const;

  // Forgets all records. groups: of this frame.
  void beginFrame(const std::vector<LookupGroup>& groups);

  // Makes room for the records of a captured probe. texels: by group, the most there are. False if the device has none.
  bool reserve(int probe, const std::vector<std::int64_t>& texels);

  // A capture is drawn between beginCapture() and endCapture(). What is drawn next says to which group it belongs, or
  // that it isn't recorded (the state after beginCapture()). endProbe() follows the captures of a probe.
  void beginCapture() const { skipDraw(); }
  void markDraw(GLuint program, int group, MapState map) const;
  void skipDraw() const { writeTo(false, false); }
  void endCapture(const ProbeFace& face, const CaptureLookups& lookups, const gl::Texture& capture);
  void endProbe(int probe, const gl::Texture& capture);

  // Looks up what the probe's texels show of the others once more. states: by probe looked up. isLast: no other
  // repetition follows in this frame. bindMirror binds the material of a group's mirrors.
  void repeat(int probe, const ProbeMaps& maps, const std::vector<MapState>& states, float largestRadiance, bool isLast,
              const std::function<void(const LookupGroup&)>& bindMirror);

  // Of all buffers.
  std::int64_t bytes() const;

 private:
  struct Region {
    std::int64_t first = 0;        // of the entries
    std::int64_t firstRecord = 0;  // in bytes
    std::int64_t records = 0;
  };
  struct Captured {
    std::vector<Region> regions;  // by group
    std::int64_t recordBytes = 0, entryBytes = 0;
    gl::Buffer records;
    gl::Buffer entries;
    gl::Texture mirrors;  // records of mirrors where they were drawn, a layer a face
    int repetitions = 0;  // in this frame
  };
  struct RecordPrograms {
    GLuint collect, repeat;
  };
  // As in raster/shaders/lookup_records.glsl: work groups, then number of entries.
  using List = std::array<std::uint32_t, 4>;

  std::int64_t bytesOf(const Captured& captured) const;
  std::size_t listOf(int repetition, int probe, std::size_t group) const;
  const RecordPrograms& programsOf(const LookupGroup& group) const;
  void bind(const Captured& captured, std::size_t group, GLenum access) const;
  void writeTo(bool mirrors, bool others) const;
  void list(std::vector<gpu::LookupScan> scans, const RecordPrograms& programs, const gl::Texture& capture);

  const gl::Functions& gl_;
  std::int64_t largestBlock_;    // bytes of a buffer that shaders see
  std::int64_t largestTexture_;  // bytes of a buffer that they see as an image
  std::int64_t allowedBytes_;
  int resolution_;
  int probes_;
  int repetitions_;  // most in a frame
  RecordPrograms mirrors_, general_;
  std::array<gl::Texture, 3> targets_;
  gl::Texture region_;  // of the buffer of records that shaders see
  std::vector<LookupGroup> groups_;
  std::vector<Captured> captured_;  // by probe
  std::size_t listCount_ = 0;
  gl::Buffer lists_;                          // by repetition, probe and group
  std::size_t scanRoom_ = 0, scanCount_ = 0;  // of this frame
  gl::Buffer scans_;
  std::vector<gpu::LookupScan> mirrorScans_;  // of the probe that is captured
};

}  // namespace pb
