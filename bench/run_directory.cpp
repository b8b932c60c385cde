#include "bench/run_directory.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "bench/axes.h"
#include "bench/report.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kMarker = "run.json";
constexpr const char* kJournal = "journal.jsonl";
constexpr const char* kResults = "results.json";
constexpr const char* kAttributionJournal = "attribution.jsonl";
// What a run (and, for report.csv, `probebench report -o`) writes, and what it removes of an earlier one; nothing else
// in the folder is touched.
constexpr const char* kFiles[] = {kJournal,    kAttributionJournal, kResults,      "results.csv", "benchmark.json",
                                  "report.md", "report.csv",        "report.html", "ranking.json"};
constexpr const char* kKept = "kept";
constexpr const char* kKeptJournal = "kept/pictures.jsonl";
constexpr const char* kFolders[] = {"images", kKept, "report-pictures"};

void makeFolder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder))
    throwEnvironmentError("output folder '{}' can't be made: {}", folder.string(),
                          failure ? failure.message() : "a file of that name is there");
}

bool isEmpty(const fs::path& folder) {
  std::error_code failure;
  const fs::directory_iterator entries(folder, failure);
  if (failure) throwEnvironmentError("output folder '{}' can't be read: {}", folder.string(), failure.message());
  return entries == fs::directory_iterator();
}

// nullopt for a folder without the marker.
std::optional<RunIdentity> readMarker(const fs::path& folder) {
  const std::string path = (folder / kMarker).string();
  if (!fs::exists(path)) return std::nullopt;
  try {
    const Json marker = Json::parse(readFile(path));
    return RunIdentity{marker.at("suite").get<std::string>(), marker.at("fingerprint").get<std::string>()};
  } catch (const Json::exception&) {
    throwInputError("'{}' was not written by probebench, choose another --out", path);
  }
}

void writeMarker(const fs::path& folder, const RunIdentity& identity) {
  const Json marker = {{"suite", identity.suite}, {"fingerprint", identity.fingerprint}};
  writeFileAtomically((folder / kMarker).string(), marker.dump(2) + "\n");
}

// Calls `read` with each line of a journal and where it stands.
template <class Read>
void readLines(const std::string& path, const Read& read) {
  if (!fs::exists(path)) return;
  std::istringstream lines(readFile(path));
  std::string complete;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    // A kill may have torn the last line: it has no end, and what it was to hold is measured again.
    if (lines.eof()) break;
    read(line, fmt::format("{}:{}", path, ++number));
    complete += line + '\n';
  }
  writeFileAtomically(path, complete);
}

}  // namespace

RunDirectory::RunDirectory(fs::path folder, const RunIdentity& identity, bool resume) : folder_(std::move(folder)) {
  makeFolder(folder_);
  lock_.emplace(folder_);
  const std::optional<RunIdentity> earlier = readMarker(folder_);
  if (!earlier && !isEmpty(folder_))
    throwInputError("output folder '{}' is not empty and was not made by probebench, choose another --out",
                    folder_.string());
  if (earlier && earlier->suite != identity.suite)
    throwInputError("output folder '{}' holds a run of suite '{}', choose another --out for suite '{}'",
                    folder_.string(), earlier->suite, identity.suite);
  if (resume && earlier && earlier->fingerprint != identity.fingerprint)
    throwInputError("--resume wants the same suite, options, program and GL driver as the run in '{}' was started with",
                    folder_.string());
  if (earlier && !resume) removeEarlierRun();
  writeMarker(folder_, identity);
  makeFolder(imagesFolder());
  if (resume) readJournals();
}

void RunDirectory::remove(const fs::path& path) const {
  std::error_code failure;
  fs::remove_all(path, failure);
  if (failure) throwEnvironmentError("'{}' can't be removed: {}", path.string(), failure.message());
}

// What is a folder although it has the name of a file isn't ours, and stays.
void RunDirectory::removeEarlierRun() const {
  for (const char* file : kFiles)
    if (!fs::is_directory(folder_ / file)) remove(folder_ / file);
  for (const char* subfolder : kFolders) remove(folder_ / subfolder);
}

void RunDirectory::readJournals() {
  readLines((folder_ / kJournal).string(),
            [&](const std::string& line, const std::string& place) { finished_.push_back(cellFromJson(line, place)); });
  readLines((folder_ / kAttributionJournal).string(), [&](const std::string& line, const std::string& place) {
    finishedAttributions_.push_back(attributionFromJson(line, place));
  });
  readLines((folder_ / kKeptJournal).string(),
            [&](const std::string& line, const std::string& place) { kept_.push_back(cellFromJson(line, place)); });
}

void RunDirectory::append(const CellResult& cell) { appendLine(kJournal, toJson(cell)); }

void RunDirectory::append(const Attribution& attribution) { appendLine(kAttributionJournal, toJson(attribution)); }

void RunDirectory::appendKept(const CellResult& cell) {
  appendLine(kKeptJournal, toJson(cell));
  const std::lock_guard lock(journalMutex_);
  kept_.push_back(cell);
}

void RunDirectory::appendLine(const char* name, const std::string& line) {
  const std::lock_guard lock(journalMutex_);
  const std::string path = (folder_ / name).string();
  std::ofstream journal(path, std::ios::app | std::ios::binary);
  journal << line << '\n' << std::flush;
  if (!journal) throwEnvironmentError("'{}' can't be written: is the disk full or the folder read-only?", path);
}

bool RunDirectory::hasResults(const fs::path& folder) { return fs::exists(folder / kResults); }

void RunDirectory::finish(const Results& results, const std::string& benchmarkJson) {
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  remove(keptFolder());
  if (!benchmarkJson.empty()) writeFileAtomically(path("benchmark.json"), benchmarkJson);
  writeFileAtomically(path("results.csv"), toCsv(results, describe(Technique())));
  writeFileAtomically(path("report.md"), makeReport(results, describe(Technique())));
  writeFileAtomically(path(kResults), toJson(results));
}

}  // namespace pb
