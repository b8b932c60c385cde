// The report as one HTML page that needs no network: results, pictures and charts of a run, or of two runs side by
// side.
#pragma once

#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

struct PageRun {
  std::string name;       // what the page calls it where there are two: "before", "after"
  std::string directory;  // where its pictures are
  const Results& results;
};

// Where a folder of a run or a report has its page.
std::string pageOfRun(const std::string& folder);

inline constexpr double kDefaultPageMb = 15;

// Writes `file`. Pictures with which it would be larger than maxMb (10^6 bytes) stand in a folder beside it: that of
// report.html is report-pictures/. The last run is the page's subject, one before it what it is compared with.
// `answer`: lines that say what was found, may be empty. Gives the pictures that can't be
// read, which the page is without. Throws environment Errors.
std::vector<std::string> writePage(const std::vector<PageRun>& runs, const std::vector<std::string>& answer,
                                   const std::string& file, double maxMb = kDefaultPageMb);

}  // namespace pb
