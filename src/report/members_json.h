#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

// One list of members a struct: members(list, value) names each of them once. Results are written by it. A
// new member is one line.
namespace fsr::report {

/// Writes members as JSON. What is not finite is null.
class MembersWriter {
 public:
  template <typename T>
  MembersWriter& operator()(const std::string& key, const T& value) {
    object[key] = json(value);
    return *this;
  }
  /// Two numbers in one list.
  MembersWriter& pair(const std::string& key, double first, double second) {
    object[key] = Json::array({json(first), json(second)});
    return *this;
  }
  /// Members of a mapping inside this one.
  template <typename List>
  MembersWriter& under(const std::string& key, List list) {
    MembersWriter below;
    list(below);
    object[key] = below.object;
    return *this;
  }

  Json object = Json::object();

  template <typename T>
  Json json(const T& value) const;
  template <typename List>
  Json listOf(const List& values) const {
    Json list = Json::array();
    for (const auto& value : values) list.push_back(json(value));
    return list;
  }
  template <typename T>
  Json json(const std::vector<T>& values) const {
    return listOf(values);
  }
  template <typename T, std::size_t kSize>
  Json json(const std::array<T, kSize>& values) const {
    return listOf(values);
  }
  template <typename First, typename Second>
  Json json(const std::pair<First, Second>& values) const {
    return Json::array({json(values.first), json(values.second)});
  }
};

template <typename T>
Json MembersWriter::json(const T& value) const {
  if constexpr (std::is_arithmetic_v<T> || std::is_convertible_v<T, std::string>) {
    return value;
  } else {
    MembersWriter below;
    members(below, value);
    return below.object;
  }
}

/// The members of a result.
template <typename T>
Json resultOf(const T& value) {
  return MembersWriter().json(value);
}

inline void members(MembersWriter& list, const statistics::Spread& spread) {
  list("mean", spread.mean)("deviation", spread.deviation);
}

inline void members(MembersWriter& list, const statistics::ErrorSummary& errors) {
  list("count", errors.count)("bias", errors.bias)("rmse", errors.rmse);
  list.pair("limits_95", errors.limit_low, errors.limit_high)("p95_absolute", errors.p95_absolute);
}

inline void members(MembersWriter& list, const statistics::BinnedErrors::Directions& errors) {
  list("all", errors.all)("loading", errors.loading)("unloading", errors.unloading);
}

/// "100-200 kPa": the values of each pressure bin.
template <typename Bins>
void binMembers(MembersWriter& list, const std::string& key, const Bins& bins) {
  list.under(key, [&](MembersWriter& below) {
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
      below(statistics::pressureBinName(bin) + " kPa", bins[bin]);
  });
}

inline void members(MembersWriter& list, const statistics::BinnedErrors& errors) {
  binMembers(list("whole", errors.whole), "bins", errors.bins);
}

inline void members(MembersWriter& list, const dataset::SensorIdentity& sensor) {
  list("sensor_id", sensor.sensor_id)("serial", sensor.serial)("firmware", sensor.firmware);
  list("model", sensor.model)("sealing", sensor.sealing)("transducer", sensor.transducer);
}

inline void members(MembersWriter& list, const calibration::HistoryScore::Protocol& protocol) {
  list("protocol", protocol.name).under("rmse", [&](MembersWriter& rmse) {
    constexpr const char* kFamilies[] = {"static", "plays", "memories", "both"};
    for (std::size_t f = 0; f < protocol.rmse.size(); ++f) rmse(kFamilies[f], protocol.rmse[f]);
    rmse("correction_alone", protocol.corrected_rmse);
  });
}

inline void members(MembersWriter& list, const calibration::SourceBag& bag) {
  list("name", bag.name)("sha256", bag.sha256)("scans", bag.scans);
}

inline void members(MembersWriter& list, const calibration::Provenance& provenance) {
  list("tool_version", provenance.tool_version)("date", provenance.date)("seed", provenance.seed);
  list("bags", provenance.bags)("conditioning", provenance.conditioning);
}

}  // namespace fsr::report
