// The folder of a run: what may be written there, and the journal that lets a killed run go on.
//
// run.json marks a folder as made by `probebench run` and says for which suite; journal.jsonl holds one finished cell a
// line, attribution.jsonl one attribution, kept/pictures.jsonl one cell that is rendered and not scored yet. A folder
// that is not empty and has no run.json, or one of another suite, is never touched.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/folder_lock.h"
#include "bench/results.h"

namespace pb {

struct RunIdentity {
  std::string suite;        // name
  std::string fingerprint;  // of everything that determines the numbers; a run goes on only with the same
};

class RunDirectory {
 public:
  // Makes the folder if it is absent. Without `resume` an earlier run of the same suite is removed. Throws an input
  // Error for a folder that may not be used, an environment Error for one that can't be written, or is in use.
  RunDirectory(std::filesystem::path folder, const RunIdentity& identity, bool resume);

  // finish() has written there.
  static bool hasResults(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path imagesFolder() const { return folder_ / "images"; }
  // Of pictures that the run still needs (bench/kept_pictures.h). It need not be there.
  std::filesystem::path keptFolder() const { return folder_ / "kept"; }

  // Cells that an earlier, killed run has finished; empty without `resume`.
  const std::vector<CellResult>& finishedCells() const { return finished_; }

  // Attributions likewise.
  const std::vector<Attribution>& finishedAttributions() const { return finishedAttributions_; }

  // Cells with kept pictures, without scores: of an earlier, killed run, and those that were appended. Not while others
  // are.
  const std::vector<CellResult>& keptCells() const { return kept_; }

  // Appends a finished cell or attribution to its journal. From any thread.
  void append(const CellResult& cell);
  void append(const Attribution& attribution);
  // The same of a cell whose picture stands in keptFolder().
  void appendKept(const CellResult& cell);

  // Removes keptFolder(), writes benchmark.json (unless empty), results.csv, report.md and, last, results.json: a run
  // with it is complete.
  void finish(const Results& results, const std::string& benchmarkJson);

 private:
  void remove(const std::filesystem::path& path) const;
  void removeEarlierRun() const;
  void readJournals();
  void appendLine(const char* name, const std::string& line);

  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;  // from the constructor on
  std::vector<CellResult> finished_, kept_;
  std::vector<Attribution> finishedAttributions_;
  std::mutex journalMutex_;
};

}  // namespace pb
