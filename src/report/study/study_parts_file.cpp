#include "report/study/study_parts_file.h"

#include <fstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/study/study_members.h"

namespace fsr::report {

namespace {

using settings::InputError;

template <typename T>
Json exactly(const T& value) {
  return MembersWriter(true).json(value);
}

// What is the same on all computers: all but the pieces and the date.
Json commonOf(const study::StudyParts& parts) {
  study::StudyParts common{parts.frame, parts.units, parts.pieces_of_study, {}};
  common.frame.provenance.date.clear();
  return exactly(common);
}

void flatten(const std::string& name, const Json& value, std::map<std::string, std::string>& options) {
  if (!value.is_object()) {
    options[name] = value.is_string() ? value.get<std::string>() : value.dump();
    return;
  }
  for (const auto& [key, below] : value.items()) flatten(name + "." + key, below, options);
}

}  // namespace

std::string studyPartsJson(const study::StudyParts& parts) {
  Json all = exactly(parts);
  all["computed"] = Json::array();
  for (const auto& [number, piece] : parts.computed)
    all["computed"].push_back({{"piece", number}, {"result", exactly(piece)}});
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

study::StudyParts readStudyParts(const std::string& path) {
  study::StudyParts parts;
  try {
    const Json all = Json::parse(std::ifstream(path));
    MembersReader::read(all, parts);
    for (const Json& one : all.at("computed"))
      MembersReader::read(one.at("result"), parts.computed[one.at("piece").get<std::size_t>()]);
  } catch (const std::exception&) {
    throw InputError(path + ": cannot be read as the pieces of a study; run this shard again");
  }
  return parts;
}

void addStudyParts(study::StudyParts other, const std::string& name, const std::string& first,
                   study::StudyParts& parts) {
  if (commonOf(other) != commonOf(parts))
    throw InputError(name + ": describes other recordings than " + first + "; run both shards again");
  for (auto& [number, piece] : other.computed) {
    if (!parts.computed.emplace(number, std::move(piece)).second)
      throw InputError(name + ": has piece " + std::to_string(number) +
                       " of the study, which is there already");
  }
}

std::map<std::string, std::string> studyOptions(const study::StudyPlan& plan) {
  std::map<std::string, std::string> options;
  flatten("plan", exactly(plan), options);
  // In the words of the plan's file.
  options["plan.down_sampling"] = study::downSamplingName(plan.down_sampling);
  options["plan.method_4"] =
      plan.binary_share == study::BinaryShare::kFullFlat ? "full_flat" : "half_and_half";
  options["plan.range"] = plan.range == study::ScoreRange::kHeldOut ? "held_out" : "all";
  options["plan.grnn.spread"] = plan.grnn.spread == regression::SpreadMeaning::kSigma ? "sigma" : "half";
  options["plan.grnn.distance"] =
      plan.grnn.distance == regression::KernelDistance::kSquared ? "squared" : "literal";
  options["plan.tests.normality_of"] =
      plan.tests.normality == statistics::NormalityOf::kEachTreatment ? "treatments" : "differences";
  if (plan.figure_taxel == study::StudyPlan{}.figure_taxel) options["plan.figure_taxel"] = "not given";
  return options;
}

}  // namespace fsr::report
