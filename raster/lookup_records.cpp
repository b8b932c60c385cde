#include "raster/lookup_records.h"

#include <algorithm>
#include <array>

#include "raster/gpu_structs.h"
#include "raster/lookup.h"
#include "raster/probe_maps.h"

namespace pb {
namespace {

constexpr std::int64_t kTexelBytes = 16;  // RGBA32F
constexpr int kTargets = 3;
// Of raster/shaders/lookup_records.glsl.
constexpr std::int64_t kEntriesBytes = 12;
// Of a record that a list keeps: those of mirrors stay where they were drawn.
int recordTexels(LookupRecord record) { return record == LookupRecord::mirror ? 0 : kTargets; }
constexpr GLuint kMirrorTarget = kTargets + 1;
// Groups are told apart by the alpha of captures: half floats hold integers exactly up to here.
constexpr std::size_t kLargestGroup = 2048;
constexpr int kTileColumns = 64, kTileRows = 8;  // of a work group of collect_lookups.comp
// Regions begin at multiples of this many records: of 256 bytes, the largest alignment of bound ranges that drivers ask
// for, in records and in entries.
constexpr std::int64_t kRegionAlignment = 64;

std::int64_t targetBytes(int resolution) { return kTargets * kTexelBytes * resolution * resolution; }
std::int64_t mirrorBytes(int resolution) { return 6 * kTexelBytes * resolution * resolution; }

// A share that leaves room for maps, textures and the image.
std::int64_t allowedBytes(const DeviceLimits& limits) { return limits.bytes / 4; }

int quotientUp(int count, int divisor) { return (count + divisor - 1) / divisor; }

int tilesOf(const gpu::LookupScan& scan) {
  return quotientUp(scan.area.z, kTileColumns) * quotientUp(scan.area.w, kTileRows);
}

}  // namespace

bool repeatsLookups(const Technique& technique) {
  return technique.iterations == Iterations::incremental && technique.bounces > 1 &&
         technique.probes == ProbeUse::dynamic && lookupOf(technique.lookup).keepsDirections &&
         technique.format == ProbeFormat::rgba16f && technique.storage == Storage::cube && technique.seamless &&
         technique.hysteresis == 0.0f;
}

bool lookupRecordsFit(const DeviceLimits& limits, int resolution) {
  return targetBytes(resolution) <= allowedBytes(limits);
}

LookupRecords::LookupRecords(gl::Context& context, Programs& programs, const DeviceLimits& limits,
                             const Technique& technique, int resolution, int probes)
    : gl_(context.functions()),
      largestBlock_(context.integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)),
      largestTexture_(kTexelBytes * context.integer(GL_MAX_TEXTURE_BUFFER_SIZE)),
      allowedBytes_(allowedBytes(limits)),
      resolution_(resolution),
      probes_(probes),
      repetitions_(technique.bounces - 1),
      mirrors_{programs.collectLookups(LookupRecord::mirror),
               programs.repeatLookups(LookupRecord::mirror, techniqueDefines(technique))},
      general_{programs.collectLookups(LookupRecord::general),
               programs.repeatLookups(LookupRecord::general, techniqueDefines(technique))},
      captured_(static_cast<std::size_t>(probes)) {
  for (gl::Texture& target : targets_)
    target = gl::makeTexture(
        gl_, {.target = GL_TEXTURE_2D, .format = GL_RGBA32F, .width = resolution, .height = resolution});
  GLuint region = 0;
  gl_.CreateTextures(GL_TEXTURE_BUFFER, 1, &region);
  region_ = gl::Texture(gl_, region);
  context.check("allocating what incremental bounce iterations keep");
}

std::size_t LookupRecords::listOf(int repetition, int probe, std::size_t group) const {
  return static_cast<std::size_t>(repetition * probes_ + probe) * groups_.size() + group;
}

const LookupRecords::RecordPrograms& LookupRecords::programsOf(const LookupGroup& group) const {
  return group.record() == LookupRecord::mirror ? mirrors_ : general_;
}

void LookupRecords::beginFrame(const std::vector<LookupGroup>& groups) {
  groups_ = groups;
  const std::vector<List> lists(listOf(repetitions_, 0, 0), List{0, 1, 1, 0});
  if (listCount_ < lists.size()) lists_ = gl::Buffer(gl_, lists.size() * sizeof(List));
  listCount_ = std::max(listCount_, lists.size());
  if (!lists.empty()) lists_.write(0, gl::bytesOf(lists));
  const std::size_t scans = captured_.size() * 6 * groups_.size();
  if (scanRoom_ < scans) scans_ = gl::Buffer(gl_, scans * sizeof(gpu::LookupScan));
  scanRoom_ = std::max(scanRoom_, scans);
  scanCount_ = 0;
  for (Captured& captured : captured_) {
    captured.repetitions = 0;
    captured.regions.assign(groups_.size(), {});
  }
}

bool LookupRecords::reserve(int probe, const std::vector<std::int64_t>& texels) {
  if (groups_.size() > kLargestGroup) return false;
  Captured& captured = captured_[static_cast<std::size_t>(probe)];
  std::int64_t entries = 0, recordBytes = 0;
  bool hasMirrors = captured.mirrors.id() != 0;
  for (std::size_t group = 0; group < texels.size(); ++group) {
    const std::int64_t bytesEach = kTexelBytes * recordTexels(groups_[group].record());
    if (texels[group] * bytesEach > largestTexture_) return false;
    captured.regions[group] = {entries, recordBytes, texels[group]};
    const std::int64_t room = (texels[group] + kRegionAlignment - 1) / kRegionAlignment * kRegionAlignment;
    entries += room;
    recordBytes += room * bytesEach;
    hasMirrors = hasMirrors || (texels[group] > 0 && groups_[group].record() == LookupRecord::mirror);
  }
  recordBytes = std::max(recordBytes, captured.recordBytes);
  const std::int64_t entryBytes = std::max(entries * kEntriesBytes, captured.entryBytes);
  if (entryBytes > largestBlock_) return false;
  const std::int64_t before = bytesOf(captured);
  const std::int64_t after = recordBytes + entryBytes + (hasMirrors ? mirrorBytes(resolution_) : 0);
  if (after == before) return true;
  if (bytes() - before + after > allowedBytes_) return false;
  if (hasMirrors && captured.mirrors.id() == 0)
    captured.mirrors = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                             .format = GL_RGBA32F,
                                             .width = resolution_,
                                             .height = resolution_,
                                             .layers = 6});
  const auto grow = [&](gl::Buffer& buffer, std::int64_t& held, std::int64_t wanted) {
    if (wanted == held) return;
    buffer = gl::Buffer();  // first, so that both needn't fit
    buffer = gl::Buffer(gl_, static_cast<std::size_t>(wanted));
    held = wanted;
  };
  grow(captured.records, captured.recordBytes, recordBytes);
  grow(captured.entries, captured.entryBytes, entryBytes);
  return true;
}

const gl::Texture* LookupRecords::mirrors(int probe) const {
  const gl::Texture& texture = captured_[static_cast<std::size_t>(probe)].mirrors;
  return texture.id() == 0 ? nullptr : &texture;
}

void LookupRecords::writeTo(bool mirrors, bool others) const {
  for (GLuint target = 1; target <= kMirrorTarget; ++target) {
    const GLboolean mask = (target == kMirrorTarget ? mirrors : others) ? GL_TRUE : GL_FALSE;
    gl_.ColorMaski(target, mask, mask, mask, mask);
  }
}

void LookupRecords::markDraw(GLuint program, int group, MapState map) const {
  const bool isMirror = groups_[static_cast<std::size_t>(group)].record() == LookupRecord::mirror;
  writeTo(isMirror, !isMirror);
  gl_.ProgramUniform2f(program, 0, static_cast<float>(1 + group), static_cast<float>(map));
}

// Mirrors' records stay where they were drawn, and are listed later, all faces at once: the driver waits for each
// dispatch.
void LookupRecords::endCapture(const ProbeFace& face, const CaptureLookups& lookups, const gl::Texture& capture) {
  writeTo(true, true);
  const Captured& captured = captured_[static_cast<std::size_t>(face.probe)];
  for (GLuint i = 0; i < kTargets; ++i) gl_.BindTextureUnit(gpu::kLookupTargetUnit + i, targets_[i].id());
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    const TexelRect& area = lookups.areas[group];
    if (area.texels() == 0) continue;
    gpu::LookupScan scan = {{area.left, area.top, area.right - area.left, area.bottom - area.top},
                            {face.face, static_cast<int>(1 + group), static_cast<int>(listOf(0, face.probe, group)), 0},
                            {}};
    if (groups_[group].record() == LookupRecord::mirror) {
      scan.lookedFor.w = static_cast<int>(captured.regions[group].first);
      mirrorScans_.push_back(scan);
      continue;
    }
    bind(captured, group, GL_WRITE_ONLY);
    list({scan}, general_, capture);
  }
}

void LookupRecords::endProbe(int probe, const gl::Texture& capture) {
  if (mirrorScans_.empty()) return;
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLookupEntryBlock,
                     captured_[static_cast<std::size_t>(probe)].entries.id());
  list(std::move(mirrorScans_), mirrors_, capture);
  mirrorScans_.clear();
}

void LookupRecords::list(std::vector<gpu::LookupScan> scans, const RecordPrograms& programs,
                         const gl::Texture& capture) {
  constexpr int kMostAcross = 32768;  // work groups; GL allows at least 65535
  int tiles = 0;
  for (gpu::LookupScan& scan : scans) {
    scan.work.x = tiles;
    tiles += tilesOf(scan);
  }
  scans_.write(scanCount_ * sizeof(gpu::LookupScan), gl::bytesOf(scans));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLookupScanBlock, scans_.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLookupListBlock, lists_.id());
  gl_.BindTextureUnit(gpu::kLookupCaptureUnit, capture.id());
  gl_.UseProgram(programs.collect);
  gl_.Uniform3i(0, static_cast<GLint>(scanCount_), static_cast<GLint>(scanCount_ + scans.size()), tiles);
  const int across = std::min(tiles, kMostAcross);
  gl_.DispatchCompute(static_cast<GLuint>(across), static_cast<GLuint>(quotientUp(tiles, across)), 1);
  scanCount_ += scans.size();
}

void LookupRecords::repeat(int probe, const ProbeMaps& maps, const std::vector<MapState>& states, float largestRadiance,
                           bool isLast, const std::function<void(const LookupGroup&)>& bindMirror) {
  constexpr GLuint kNoList = ~0u;
  Captured& captured = captured_[static_cast<std::size_t>(probe)];
  const int repetition = captured.repetitions++;
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  gl_.BindImageTexture(gpu::kLookupTargetImage, maps.captured(probe).id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  gl_.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, lists_.id());
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    if (captured.regions[group].records == 0) continue;
    const std::size_t list = listOf(repetition, probe, group);
    const GLuint next = isLast ? kNoList : static_cast<GLuint>(listOf(repetition + 1, probe, group));
    const auto lookedUp = static_cast<std::size_t>(groups_[group].probe);
    gl_.UseProgram(programsOf(groups_[group]).repeat);
    bind(captured, group, GL_READ_ONLY);
    maps.bind(groups_[group].probe);
    if (groups_[group].record() == LookupRecord::mirror) {
      bindMirror(groups_[group]);
      gl_.BindTextureUnit(gpu::kLookupTargetUnit, captured.mirrors.id());
    }
    gl_.Uniform3ui(0, static_cast<GLuint>(list), next, static_cast<GLuint>(repetition));
    gl_.Uniform2f(1, largestRadiance, static_cast<float>(states[lookedUp]));
    gl_.DispatchComputeIndirect(static_cast<GLintptr>(list * sizeof(List)));
  }
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

// The shaders see one region: all of a capture's records may be more than a block can hold.
void LookupRecords::bind(const Captured& captured, std::size_t group, GLenum access) const {
  const Region& region = captured.regions[group];
  if (groups_[group].record() == LookupRecord::general) {
    gl_.TextureBufferRange(region_.id(), GL_RGBA32F, captured.records.id(), static_cast<GLintptr>(region.firstRecord),
                           static_cast<GLsizeiptr>(region.records * kTexelBytes * kTargets));
    gl_.BindImageTexture(gpu::kLookupRecordImage, region_.id(), 0, GL_FALSE, 0, access, GL_RGBA32F);
  }
  gl_.BindBufferRange(GL_SHADER_STORAGE_BUFFER, gpu::kLookupEntryBlock, captured.entries.id(),
                      static_cast<GLintptr>(region.first * kEntriesBytes),
                      static_cast<GLsizeiptr>(region.records * kEntriesBytes));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLookupListBlock, lists_.id());
}

std::int64_t LookupRecords::bytes() const {
  std::int64_t sum = targetBytes(resolution_);
  for (const Captured& captured : captured_) sum += bytesOf(captured);
  return sum;
}

std::int64_t LookupRecords::bytesOf(const Captured& captured) const {
  return captured.recordBytes + captured.entryBytes + (captured.mirrors.id() != 0 ? mirrorBytes(resolution_) : 0);
}

}  // namespace pb
