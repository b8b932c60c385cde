// Rates of earlier runs, and what they say about the time of a plan.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/counted.h"
#include "bench/work.h"
#include "scenes/files.h"

namespace pb {
namespace {

using Json = nlohmann::ordered_json;

// What runs do one after the other, in that order.
constexpr const char* kDeciding = "deciding";
constexpr const char* kIntervals = "intervals";
constexpr const char* kKinds[] = {"control", kDeciding, "references", "errors", kIntervals, "attribution", "cost"};

}  // namespace

Rates::Rates(const std::filesystem::path& folder, std::string machine)
    : file_(folder / "rates.json"), machine_(std::move(machine)) {
  try {
    const Json document = Json::parse(readFile(file_.string()));
    for (const auto& [where, list] : document.items())
      for (const Json& entry : list) {
        const Measured measured{entry.at("units").get<double>(), entry.at("seconds").get<double>()};
        if (measured.units > 0 && measured.seconds >= 0)
          measured_[where][{entry.at("kind").get<std::string>(), entry.at("scene").get<std::string>()}] = measured;
      }
  } catch (const std::exception&) {
    measured_.clear();  // absent or damaged: it only tells how long things take
  }
}

std::optional<double> Rates::secondsPerUnit(const WorkKind& kind) const {
  const auto here = measured_.find(machine_);
  if (here == measured_.end()) return std::nullopt;
  if (const auto own = here->second.find(kind); own != here->second.end())
    return own->second.seconds / own->second.units;
  Measured all;
  for (const auto& [other, measured] : here->second)
    if (other.first == kind.first) all = {all.units + measured.units, all.seconds + measured.seconds};
  return all.units > 0 ? std::optional(all.seconds / all.units) : std::nullopt;
}

void Rates::record(const WorkKind& kind, double units, double seconds) {
  if (Measured& known = measured_[machine_][kind]; units > 0.5 * known.units) known = {units, seconds};
}

void Rates::record(const std::vector<Phase>& phases, const PlanWork& work) {
  std::map<WorkKind, double> seconds;  // scenes may have one name
  for (const Phase& phase : phases) seconds[kindOfPhase(phase.name, work.suite)] += phase.seconds;
  for (const auto& [kind, time] : seconds)
    if (const auto units = work.units.find(kind); units != work.units.end()) record(kind, units->second, time);
}

void Rates::save() const {
  Json document = Json::object();
  for (const auto& [machine, entries] : measured_)
    for (const auto& [kind, measured] : entries)
      document[machine].push_back(
          {{"kind", kind.first}, {"scene", kind.second}, {"units", measured.units}, {"seconds", measured.seconds}});
  try {
    std::filesystem::create_directories(file_.parent_path());
    writeFileAtomically(file_.string(), document.dump(1) + "\n");
  } catch (const std::exception&) {  // a run doesn't fail for want of them
  }
}

std::string printWork(const PlanWork& work, const Rates& rates) {
  std::string text = fmt::format(
      "distinct renders: at most {}, {} stored; {}, of which {} share another's captures, with {:.0f} captured faces; "
      "{} of frames for "
      "cost\n",
      counted(work.references, "reference"), work.stored, counted(work.frames, "raster frame"), work.sharing,
      work.captures, counted(work.blocks, "block"));
  if (const auto& [images, traced, captured] = work.attribution; images > 0)
    text += fmt::format("attribution renders {} from {} traced and {} captured sets of maps\n",
                        counted(images, "image"), traced, captured);
  std::map<std::string, double> seconds;
  std::set<std::string> unknown;
  const auto add = [&](const WorkKind& kind, double units, const std::string& name) {
    if (const std::optional<double> rate = rates.secondsPerUnit(kind))
      seconds[name] += *rate * units;
    else
      unknown.insert(name);
  };
  for (const auto& [kind, units] : work.units) {
    add(kind, units, kind.first);
    if (work.untilDecided && kind.first == kIntervals) add(kind, units, kDeciding);
  }
  if (work.untilDecided) text += "--until-decided renders them first, and scores the last ones at least once more\n";
  std::vector<std::string> known, missing;
  double total = 0;
  for (const char* kind : kKinds) {
    if (unknown.contains(kind))
      missing.emplace_back(kind);
    else if (const auto time = seconds.find(kind); time != seconds.end()) {
      total += time->second;
      known.push_back(fmt::format("{} {}", kind, printDuration(time->second)));
    }
  }
  if (known.empty()) return text + "no rates measured yet on this machine: how long it takes is not known\n";
  text += fmt::format("should take about {} ({}), by the rates of earlier runs", printDuration(total),
                      fmt::join(known, ", "));
  if (!missing.empty()) text += fmt::format("; no rates measured yet for {}", fmt::join(missing, ", "));
  if (work.untilDecided)
    text += "; --until-decided may ask for more samples";
  else if (work.mayRefine && work.stored < work.references)
    text += "; max_noise may ask for more samples";
  return text + '\n';
}

}  // namespace pb
