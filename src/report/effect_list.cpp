#include "report/effect_list.h"

#include <nlohmann/json.hpp>

#include <cmath>

#include "settings/text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

template <typename Item>
std::string names(const std::vector<Item>& items) {
  return settings::joinedTexts(items, [](const Item& item) { return simulation::name(item); });
}

std::string line(const std::string& title, const std::string& text) {
  constexpr std::size_t kTitleWidth = 12;
  return text.empty() ? "" : "    " + title + std::string(kTitleWidth - title.size(), ' ') + text + "\n";
}

std::string parameterText(const simulation::EffectParameter& parameter) {
  const std::string& unit = parameter.permitted.unit;
  std::string text = "      " + parameter.name + (unit.empty() ? "" : " [" + unit + "]") + ": " +
                     parameter.meaning + "\n        " + simulation::name(parameter.role) + ", usual " +
                     settings::numberText(parameter.usual);
  if (!std::isnan(parameter.neutral)) text += ", neutral " + settings::numberText(parameter.neutral);
  text += ", plausible " + parameter.plausible.text() + ", permitted " + parameter.permitted.text();
  for (const double value : parameter.tried) {
    text += (value == parameter.tried.front() ? "; tried " : ", ") + settings::numberText(value);
  }
  if (parameter.of_range) text += "; all in proportion to the range of the pressure";
  return text + "\n";
}

}  // namespace

std::string effectText(const simulation::EffectInfo& info) {
  std::string text =
      info.id + ": " + info.summary + "\n" + line("equation", info.equation) + line("source", info.source) +
      line("kind", simulation::name(info.kind) + ", by " + simulation::name(info.level) + ", stage " +
                       simulation::name(info.stage) + ", sign " + simulation::name(info.sign)) +
      line("depends on", names(info.depends_on)) + line("needs", names(info.needs)) +
      line("looks like", settings::joined(info.collinear));
  if (info.experiment != simulation::Experiment::kNone)
    text += line("experiment", simulation::name(info.experiment));
  if (!info.parameters.empty()) text += "    parameters\n";
  for (const simulation::EffectParameter& parameter : info.parameters) text += parameterText(parameter);
  return text + "\n";
}

namespace {

bool listedOnly(const simulation::EffectEntry& entry) {
  return entry.info.kind == simulation::EffectKind::kListed;
}

}  // namespace

std::string effectListText() {
  std::string simulated, listed;
  for (const simulation::EffectEntry& entry : simulation::effectLibrary()) {
    (listedOnly(entry) ? listed : simulated) += effectText(entry.info);
  }
  return "Effects that can be simulated, in the order in which they act:\n\n" + simulated +
         "Effects that a gas chamber cannot show, with the experiment that would show them:\n\n" + listed;
}

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
