#include "bench/report/page_pictures.h"

#include <tbb/parallel_for_each.h>

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "bench/report/packed_picture.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

// A file of the cells and what packing it gave.
struct Job {
  std::string file;
  std::optional<std::string> base;
  bool packed = true;
  int width = 0, height = 0;
  std::optional<std::string> bytes{};  // none: the file can't be read
};

// References first: the others are predicted from them.
std::vector<Job> jobsOf(const std::vector<CellResult>& cells) {
  std::vector<Job> jobs;
  std::set<std::string> known;
  const auto add = [&](Job job) {
    if (!job.file.empty() && known.insert(job.file).second) jobs.push_back(std::move(job));
  };
  for (const CellResult& cell : cells) add({cell.pictures.reference, std::nullopt});
  for (const CellResult& cell : cells) {
    add({cell.pictures.rendered, cell.pictures.reference});
    add({cell.pictures.flip, std::nullopt, false});
  }
  return jobs;
}

Image readPicture(const std::string& path) { return rgbOf(readImage(path).pixels); }

// Half floats of the references, by file; none of those that can't be read.
using References = std::map<std::string, std::vector<std::uint16_t>>;

References readReferences(const std::vector<Job>& jobs, const std::string& folder) {
  References references;
  for (const Job& job : jobs)
    if (job.base && !job.base->empty()) references.try_emplace(*job.base);
  tbb::parallel_for_each(references, [&](auto& reference) {
    try {
      reference.second = halfPlanes(readPicture(folder + reference.first));
    } catch (const Error&) {  // then what it belongs to is missing, too
    }
  });
  return references;
}

void pack(Job& job, const References& references, const std::string& folder) try {
  if (!job.packed) {
    job.bytes = readFile(folder + job.file);
    return;
  }
  const Image image = readPicture(folder + job.file);
  const auto reference = job.base ? references.find(*job.base) : references.end();
  if (reference != references.end() && reference->second.empty()) return;
  const bool isPredicted = reference != references.end() && reference->second.size() == 3 * image.size();
  if (!isPredicted) job.base.reset();
  job.width = image.width();
  job.height = image.height();
  const std::vector<std::uint16_t> none;
  job.bytes = packPicture(halfPlanes(image), image.width(), isPredicted ? reference->second : none);
} catch (const Error&) {  // a run whose folder was copied without its pictures still has its numbers
  job.bytes.reset();
}

}  // namespace

PagePictures packPictures(const std::vector<CellResult>& cells, const std::string& runDirectory) {
  std::vector<Job> jobs = jobsOf(cells);
  const std::string folder = runDirectory + '/';
  const References references = readReferences(jobs, folder);
  tbb::parallel_for_each(jobs, [&](Job& job) { pack(job, references, folder); });

  PagePictures pictures;
  std::map<std::string, std::size_t> blobOf;  // by content: a static probe and a fresh one may show the same
  for (Job& job : jobs) {
    if (!job.bytes) {
      pictures.missing.push_back(job.file);
      continue;
    }
    const auto [blob, isNew] =
        blobOf.try_emplace((job.base ? *job.base : "") + '\n' + *job.bytes, pictures.blobs.size());
    if (isNew) pictures.blobs.push_back(base64(*job.bytes));
    pictures.files[job.file] = {blob->second, job.packed, job.width, job.height, job.base};
    job.bytes.reset();
  }
  return pictures;
}

}  // namespace pb
