// Which techniques are better than which by more than noise, for the page: bench/differences.h knows, and the page
// asks.
#pragma once

#include <vector>

#include "bench/json_document.h"
#include "bench/results.h"

namespace pb {

// Of each scene, camera, metric with an interval, and region where there is noise: {"metric", "region", "cells": index
// of the first cell of each technique, "better": by technique a text with a '1' for each one that it is better than}.
// Without noise values alone decide.
Json ordersToJson(const std::vector<CellResult>& cells);

}  // namespace pb
