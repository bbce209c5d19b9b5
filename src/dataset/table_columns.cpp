#include "dataset/table_recording.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace fsr::dataset {

namespace {

const std::map<std::string, ColumnRole> kRoles = {
    {"time", ColumnRole::kTime},           {"reading", ColumnRole::kReading},
    {"reference", ColumnRole::kReference}, {"reference_time", ColumnRole::kReferenceTime},
    {"curvature", ColumnRole::kCurvature}, {"temperature", ColumnRole::kTemperature},
    {"surface", ColumnRole::kSurface},     {"mount", ColumnRole::kMount}};

// Units of a role; the first is the default. SI value = factor * (value + offset).
const std::vector<std::pair<std::string, TableUnit>>& unitsOf(ColumnRole role) {
  static const std::map<ColumnRole, std::vector<std::pair<std::string, TableUnit>>> units = {
      {ColumnRole::kTime, {{"s", {1}}, {"ms", {1e-3}}, {"us", {1e-6}}, {"min", {60}}}},
      {ColumnRole::kReferenceTime, {{"s", {1}}, {"ms", {1e-3}}, {"us", {1e-6}}, {"min", {60}}}},
      {ColumnRole::kReading,
       {{"counts", {1, 0, "counts"}},
        {"V", {1, 0, "V"}},
        {"mV", {1e-3, 0, "V"}},
        {"S", {1, 0, "S"}},
        {"mS", {1e-3, 0, "S"}},
        {"uS", {1e-6, 0, "S"}},
        {"ohm", {1, 0, "S", true}},
        {"kohm", {1e3, 0, "S", true}},
        {"Mohm", {1e6, 0, "S", true}}}},
      {ColumnRole::kReference,
       {{"kPa", {1e3}},
        {"Pa", {1}},
        {"MPa", {1e6}},
        {"bar", {1e5}},
        {"mbar", {100}},
        {"psi", {6894.757293168361}},
        {"mmHg", {133.322387415}},
        {"N", {1, 0, "N"}}}},
      {ColumnRole::kCurvature, {{"1/m", {1}}, {"1/cm", {100}}}},
      {ColumnRole::kTemperature, {{"C", {1}}, {"K", {1, -273.15}}, {"F", {5.0 / 9, -32}}}},
      {ColumnRole::kSurface, {{"", {1}}}},
      {ColumnRole::kMount, {{"", {1}}}}};
  return units.at(role);
}

const std::string& nameOf(ColumnRole role) {
  const auto is = [&](const auto& entry) { return entry.second == role; };
  return std::find_if(kRoles.begin(), kRoles.end(), is)->first;
}

template <typename Entries>
std::string listed(const Entries& entries) {
  std::string text;
  for (const auto& entry : entries) text += (text.empty() ? "" : ", ") + entry.first;
  return text;
}

// "2500Pa": a factor that the user gives. 0 where the text is not such a factor.
double ownFactor(const std::string& unit) {
  char* end = nullptr;
  const double factor = std::strtod(unit.c_str(), &end);
  return end != unit.c_str() && std::string(end) == "Pa" ? factor : 0;
}

TableColumn parseOne(const std::string& item) {
  const std::size_t equals = item.find('=');
  const auto role = kRoles.find(item.substr(0, equals));
  if (equals == std::string::npos || role == kRoles.end()) {
    throw settings::InputError("--columns holds \"" + item +
                               "\", but must be ROLE=COLUMN[:UNIT] with a role of " + listed(kRoles));
  }
  const std::string rest = item.substr(equals + 1);
  const std::size_t colon = rest.rfind(':');
  TableColumn column{role->second, rest.substr(0, colon), ""};
  if (colon != std::string::npos) column.unit = rest.substr(colon + 1);
  if (column.column.empty())
    throw settings::InputError("--columns holds \"" + item + "\", which has no column");
  unitOf(column);
  return column;
}

}  // namespace

TableUnit unitOf(const TableColumn& column) {
  const auto& units = unitsOf(column.role);
  if (column.unit.empty()) return units.front().second;
  for (const auto& [name, unit] : units) {
    if (name == column.unit) return unit;
  }
  const double factor = column.role == ColumnRole::kReference ? ownFactor(column.unit) : 0;
  if (factor > 0) return {factor};
  throw settings::InputError("--columns gives " + nameOf(column.role) + " the unit \"" + column.unit +
                             "\", but must be one of " + listed(units) +
                             (column.role == ColumnRole::kReference ? ", or e.g. 2500Pa for each unit" : ""));
}

std::vector<TableColumn> parseColumns(const std::string& text) {
  std::vector<TableColumn> columns;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) columns.push_back(parseOne(item));
  for (const auto& [name, role] : kRoles) {
    const auto is = [role = role](const TableColumn& column) { return column.role == role; };
    const auto number = std::count_if(columns.begin(), columns.end(), is);
    if (number > 1 && role != ColumnRole::kReading)
      throw settings::InputError("--columns names " + name + " twice; keep one");
    if (number == 0 && (role == ColumnRole::kReading || role == ColumnRole::kTime)) {
      throw settings::InputError("--columns names no " + name +
                                 ", but must hold time and at least one reading");
    }
  }
  return columns;
}

}  // namespace fsr::dataset
