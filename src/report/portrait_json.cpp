#include "report/portrait_json.h"

#include <nlohmann/json.hpp>

namespace fsr::report {

namespace {

using SortedJson = nlohmann::json;

constexpr double kPerCent = 100;
constexpr double kPerKilopascal = 1e-3;

SortedJson scaled(const std::vector<double>& values, double factor) {
  SortedJson list = SortedJson::array();
  for (const double value : values) list.push_back(factor * value);
  return list;
}

SortedJson lines(const std::vector<simulation::PortraitLine>& all, double x_factor, double y_factor) {
  SortedJson list = SortedJson::array();
  for (const simulation::PortraitLine& line : all) {
    list.push_back({{"label", line.label}, {"x", scaled(line.x, x_factor)}, {"y", scaled(line.y, y_factor)}});
  }
  return list;
}

SortedJson map(const std::vector<double>& values, matrix::MatrixSize size) {
  SortedJson rows = SortedJson::array();
  for (std::size_t row = 0; row < size.rows; ++row) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * size.columns);
    rows.push_back(scaled({first, first + size.columns}, kPerCent));
  }
  return rows;
}

}  // namespace

std::string portraitJson(const simulation::Portrait& portrait) {
  const SortedJson result = {{"title", portrait.title},
                       {"response", lines(portrait.response, kPerKilopascal, kPerCent)},
                       {"loop", lines(portrait.loop, kPerKilopascal, kPerCent)},
                       {"hold", lines(portrait.hold, 1, kPerCent)},
                       {"hold_pressure", lines({portrait.hold_pressure}, 1, kPerKilopascal)},
                       {"disc", map(portrait.disc, portrait.size)},
                       {"disc_change", map(portrait.disc_change, portrait.size)},
                       {"gas_change", map(portrait.gas_change, portrait.size)}};
  return result.dump() + "\n";
}

}  // namespace fsr::report
