#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "report/result_json.h"

// One list of members a struct: members(list, value) names each of them once. Results are written by it, and
// what one computer of several has computed is written and read by it. A new member is one line.
namespace fsr::report {

/// Writes members as JSON. `exact`: for reading them again: all members, "nan" and "inf" too. Otherwise as
/// results: what is not finite is null, and members that only the program needs are left out.
class MembersWriter {
 public:
  explicit MembersWriter(bool exact) : exact_(exact) {}
  bool forResults() const { return !exact_; }
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
  /// A member that results do not have.
  template <typename T>
  MembersWriter& exact(const std::string& key, const T& value) {
    return exact_ ? (*this)(key, value) : *this;
  }
  /// A member that only results have.
  MembersWriter& result(const std::string& key, const Json& value) {
    if (!exact_) object[key] = value;
    return *this;
  }
  /// Members of a mapping inside this one.
  template <typename List>
  MembersWriter& under(const std::string& key, List list) {
    MembersWriter below(exact_);
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
  template <typename T>
  Json json(const std::optional<T>& value) const {
    return value ? json(*value) : Json(nullptr);
  }

 private:
  bool exact_;
};

/// Reads what an exact MembersWriter has written. Throws Json::exception where something is missing.
class MembersReader {
 public:
  explicit MembersReader(const Json& from) : from_(from) {}
  bool forResults() const { return false; }
  template <typename T>
  MembersReader& operator()(const std::string& key, T& value) {
    read(from_.at(key), value);
    return *this;
  }
  MembersReader& pair(const std::string& key, double& first, double& second) {
    read(from_.at(key).at(0), first);
    read(from_.at(key).at(1), second);
    return *this;
  }
  template <typename T>
  MembersReader& exact(const std::string& key, T& value) {
    return (*this)(key, value);
  }
  MembersReader& result(const std::string&, const Json&) { return *this; }
  template <typename List>
  MembersReader& under(const std::string& key, List list) {
    MembersReader below(from_.at(key));
    list(below);
    return *this;
  }

  template <typename T>
  static void read(const Json& from, T& value);

 private:
  template <typename T>
  static void read(const Json& from, std::vector<T>& values) {
    values.assign(from.size(), T());  // a plan has bandwidths from the beginning
    for (std::size_t i = 0; i < values.size(); ++i) read(from.at(i), values[i]);
  }
  template <typename T, std::size_t kSize>
  static void read(const Json& from, std::array<T, kSize>& values) {
    for (std::size_t i = 0; i < kSize; ++i) read(from.at(i), values[i]);
  }
  template <typename T>
  static void read(const Json& from, std::optional<T>& value) {
    if (!from.is_null()) read(from, value.emplace());
  }

  const Json& from_;
};

template <typename T>
Json MembersWriter::json(const T& value) const {
  if constexpr (std::is_enum_v<T>) {
    return static_cast<int>(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    if (!exact_ || std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  } else if constexpr (std::is_arithmetic_v<T> || std::is_convertible_v<T, std::string>) {
    return value;
  } else {
    MembersWriter below(exact_);
    members(below, const_cast<T&>(value));  // one list serves both directions; writing changes nothing
    return below.object;
  }
}

template <typename T>
void MembersReader::read(const Json& from, T& value) {
  if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(from.get<int>());
  } else if constexpr (std::is_floating_point_v<T>) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    value = from.is_number() ? from.get<T>()
            : from == "inf"  ? kInfinity
            : from == "-inf" ? -kInfinity
                             : std::numeric_limits<double>::quiet_NaN();
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    from.get_to(value);
  } else {
    MembersReader below(from);
    members(below, value);
  }
}

/// The members of a result.
template <typename T>
Json resultOf(const T& value) {
  return MembersWriter(false).json(value);
}

template <typename List>
void members(List& list, statistics::Spread& spread) {
  list("mean", spread.mean)("deviation", spread.deviation);
}

template <typename List>
void members(List& list, statistics::ErrorSummary& errors) {
  list("count", errors.count)("bias", errors.bias)("rmse", errors.rmse);
  list.pair("limits_95", errors.limit_low, errors.limit_high)("p95_absolute", errors.p95_absolute);
}

template <typename List>
void members(List& list, statistics::BinnedErrors::Directions& errors) {
  list("all", errors.all)("loading", errors.loading)("unloading", errors.unloading);
}

/// "100-200 kPa": the values of each pressure bin.
template <typename List, typename Bins>
void binMembers(List& list, const std::string& key, Bins& bins) {
  list.under(key, [&](auto& below) {
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
      below(statistics::pressureBinName(bin) + " kPa", bins[bin]);
  });
}

template <typename List>
void members(List& list, statistics::BinnedErrors& errors) {
  binMembers(list("whole", errors.whole), "bins", errors.bins);
}

template <typename List>
void members(List& list, dataset::SensorIdentity& sensor) {
  list("sensor_id", sensor.sensor_id)("serial", sensor.serial)("firmware", sensor.firmware);
  list("model", sensor.model)("sealing", sensor.sealing)("transducer", sensor.transducer);
}

template <typename List>
void members(List& list, matrix::Layout& layout) {
  list("rows", layout.size.rows)("columns", layout.size.columns);
  list("pitch_x", layout.pitch_x)("pitch_y", layout.pitch_y);
}

template <typename List>
void members(List& list, calibration::HistoryScore::Protocol& protocol) {
  list("protocol", protocol.name).under("rmse", [&](auto& rmse) {
    constexpr const char* kFamilies[] = {"static", "plays", "memories", "both"};
    for (std::size_t f = 0; f < protocol.rmse.size(); ++f) rmse(kFamilies[f], protocol.rmse[f]);
    rmse("correction_alone", protocol.corrected_rmse);
  });
}

template <typename List>
void members(List& list, calibration::HistoryScore::Part& part) {
  list("readings", part.name)("count", part.readings)("static_rmse", part.static_rmse)("rmse", part.rmse);
  list("within_one_deviation", part.within_one_deviation);
}

template <typename List>
void members(List& list, calibration::SourceBag& bag) {
  list("name", bag.name)("sha256", bag.sha256)("scans", bag.scans);
}

template <typename List>
void members(List& list, calibration::Provenance& provenance) {
  list("tool_version", provenance.tool_version)("date", provenance.date)("seed", provenance.seed);
  list("bags", provenance.bags)("conditioning", provenance.conditioning);
}

}  // namespace fsr::report
