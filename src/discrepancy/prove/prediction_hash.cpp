#include "discrepancy/prove/prediction_hash.h"

#include <sstream>
#include <utility>

#include "settings/sha256.h"
#include "settings/yaml_text.h"
#include "simulation/simulation_text.h"
#include "simulation/taxel_curves.h"

namespace fsr::discrepancy {

namespace {

using Effects = std::vector<simulation::EnabledEffect>;

// Every field has a name and an end mark, so that different predictions have different texts.
void write(std::ostream& out, const Effects& effects) {
  for (const simulation::EnabledEffect& effect : effects) {
    out << effect.id << " {";
    for (const auto& [name, value] : effect.values)
      out << name << ": " << settings::numberText(value) << ", ";
    out << "only_taxels: [";
    for (const std::size_t taxel : effect.only_taxels) out << taxel << ", ";
    out << "], only_surfaces: [";
    for (const std::string& surface : effect.only_surfaces) out << settings::quotedText(surface) << ", ";
    out << "]} ";
  }
  out << "\n";
}

// File names are left out, because base.yaml and its table may be moved and renamed.
std::string contentOf(simulation::SimulationSettings simulation) {
  const auto curves = std::exchange(simulation.taxel_curves, nullptr);
  simulation.taxel_curves_file.clear();
  return simulation::simulationText(simulation) + (curves ? simulation::taxelCurvesText(*curves) : "");
}

std::string hashOfText(const std::string& text) {
  return settings::sha256(text.data(), text.size());
}

void writeFirst(std::ostream& out, const Effects& effects) {
  for (const simulation::EnabledEffect& effect : effects) {
    out << effect.id << "{";
    for (const auto& [name, value] : effect.values) out << name << "=" << value << ";";
    for (const std::size_t taxel : effect.only_taxels) out << taxel << ",";
    for (const std::string& surface : effect.only_surfaces) out << surface << ",";
    out << "}";
  }
  out << "\n";
}

void write(std::ostream& out, const ParameterSpread& spread) {
  out << "spread: ";
  for (std::size_t k = 0; k < spread.parameters.size(); ++k) {
    const ParameterSpread::Parameter& one = spread.parameters[k];
    out << one.effect << " " << one.name << (one.logarithmic ? " logarithm" : "") << ": [";
    for (const double covariance : spread.covariance[k]) out << settings::numberText(covariance) << ", ";
    out << "] ";
  }
  out << "cycles: " << spread.cycles << " groups: " << spread.groups
      << " between: " << settings::numberText(spread.between) << "\n";
}

bool hasDistribution(const Prediction& prediction) {
  const ParameterSpread& spread = prediction.spread;
  return !prediction.weights.empty() || !spread.parameters.empty() || !spread.covariance.empty() ||
         spread.cycles != 0 || spread.groups != 0 || spread.between != 0;
}

}  // namespace

std::string hashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  std::ostringstream text;
  const bool third = hasDistribution(prediction);
  text << (third ? "prediction, third form\neffects: " : "prediction, second form\neffects: ");
  write(text, prediction.effects);
  for (const Effects& rival : prediction.rivals) {
    text << "rival: ";
    write(text, rival);
  }
  text << "size: " << settings::numberText(prediction.size.low) << " to "
       << settings::numberText(prediction.size.high) << "\n";
  if (third) {
    text << "weights: ";
    for (const double weight : prediction.weights) text << settings::numberText(weight) << ", ";
    text << "\n";
    write(text, prediction.spread);
  }
  text << contentOf(simulation);
  return hashOfText(text.str());
}

std::string firstHashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  std::ostringstream text;
  text.precision(9);
  writeFirst(text, prediction.effects);
  for (const Effects& rival : prediction.rivals) writeFirst(text, rival);
  text << prediction.size.low << " " << prediction.size.high << "\n";
  text << simulation.layout.size.rows << " x " << simulation.layout.size.columns << "\n";
  writeFirst(text, simulation.effects);
  return hashOfText(text.str());
}

bool hasItsHash(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  return prediction.hash == hashOf(prediction, simulation) ||
         (!hasDistribution(prediction) && prediction.hash == firstHashOf(prediction, simulation));
}

}  // namespace fsr::discrepancy
