#include "bench/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "bench/json_document.h"
#include "bench/metric_audit.h"
#include "bench/report/comparison.h"
#include "bench/report/orders.h"
#include "bench/report/packed_picture.h"
#include "bench/report/page_pictures.h"
#include "bench/report/page_source.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

std::string escapedHtml(const std::string& text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

// JSON may stand in a script element if nothing in it can end that.
std::string inlineJson(const Json& json) {
  std::string text;
  for (const char c : printLine(json))
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

// Beside the page, for pictures that have no place in it.
std::string picturesFolderOf(const std::string& page) {
  const fs::path path = page;
  return (path.parent_path() / (path.stem().string() + "-pictures")).string();
}

// Where the blobs of the page go: into it, or beside it.
class Blobs {
 public:
  explicit Blobs(const std::string& page) : folder_(picturesFolderOf(page)) {}

  // Always in the page.
  std::size_t addInline(const std::string& base64) {
    text_ += fmt::format("<script type=\"text/plain\" id=\"blob-{}\">{}</script>\n", count_, base64);
    return count_++;
  }

  // Returns the number of the first.
  std::size_t addPictures(const std::vector<std::string>& blobs, bool beside) {
    const std::size_t first = count_;
    if (beside) makeFolder();
    for (const std::string& blob : blobs) {
      if (!beside) {
        addInline(blob);
        continue;
      }
      writeFileAtomically((folder_ / fmt::format("{}.js", count_)).string(),
                          fmt::format("probebenchBlob({}, \"{}\");\n", count_, blob));
      ++count_;
    }
    return first;
  }

  // Of an earlier report, with more pictures than this one may have.
  void removeFolder() const {
    std::error_code failure;
    fs::remove_all(folder_, failure);
    if (failure) throwEnvironmentError("'{}' can't be removed: {}", folder_.string(), failure.message());
  }

  std::string folderName() const { return folder_.filename().string(); }
  const std::string& text() const { return text_; }

 private:
  void makeFolder() const {
    std::error_code failure;
    fs::create_directories(folder_, failure);
    if (failure) throwEnvironmentError("can't make directory '{}': {}", folder_.string(), failure.message());
  }

  fs::path folder_;
  std::string text_;
  std::size_t count_ = 0;
};

// Of the page with everything in it, but for some kilobytes.
std::size_t pageBytes(const std::vector<std::string>& results, const std::vector<PagePictures>& pictures) {
  std::size_t bytes = sizeof(kPageSource);
  for (const std::string& text : results) bytes += text.size();
  for (const PagePictures& run : pictures)
    for (const std::string& blob : run.blobs) bytes += blob.size();
  return bytes;
}

Json picturesToJson(const PagePictures& pictures, std::size_t firstBlob) {
  Json json = Json::object();
  for (const auto& [file, picture] : pictures.files) {
    Json& entry = json[file] = {{"blob", firstBlob + picture.blob}, {"packed", picture.packed}};
    if (!picture.packed) continue;
    entry["width"] = picture.width;
    entry["height"] = picture.height;
    if (picture.base) entry["base"] = *picture.base;
  }
  return json;
}

// Pairs of cells that the metrics order oppositely, those with pictures first.
Json disputesToJson(const std::vector<CellResult>& cells) {
  constexpr std::size_t kListed = 50, kShown = 4;
  MetricAudit audit = auditMetrics(cells, kListed);
  std::ranges::stable_partition(audit.disputes, [](const MetricDispute& dispute) {
    return !dispute.byFlip->pictures.rendered.empty() && !dispute.byRelmse->pictures.rendered.empty();
  });
  if (audit.disputes.size() > kShown) audit.disputes.resize(kShown);
  Json json = {{"count", audit.disputed}, {"shown", Json::array()}};
  for (const MetricDispute& dispute : audit.disputes)
    json["shown"].push_back({{"byFlip", dispute.byFlip - cells.data()},
                             {"byRelmse", dispute.byRelmse - cells.data()},
                             {"flipFactor", encodeNumber(dispute.flipFactor)},
                             {"relmseFactor", encodeNumber(dispute.relmseFactor)}});
  return json;
}

// The page has what follows from them.
Results withoutReplicates(Results results) {
  for (CellResult& cell : results.cells) cell.replicates = cell.maskReplicates = {};
  return results;
}

std::string replaced(std::string text, const std::string& mark, const std::string& with) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw std::logic_error("the page's template lacks " + mark);
  return text.replace(at, mark.size(), with);
}

}  // namespace

std::string pageOfRun(const std::string& folder) { return (fs::path(folder) / "report.html").string(); }

std::vector<std::string> writePage(const std::vector<PageRun>& runs, const std::vector<std::string>& answer,
                                   const std::string& file, double maxMb) {
  std::vector<PagePictures> pictures;
  std::vector<std::string> results;
  for (const PageRun& run : runs) {
    pictures.push_back(packPictures(run.results.cells, run.directory));
    results.push_back(base64(deflate(toJson(withoutReplicates(run.results)))));
  }
  const bool beside = static_cast<double>(pageBytes(results, pictures)) > 1e6 * maxMb;

  Blobs blobs(file);
  blobs.removeFolder();
  Json meta = {{"answer", answer}, {"beside", beside ? Json(blobs.folderName()) : Json()}, {"runs", Json::array()}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t resultsBlob = blobs.addInline(results[i]);
    const std::size_t firstBlob = blobs.addPictures(pictures[i].blobs, beside);
    meta["runs"].push_back({{"name", runs[i].name},
                            {"results", resultsBlob},
                            {"pictures", picturesToJson(pictures[i], firstBlob)},
                            {"missing", pictures[i].missing.size()}});
  }
  if (runs.size() == 2) meta["comparison"] = toJson(compareRuns(runs[0].results, runs[1].results));

  meta["orders"] = ordersToJson(runs.back().results.cells);
  meta["disputes"] = disputesToJson(runs.back().results.cells);

  const std::string& suite = runs.back().results.provenance.suiteName;
  const std::string data =
      fmt::format("<script type=\"application/json\" id=\"meta\">{}</script>\n{}", inlineJson(meta), blobs.text());
  const std::string page = replaced(kPageSource, "@title", escapedHtml(suite));
  writeFileAtomically(file, replaced(page, "@data", data));

  std::vector<std::string> missing;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const std::string& picture : pictures[i].missing) missing.push_back(runs[i].directory + '/' + picture);
  return missing;
}

}  // namespace pb
