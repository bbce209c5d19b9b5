#include "report/study/study_parts_file.h"

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "report/study/study_fields.h"

namespace fsr::report {

namespace {

using Json = nlohmann::ordered_json;
using settings::InputError;

// --- writing ---------------------------------------------------------------------------------------

template <typename T>
Json stored(const T& value);

// JSON has no number that is not finite. A finite one is written with the digits that give it back exactly.
Json stored(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

Json stored(const study::CycleSums& sums) {
  return stored(sums.values());
}

template <typename T>
Json stored(const std::optional<T>& value) {
  return value ? stored(*value) : Json(nullptr);
}

template <typename List>
Json storedList(const List& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(stored(value));
  return list;
}
template <typename T>
Json stored(const std::vector<T>& values) {
  return storedList(values);
}
template <typename T, std::size_t kSize>
Json stored(const std::array<T, kSize>& values) {
  return storedList(values);
}

Json stored(const std::map<std::size_t, study::StudyPiece>& pieces) {
  Json list = Json::array();
  for (const auto& [number, piece] : pieces) list.push_back({{"piece", number}, {"result", stored(piece)}});
  return list;
}

template <typename T>
Json stored(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return static_cast<int>(value);
  } else if constexpr (std::is_integral_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else {
    Json object = Json::object();
    std::apply([&](const auto&... one) { ((object[one.name] = stored(value.*one.member)), ...); },
               Fields<T>::list);
    return object;
  }
}

// --- reading ---------------------------------------------------------------------------------------

template <typename T>
void read(const Json& from, T& value);

void read(const Json& from, double& value) {
  if (from.is_number()) {
    from.get_to(value);
    return;
  }
  const std::string text = from.get<std::string>();
  value = text == "nan"   ? std::numeric_limits<double>::quiet_NaN()
          : text == "inf" ? std::numeric_limits<double>::infinity()
                          : -std::numeric_limits<double>::infinity();
}

void read(const Json& from, study::CycleSums& sums) {
  study::CycleSums::Values values;
  read(from, values);
  const std::size_t models = values.cycles * values.models;
  if (values.readings.size() != models || values.squares.size() != models * values.taxels)
    throw InputError("sums of another size");
  sums = study::CycleSums(std::move(values));
}

template <typename T>
void read(const Json& from, std::optional<T>& value) {
  if (from.is_null()) return;
  value.emplace();
  read(from, *value);
}

template <typename T>
void read(const Json& from, std::vector<T>& values) {
  values.clear();  // a plan has bandwidths from the beginning
  for (const Json& one : from) {
    values.emplace_back();
    read(one, values.back());
  }
}
template <typename T, std::size_t kSize>
void read(const Json& from, std::array<T, kSize>& values) {
  for (std::size_t i = 0; i < kSize; ++i) read(from.at(i), values[i]);
}

void read(const Json& from, std::map<std::size_t, study::StudyPiece>& pieces) {
  for (const Json& one : from) read(one.at("result"), pieces[one.at("piece").get<std::size_t>()]);
}

template <typename T>
void read(const Json& from, T& value) {
  if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(from.get<int>());
  } else if constexpr (std::is_integral_v<T> || std::is_same_v<T, std::string>) {
    from.get_to(value);
  } else {
    std::apply([&](const auto&... one) { (read(from.at(one.name), value.*one.member), ...); },
               Fields<T>::list);
  }
}

// What is the same on all computers: all but the pieces and the date.
Json commonOf(const study::StudyParts& parts) {
  study::StudyParts common{parts.frame, parts.units, parts.pieces_of_study, {}};
  common.frame.provenance.date.clear();
  return stored(common);
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
  return stored(parts).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

study::StudyParts readStudyParts(const std::string& path) {
  study::StudyParts parts;
  try {
    read(Json::parse(std::ifstream(path)), parts);
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
  flatten("plan", stored(plan), options);
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
