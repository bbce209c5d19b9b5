#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/verdict_file.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

constexpr std::size_t kSha256Digits = 64;

// A mapping of the file. It must have all of the given keys and no others.
class Mapping {
 public:
  Mapping(const std::string& file, const YAML::Node& node, const std::string& field,
          const std::vector<std::string>& keys)
      : file_(file), field_(field), node_(node) {
    if (!node.IsMap()) fail("", "must be a mapping with the keys " + joined(keys));
    for (const auto& entry : node) {
      const std::string key = entry.first.Scalar();
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        fail(key, "is unknown here; known are " + joined(keys));
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

YAML::Node load(const std::string& path) {
  try {
    return YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw settings::InputError(path +
                               ": cannot be opened; give the verdict.yaml of an earlier discrepancy run");
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

}  // namespace

VerdictFile readVerdict(const std::string& path) {
  const Mapping file(path, load(path), "",
                     {"verdict", "effects", "credible_set", "depends_on", "not_identifiable", "where", "gap",
                      "next_experiment", "seed", "version", "inputs"});
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
  verdict.seed = file.as<std::uint64_t>("seed", "a whole number");
  verdict.version = file.as<std::string>("version", "text");
  verdict.inputs = readInputs(file);
  return verdict;
}

}  // namespace fsr::report
