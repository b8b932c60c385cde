// Index lists of the triangles that a frame's passes can show, for GL in software: its vertex stage, clipping and
// binning run on one thread, whereas a GPU drops triangles faster than we do (raster/triangle_culling.h).
//
// Lists are kept as long as eye, transform and shape stay, up to kLargestListBytes of all together.
#pragma once

#include <unordered_map>
#include <vector>

#include "raster/draw_binder.h"
#include "raster/gpu_structs.h"
#include "raster/triangle_culling.h"

namespace pb {

inline constexpr std::size_t kLargestListBytes = std::size_t{64} << 20;

// Whether dropping triangles of a mesh pays: not if it has few, nor if their lists might not fit.
bool isWorthCulling(const Mesh& mesh);

class TriangleLists {
 public:
  explicit TriangleLists(const gl::Functions& gl) : gl_(gl) {}

  // passes: of this frame.
  void beginFrame(const std::vector<gpu::PassConstants>& passes);

  // The triangles of a draw that a pass can show; all of them where looking at each would not pay. share: of the mesh's
  // triangles.
  IndexRange visible(std::size_t pass, const SurfaceDraw& draw, const SnapshotInstance& instance, float share,
                     Sides sides);

 private:
  // What lists depend on. Of a cube's faces the view is that of the first one.
  struct Key {
    SampledView view;
    glm::mat4 worldFromObject;
    std::uint64_t mesh;  // Mesh::contentHash
    float share;
    Sides sides;

    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Entry {
    Key key;
    std::array<TriangleCuller::Range, 6> ranges;  // in the entry's part of the buffer
    std::size_t first = 0, reserved = 0;          // of that part, indices
  };
  struct Pass {
    SampledView view;
    int face = -1;        // of a cube whose six faces share lists; -1: a view of its own
    std::size_t eye = 0;  // the first pass of that cube
  };

  void find(const Key& key, const SurfaceDraw& draw, const SnapshotInstance& instance, bool isCube, Entry& entry);
  bool store(Entry& entry);
  bool reserve(std::size_t count, Entry& entry);
  bool isFull() const { return wasRefused_ || wasRefusedBefore_; }

  const gl::Functions& gl_;
  TriangleCuller culler_;
  std::vector<Pass> passes_;
  std::unordered_map<std::uint64_t, Entry> entries_;  // by eye and instance
  gl::Buffer buffer_;
  std::size_t capacity_ = 0, used_ = 0;           // indices
  bool wasCleared_ = false, wasRefused_ = false;  // in this frame: all lists, a place for one
  bool wasRefusedBefore_ = false;                 // in the frame before
};

}  // namespace pb
