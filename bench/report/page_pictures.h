// The pictures of a run for the report's page: each once, whatever the number of cells that show it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

// What the page needs to know of a picture file.
struct PagePicture {
  std::size_t blob = 0;             // index into PagePictures::blobs
  bool packed = true;               // packPicture(); else the bytes of a PNG file
  int width = 0, height = 0;        // of packed ones
  std::optional<std::string> base;  // the file that it is predicted from, packed without a base itself
};

struct PagePictures {
  std::map<std::string, PagePicture> files;  // by path, as the cells name them
  std::vector<std::string> blobs;            // base64
  std::vector<std::string> missing;          // files that can't be read, in the order of the cells
};

// Reads the pictures of the cells from the run's folder and packs them, on all cores.
PagePictures packPictures(const std::vector<CellResult>& cells, const std::string& runDirectory);

}  // namespace pb
