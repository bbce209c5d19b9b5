#include "fsr_pressure_map/report/effect_list.h"

#include <cmath>

#include "fsr_pressure_map/settings/yaml_text.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

template <typename Item>
std::string names(const std::vector<Item>& items) {
  std::string list;
  for (const Item& item : items) list += (list.empty() ? "" : ", ") + name(item);
  return list;
}

std::string line(const std::string& title, const std::string& text) {
  constexpr std::size_t kTitleWidth = 12;
  return text.empty() ? "" : "    " + title + std::string(kTitleWidth - title.size(), ' ') + text + "\n";
}

std::string parameterText(const EffectParameter& parameter) {
  const std::string& unit = parameter.permitted.unit;
  std::string text = "      " + parameter.name + (unit.empty() ? "" : " [" + unit + "]") + ": " +
                     parameter.meaning + "\n        " + name(parameter.role) + ", usual " +
                     numberText(parameter.usual);
  if (!std::isnan(parameter.neutral)) text += ", neutral " + numberText(parameter.neutral);
  text += ", plausible " + parameter.plausible.text() + ", permitted " + parameter.permitted.text();
  for (const double value : parameter.tried) {
    text += (value == parameter.tried.front() ? "; tried " : ", ") + numberText(value);
  }
  return text + "\n";
}

}  // namespace

std::string effectText(const EffectInfo& info) {
  std::string collinear;
  for (const std::string& id : info.collinear) collinear += (collinear.empty() ? "" : ", ") + id;
  std::string text = info.id + ": " + info.summary + "\n" + line("equation", info.equation) +
                     line("source", info.source) +
                     line("kind", name(info.kind) + ", by " + name(info.level) + ", stage " +
                                      name(info.stage) + ", sign " + name(info.sign)) +
                     line("depends on", names(info.depends_on)) + line("needs", names(info.needs)) +
                     line("looks like", collinear);
  if (info.experiment != Experiment::kNone) text += line("experiment", name(info.experiment));
  if (!info.parameters.empty()) text += "    parameters\n";
  for (const EffectParameter& parameter : info.parameters) text += parameterText(parameter);
  return text + "\n";
}

namespace {

bool listedOnly(const EffectEntry& entry) {
  return entry.info.kind == EffectKind::kListed;
}

}  // namespace

std::string effectListText() {
  std::string simulated, listed;
  for (const EffectEntry& entry : effectLibrary()) {
    (listedOnly(entry) ? listed : simulated) += effectText(entry.info);
  }
  return "Effects that can be simulated, in the order in which they act:\n\n" + simulated +
         "Effects that a gas chamber cannot show, listed with the experiment that would:\n\n" + listed;
}

}  // namespace fsr
