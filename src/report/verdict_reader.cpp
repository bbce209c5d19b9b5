#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "settings/regular_file.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

constexpr std::size_t kSha256Digits = 64;

// A mapping of the file. It must have all of the given keys. Others than these and the optional ones are
// errors.
class Mapping {
 public:
  Mapping(const std::string& file, const YAML::Node& node, const std::string& field,
          const std::vector<std::string>& keys, const std::vector<std::string>& optional = {})
      : file_(file), field_(field), node_(node) {
    if (!node.IsMap()) fail("", "must be a mapping with the keys " + joined(keys));
    for (const auto& entry : node) {
      const std::string key = entry.first.Scalar();
      const bool known = std::find(keys.begin(), keys.end(), key) != keys.end() ||
                         std::find(optional.begin(), optional.end(), key) != optional.end();
      if (!known) fail(key, "is unknown here; known are " + joined(keys));
    }
    for (const std::string& key : keys) {
      if (!node[key]) fail(key, "is missing");
    }
  }

  YAML::Node operator[](const std::string& key) const { return node_[key]; }

  template <typename Value>
  Value as(const std::string& key, const std::string& kind) const {
    try {
      return node_[key].as<Value>();
    } catch (const YAML::Exception&) {
      fail(key, "must be " + kind);
    }
  }

  std::vector<Mapping> list(const std::string& key, const std::vector<std::string>& keys) const {
    if (!node_[key].IsSequence()) fail(key, "must be a list");
    std::vector<Mapping> entries;
    for (std::size_t i = 0; i < node_[key].size(); ++i) {
      entries.emplace_back(file_, node_[key][i], path(key) + "[" + std::to_string(i) + "]", keys);
    }
    return entries;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& complaint) const {
    const std::string where = path(key);
    throw settings::InputError(file_ + ": " + (where.empty() ? "" : where + " ") + complaint);
  }

 private:
  std::string path(const std::string& key) const {
    return field_.empty() || key.empty() ? field_ + key : field_ + "." + key;
  }
  static std::string joined(const std::vector<std::string>& keys) {
    std::string all;
    for (const std::string& key : keys) all += (all.empty() ? "" : ", ") + key;
    return all;
  }

  std::string file_, field_;
  YAML::Node node_;
};

constexpr std::uint64_t kLargestFile = 2 << 20;  // [bytes]

YAML::Node load(const std::string& path) {
  try {
    return YAML::Load(settings::RegularFile(path, kLargestFile).rest());
  } catch (const YAML::Exception& error) {
    throw settings::InputError(path + ": is not valid YAML (" + error.what() + ")");
  }
}

void requireVerdict(const Mapping& file, const std::string& verdict) {
  std::string known;
  for (const discrepancy::Verdict one :
       {discrepancy::Verdict::kNone, discrepancy::Verdict::kUnknown, discrepancy::Verdict::kAmbiguous,
        discrepancy::Verdict::kWrongForm, discrepancy::Verdict::kNamed,
        discrepancy::Verdict::kNotIdentifiable}) {
    if (verdict == discrepancy::name(one)) return;
    known += (known.empty() ? "" : ", ") + discrepancy::name(one);
  }
  file.fail("verdict", "is \"" + verdict + "\", but must be one of " + known);
}

void requireEffect(const Mapping& file, const std::string& key, const std::string& id) {
  if (simulation::findEffect(id) == nullptr)
    file.fail(key, "is \"" + id + "\", but the library has no effect of this name");
}

std::vector<std::string> readEffects(const Mapping& file) {
  std::vector<std::string> ids;
  for (const Mapping& effect : file.list("effects", {"id", "parameters", "evidence"})) {
    ids.push_back(effect.as<std::string>("id", "text"));
    requireEffect(effect, "id", ids.back());
    effect.list("parameters", {"name", "value", "unit", "interval"});
  }
  return ids;
}

std::vector<discrepancy::InputUse> readInputs(const Mapping& file) {
  std::vector<discrepancy::InputUse> inputs;
  for (const Mapping& input : file.list("inputs", {"file", "sha256", "show_opened"})) {
    discrepancy::InputUse use;
    use.file = input.as<std::string>("file", "text");
    use.sha256 = input.as<std::string>("sha256", "text");
    if (use.sha256.size() != kSha256Digits) input.fail("sha256", "must have 64 hexadecimal digits");
    use.hold_out_opened = input.as<int>("show_opened", "a whole number");
    if (use.hold_out_opened < 0) input.fail("show_opened", "must be 0 or more");
    inputs.push_back(use);
  }
  return inputs;
}

// Nanoseconds of a stamp in seconds. A floating point number would lose the last of them.
std::optional<std::int64_t> stampOf(const std::string& text) {
  constexpr std::size_t kSeconds = 10, kDigits = 9;  // before and after the point
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, point) + (point < text.size() ? text.substr(point + 1) : "");
  const std::size_t fraction = digits.size() - point;
  const bool number = !digits.empty() && point <= kSeconds && fraction <= kDigits &&
                      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!number) return std::nullopt;
  digits.append(kDigits - fraction, '0');
  const std::uint64_t stamp = std::stoull(digits);  // of 19 digits, so it fits
  if (stamp > std::numeric_limits<std::int64_t>::max()) return std::nullopt;
  return static_cast<std::int64_t>(stamp);
}

std::vector<discrepancy::HoldOutCycles> readHoldOut(const Mapping& file) {
  using Cycles = std::vector<std::pair<std::string, std::string>>;
  const std::string kind = "a list of [first, last] stamps";
  std::vector<discrepancy::HoldOutCycles> bags;
  for (const Mapping& bag : file.list("hold_out", {"file", "cycles"})) {
    bags.push_back({bag.as<std::string>("file", "text"), {}});
    for (const auto& [first, last] : bag.as<Cycles>("cycles", kind)) {
      const auto from = stampOf(first), to = stampOf(last);
      if (!from || !to) bag.fail("cycles", "must be " + kind);
      if (*from > *to) bag.fail("cycles", "must have no cycle that ends before it begins");
      bags.back().cycles.emplace_back(*from, *to);
    }
  }
  return bags;
}

double statedGap(const Mapping& file, const std::string& key) {
  const YAML::Node gap = file["gap"];
  if (!gap.IsMap() || !gap[key]) file.fail("gap", "must be a mapping with the keys before and after");
  if (gap[key].IsNull()) return NAN;
  try {
    return gap[key].as<double>();
  } catch (const YAML::Exception&) {
    file.fail("gap." + key, "must be a number or null");
  }
}

std::vector<discrepancy::SurfaceGap> statedSurfaces(const Mapping& file) {
  std::vector<discrepancy::SurfaceGap> surfaces;
  try {
    for (const YAML::Node& one : file["gap"]["surfaces"])
      surfaces.push_back(
          {one["surface"].as<std::string>(), one["before"].as<double>(), one["after"].as<double>()});
  } catch (const YAML::Exception&) {
    file.fail("gap.surfaces", "must be a list of mappings with surface, before and after");
  }
  return surfaces;
}

}  // namespace

VerdictFile readVerdict(const std::string& path) {
  const Mapping file(
      path, load(path), "",
      {"verdict", "effects", "credible_set", "depends_on", "not_identifiable", "where", "gap", "hold_out",
       "recompute", "next_experiment", "seed", "version", "inputs"},
      {"p", "at_map", "least_gap", "in_use", "smallest_seen", "too_small", "scatter", "asked", "prediction"});
  VerdictFile verdict;
  verdict.verdict = file.as<std::string>("verdict", "text");
  requireVerdict(file, verdict.verdict);
  verdict.effects = readEffects(file);
  verdict.credible_set =
      file.as<std::vector<std::vector<std::string>>>("credible_set", "a list of lists of ids");
  for (const auto& ids : verdict.credible_set) {
    for (const std::string& id : ids) requireEffect(file, "credible_set", id);
  }
  file.as<std::vector<std::string>>("depends_on", "a list of covariates");
  file.list("not_identifiable", {"id", "experiment"});
  verdict.hold_out = readHoldOut(file);
  verdict.gap_before = statedGap(file, "before");
  verdict.gap_after = statedGap(file, "after");
  verdict.gap_surfaces = statedSurfaces(file);
  verdict.seed = file.as<std::uint64_t>("seed", "a whole number");
  verdict.version = file.as<std::string>("version", "text");
  verdict.inputs = readInputs(file);
  return verdict;
}

}  // namespace fsr::report
