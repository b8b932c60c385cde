#include "raster/lookup_records.h"

#include <algorithm>
#include <array>

#include "raster/gpu_structs.h"
#include "raster/probe_maps.h"

namespace pb {
namespace {

// Of LookupRecord in raster/shaders/lookup_records.glsl, and of its two entries.
constexpr std::int64_t kRecordBytes = 48;
constexpr std::int64_t kEntriesBytes = 8;
constexpr std::int64_t kTargetTexelBytes = 16;  // RGBA32F
constexpr int kTargets = 3;
// Markers are floats, exact up to here.
constexpr int kLastMarker = 1 << 24;
constexpr int kCollectEdge = 8;  // of collect_lookups.comp
// Regions begin at multiples of this many records: of 256 bytes, the largest alignment of bound ranges that drivers ask
// for, in records and in entries.
constexpr std::int64_t kRegionAlignment = 32;

std::int64_t recordsBytes(std::int64_t records) { return records * (kRecordBytes + kEntriesBytes); }

std::int64_t targetBytes(int resolution) { return kTargets * kTargetTexelBytes * resolution * resolution; }

// A share that leaves room for maps, textures and the image.
std::int64_t allowedBytes(const DeviceLimits& limits) { return limits.bytes / 4; }

int groupsOf(int count) { return (count + kCollectEdge - 1) / kCollectEdge; }

}  // namespace

bool repeatsLookups(const Technique& technique) {
  // Directions of other lookups change with what is captured, or are none.
  const std::string& lookup = technique.lookup.name;
  const bool keepsDirections = lookup == "infinite" || lookup == "sphere-proxy" || lookup == "box-proxy";
  return technique.iterations == Iterations::incremental && technique.bounces > 1 &&
         technique.probes == ProbeUse::dynamic && keepsDirections && technique.format == ProbeFormat::rgba16f &&
         technique.storage == Storage::cube && technique.seamless && technique.hysteresis == 0.0f;
}

bool lookupRecordsFit(const DeviceLimits& limits, int resolution) {
  return targetBytes(resolution) <= allowedBytes(limits);
}

LookupRecords::LookupRecords(gl::Context& context, Programs& programs, const DeviceLimits& limits,
                             const Technique& technique, int resolution, int probes)
    : gl_(context.functions()),
      largestBlock_(context.integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)),
      allowedBytes_(allowedBytes(limits)),
      resolution_(resolution),
      probes_(probes),
      repetitions_(technique.bounces - 1),
      collect_(programs.collectLookups()),
      repeat_(programs.repeatLookups()),
      captured_(static_cast<std::size_t>(probes)) {
  constexpr std::array kNoMarker = {0.0f, 0.0f, 0.0f, 0.0f};
  for (gl::Texture& target : targets_) {
    target = gl::makeTexture(
        gl_, {.target = GL_TEXTURE_2D, .format = GL_RGBA32F, .width = resolution, .height = resolution});
    gl_.ClearTexImage(target.id(), 0, GL_RGBA, GL_FLOAT, kNoMarker.data());
  }
  context.check("allocating what incremental bounce iterations keep");
}

std::size_t LookupRecords::listOf(int repetition, int probe, int lookedUp) const {
  return static_cast<std::size_t>((repetition * probes_ + probe) * probes_ + lookedUp);
}

void LookupRecords::beginFrame() {
  std::vector<List> lists(listOf(repetitions_, 0, 0), List{0, 1, 1, 0});
  if (lists_.id() == 0) lists_ = gl::Buffer(gl_, lists.size() * sizeof(List));
  lists_.write(0, gl::bytesOf(lists));
  for (Captured& captured : captured_) {
    captured.repetitions = 0;
    captured.regions.assign(static_cast<std::size_t>(probes_), {});
  }
}

bool LookupRecords::reserve(int probe, const std::vector<std::int64_t>& texels) {
  Captured& captured = captured_[static_cast<std::size_t>(probe)];
  std::int64_t records = 0;
  for (std::size_t lookedUp = 0; lookedUp < texels.size(); ++lookedUp) {
    if (texels[lookedUp] * kRecordBytes > largestBlock_) return false;
    captured.regions[lookedUp] = {records, texels[lookedUp]};
    records += (texels[lookedUp] + kRegionAlignment - 1) / kRegionAlignment * kRegionAlignment;
  }
  if (records > captured.capacity) {
    const std::int64_t more = recordsBytes(records - captured.capacity);
    if (bytes() + more > allowedBytes_) return false;
    captured.capacity = records;
    captured.records = gl::Buffer();  // first, so that both needn't fit
    captured.entries = gl::Buffer();
    captured.records = gl::Buffer(gl_, static_cast<std::size_t>(records * kRecordBytes));
    captured.entries = gl::Buffer(gl_, static_cast<std::size_t>(records * kEntriesBytes));
  }
  return true;
}

// The first `targets` of them.
void LookupRecords::writeTo(int targets) const {
  for (int target = 1; target <= kTargets; ++target) {
    const GLboolean mask = target <= targets ? GL_TRUE : GL_FALSE;
    gl_.ColorMaski(static_cast<GLuint>(target), mask, mask, mask, mask);
  }
}

// Each capture has markers of its own, so that the targets need not be emptied.
void LookupRecords::beginCapture() {
  constexpr std::array kNoMarker = {0.0f, 0.0f, 0.0f, 0.0f};
  const int first = marker_ == 0 ? 1 : marker_ + probes_;
  marker_ = first;
  if (first + probes_ > kLastMarker) {
    gl_.ClearTexImage(targets_[0].id(), 0, GL_RGBA, GL_FLOAT, kNoMarker.data());
    marker_ = 1;
  }
  writeTo(0);
}

void LookupRecords::markDraw(GLuint program, int lookedUp, MapState map) const {
  writeTo(kTargets);
  gl_.ProgramUniform2f(program, 0, static_cast<float>(marker_ + lookedUp), static_cast<float>(map));
}

void LookupRecords::hideMarks() const { writeTo(1); }

void LookupRecords::keepMarks() const { writeTo(0); }

void LookupRecords::endCapture(const ProbeFace& face, const CaptureLookups& lookups) {
  writeTo(kTargets);
  const Captured& captured = captured_[static_cast<std::size_t>(face.probe)];
  for (GLuint i = 0; i < kTargets; ++i) gl_.BindTextureUnit(gpu::kLookupRestUnit + i, targets_[i].id());
  gl_.UseProgram(collect_);
  for (int lookedUp = 0; lookedUp < probes_; ++lookedUp) {
    const TexelRect& area = lookups.areas[static_cast<std::size_t>(lookedUp)];
    if (area.texels() == 0) continue;
    bind(captured, captured.regions[static_cast<std::size_t>(lookedUp)]);
    const int columns = area.right - area.left, rows = area.bottom - area.top;
    gl_.Uniform4i(0, area.left, area.top, columns, rows);
    gl_.Uniform3i(1, face.face, marker_ + lookedUp, static_cast<GLint>(listOf(0, face.probe, lookedUp)));
    gl_.DispatchCompute(static_cast<GLuint>(groupsOf(columns)), static_cast<GLuint>(groupsOf(rows)), 1);
  }
}

void LookupRecords::repeat(int probe, const ProbeMaps& maps, const std::vector<MapState>& states, float largestRadiance,
                           bool isLast) {
  constexpr GLuint kNoList = ~0u;
  Captured& captured = captured_[static_cast<std::size_t>(probe)];
  const int repetition = captured.repetitions++;
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  gl_.BindImageTexture(gpu::kLookupTargetImage, maps.captured(probe).id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  gl_.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, lists_.id());
  gl_.UseProgram(repeat_);
  for (int lookedUp = 0; lookedUp < probes_; ++lookedUp) {
    const Region& region = captured.regions[static_cast<std::size_t>(lookedUp)];
    if (region.records == 0) continue;
    const std::size_t list = listOf(repetition, probe, lookedUp);
    const GLuint next = isLast ? kNoList : static_cast<GLuint>(listOf(repetition + 1, probe, lookedUp));
    bind(captured, region);
    maps.bind(lookedUp);
    gl_.Uniform3ui(0, static_cast<GLuint>(list), next, static_cast<GLuint>(repetition));
    gl_.Uniform2f(1, largestRadiance, static_cast<float>(states[static_cast<std::size_t>(lookedUp)]));
    gl_.DispatchComputeIndirect(static_cast<GLintptr>(list * sizeof(List)));
  }
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

// The shaders see one region: all of a capture's records may be more than a block can hold.
void LookupRecords::bind(const Captured& captured, const Region& region) const {
  const auto bindRange = [&](GLuint block, const gl::Buffer& buffer, std::int64_t bytesEach) {
    gl_.BindBufferRange(GL_SHADER_STORAGE_BUFFER, block, buffer.id(), static_cast<GLintptr>(region.first * bytesEach),
                        static_cast<GLsizeiptr>(region.records * bytesEach));
  };
  bindRange(gpu::kLookupRecordBlock, captured.records, kRecordBytes);
  bindRange(gpu::kLookupIndexBlock, captured.entries, kEntriesBytes);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLookupListBlock, lists_.id());
}

std::int64_t LookupRecords::bytes() const {
  std::int64_t sum = targetBytes(resolution_);
  for (const Captured& captured : captured_) sum += recordsBytes(captured.capacity);
  return sum;
}

}  // namespace pb
