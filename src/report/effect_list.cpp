#include "report/effect_list.h"

#include <cmath>

#include "settings/yaml_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::report {

namespace {

template <typename Item>
std::string names(const std::vector<Item>& items) {
  std::string list;
  for (const Item& item : items) list += (list.empty() ? "" : ", ") + simulation::name(item);
  return list;
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
  return text + "\n";
}

}  // namespace

std::string effectText(const simulation::EffectInfo& info) {
  std::string collinear;
  for (const std::string& id : info.collinear) collinear += (collinear.empty() ? "" : ", ") + id;
  std::string text =
      info.id + ": " + info.summary + "\n" + line("equation", info.equation) + line("source", info.source) +
      line("kind", simulation::name(info.kind) + ", by " + simulation::name(info.level) + ", stage " +
                       simulation::name(info.stage) + ", sign " + simulation::name(info.sign)) +
      line("depends on", names(info.depends_on)) + line("needs", names(info.needs)) +
      line("looks like", collinear);
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

}  // namespace fsr::report
