#include "regression/regressors.h"

#include <array>
#include <locale>
#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/grnn/grnn.h"
#include "regression/regressor.h"

namespace fsr::regression {

Fit Regressor::fitSamples(const CodeSamples& training) const {
  const CodeHistogram histogram = histogramOf(training);
  return fit(histogram);
}

void Regressor::refuseSums() const {
  throw settings::InputError("model " + name() +
                             " needs the bags; the sums in a calibration file are not sufficient");
}

namespace {

template <typename T>
using Words = std::array<std::pair<T, const char*>, 2>;

constexpr Words<SpreadMeaning> kSpreads = {
    {{SpreadMeaning::kSigma, "sigma"}, {SpreadMeaning::kHalf, "matlab"}}};
constexpr Words<KernelDistance> kDistances = {
    {{KernelDistance::kSquared, "squared"}, {KernelDistance::kLiteral, "literal"}}};
constexpr Words<SampleWeighting> kWeightings = {
    {{SampleWeighting::kEachSample, "each_sample"}, {SampleWeighting::kEachPressureBin, "equal_bins"}}};
constexpr Words<LeafCount> kLeafRules = {{{LeafCount::kDraws, "draws"}, {LeafCount::kDistinct, "distinct"}}};

template <typename T>
std::vector<std::string> namesOf(const Words<T>& words) {
  return {words[0].second, words[1].second};
}

template <typename T>
std::string nameOf(T value, const Words<T>& words) {
  return words[value == words[0].first ? 0 : 1].second;
}

template <typename T>
T fromName(const std::string& what, const std::string& name, const Words<T>& words) {
  for (const auto& word : words) {
    if (name == word.second) return word.first;
  }
  throw settings::InputError(what + " is \"" + name + "\", but must be " + words[0].second + " or " +
                             words[1].second);
}

}  // namespace

std::vector<std::string> spreadNames() {
  return namesOf(kSpreads);
}
std::string spreadName(SpreadMeaning spread) {
  return nameOf(spread, kSpreads);
}
SpreadMeaning spreadFromName(const std::string& name) {
  return fromName("spread", name, kSpreads);
}

std::vector<std::string> distanceNames() {
  return namesOf(kDistances);
}
std::string distanceName(KernelDistance distance) {
  return nameOf(distance, kDistances);
}
KernelDistance distanceFromName(const std::string& name) {
  return fromName("distance", name, kDistances);
}

std::string weightingName(SampleWeighting weighting) {
  return nameOf(weighting, kWeightings);
}
SampleWeighting weightingFromName(const std::string& name) {
  return fromName("weighting", name, kWeightings);
}

std::vector<std::string> leafRuleNames() {
  return namesOf(kLeafRules);
}
std::string leafRuleName(LeafCount count) {
  return nameOf(count, kLeafRules);
}
LeafCount leafRuleFromName(const std::string& name) {
  return fromName("leaf_rule", name, kLeafRules);
}

std::optional<double> bandwidthFromText(const std::string& text) {
  if (text == "auto") return std::nullopt;
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  GrnnOptions options;
  if (!(stream >> options.bandwidth) || stream.peek() != std::istringstream::traits_type::eof()) {
    throw settings::InputError("bandwidth is \"" + text + "\", but must be auto, or a number of deviations");
  }
  validate(options);
  return options.bandwidth;
}

// Each is defined in the source of its regressor.
RegressorEntry linearEntry();
RegressorEntry grnnEntry();
RegressorEntry forestEntry();
RegressorEntry monotoneEntry();

const RegressorTable& packageRegressors() {
  static const RegressorTable table{{
      linearEntry(),
      grnnEntry(),
      forestEntry(),
      monotoneEntry(),
  }};
  return table;
}

const RegressorEntry* RegressorTable::find(const std::string& name) const {
  for (const RegressorEntry& entry : entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

const RegressorTable& tableOf(const RegressorOptions& options) {
  return options.table != nullptr ? *options.table : packageRegressors();
}

const RegressorEntry& entryOf(const RegressorOptions& options) {
  const RegressorTable& table = tableOf(options);
  if (const RegressorEntry* const entry = table.find(options.name)) return *entry;
  std::string known;
  for (const RegressorEntry& entry : table.entries)
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  throw settings::InputError("model is \"" + options.name + "\", but must be one of " + known);
}

std::vector<std::string> regressorNames() {
  std::vector<std::string> names;
  for (const RegressorEntry& entry : packageRegressors().entries) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<Regressor> makeRegressor(const RegressorOptions& options) {
  return entryOf(options).make(options);
}

}  // namespace fsr::regression
