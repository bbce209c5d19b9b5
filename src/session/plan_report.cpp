#include "session/plan_report.h"

#include <cmath>

#include "calibration/temperature/temperature_course.h"
#include "dataset/conditioning.h"
#include "session/losses.h"
#include "session/plan_steps.h"
#include "session/prospects.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

std::string commaList(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string items(const std::vector<std::string>& sentences, const std::string& indent) {
  std::string text;
  for (const std::string& sentence : sentences) text += indent + "- " + sentence + "\n";
  return text;
}

// Few cycles are allowed, but the recordings will be told apart from conditioned ones.
std::string conditioningText(const SessionPlan& plan) {
  const unsigned cycles = plan.conditioning.cycles;
  if (cycles == 0) return "No conditioning.";
  const std::string text = "Conditioning before the first recording: " + std::to_string(cycles) +
                           (cycles == 1 ? " cycle to " : " cycles to ") +
                           settings::roundedKilopascals(conditioningPeak(plan), 4) + ".";
  if (cycles >= dataset::ConditioningOptions{}.cycles) return text;
  return text + " Makers of sensors ask for four or five: check_bag and train will say \"fewer than four\".";
}

std::string needs(const SessionPlan& plan) {
  std::vector<std::string> surfaces, order, parts;
  for (const PlannedSurface& one : plan.surfaces) surfaces.push_back(one.surface.name);
  for (const PlannedMount& mount : mountOrder(plan))
    order.push_back(plan.surfaces[mount.surface].surface.name);
  for (const simulation::ProgramPart& part : plan.program) parts.push_back(partWords(part));
  const bool conditioned = plan.conditioning.cycles > 0;
  std::vector<std::string> sentences = {
      "Surfaces: " + commaList(surfaces) + ".",
      "Chamber: up to " +
          settings::roundedKilopascals(conditioned ? conditioningPeak(plan) : largestPeak(plan), 4) + ".",
      plan.thermometer ? "A thermometer (topic temperature)." : "No thermometer.",
      conditioningText(plan),
      "Order: " + commaList(order) + ".",
      "On each mount, " + timeText(recordingDuration(plan)) + ": " + commaList(parts) + ". Rest of " +
          settings::roundedText(plan.rest.before) + " s before and " +
          settings::roundedText(plan.rest.after) + " s after."};
  for (const Break& one : plan.breaks)
    sentences.push_back("Break of " + timeText(one.duration) + " behind mount " + std::to_string(one.after) +
                        ".");
  return items(sentences, "  ");
}

// Cuts that save and cost the same share one entry.
std::string cutsText(const std::vector<Cut>& cuts) {
  std::string text;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    std::string what = cuts[c].what;
    const std::vector<std::string>& losses = cuts[c].losses;
    const double saved = cuts[c].saved;
    while (c + 1 < cuts.size() && cuts[c + 1].losses == losses && std::abs(cuts[c + 1].saved - saved) < 1)
      what += ", or " + cuts[++c].what;
    text += "  " + what + ": saves " + (saved > 0 ? timeText(saved) : "no time") +
            (losses.empty() ? ", and costs nothing but fewer data\n" : "\n") + items(losses, "    ");
  }
  return text;
}

}  // namespace

std::string timeText(double seconds) {
  const long minutes = std::lround(std::ceil(seconds / 60 - 1e-9));
  if (minutes < 60) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

std::string headline(const SessionPlan& plan) {
  const std::size_t mounts = mountsOf(plan), surfaces = plan.surfaces.size();
  return plan.name + " (" + name(plan.purpose) + "): " + timeText(sessionDuration(plan)) + ", " +
         std::to_string(mounts) + (mounts == 1 ? " mount on " : " mounts on ") + std::to_string(surfaces) +
         (surfaces == 1 ? " surface" : " surfaces") + ", one bag each";
}

std::string planReport(const SessionPlan& plan) {
  const Prospects prospects = prospectsOf(plan);
  std::string text = headline(plan) + "\n\nNeeded:\n" + needs(plan);
  text += "\nThe recordings can tell, as far as the protocol decides:\n";
  std::vector<std::string> can;
  if (!prospects.told.empty()) can.push_back("discrepancy can name " + commaList(prospects.told) + ".");
  if (prospects.remounted > 0)
    can.push_back("The error of another mount, on " + std::to_string(prospects.remounted) + " of " +
                  std::to_string(plan.surfaces.size()) +
                  (plan.surfaces.size() == 1 ? " surface." : " surfaces."));
  if (prospects.inner() > 0)
    can.push_back("The error between surfaces, on " + std::to_string(prospects.inner()) +
                  (prospects.inner() == 1 ? " surface." : " surfaces."));
  if (prospects.history)
    can.push_back("The memory of the sheet, on " + std::to_string(prospects.protocols.size()) +
                  " protocols, up to a time constant of " +
                  settings::roundedText(prospects.longest_memory, 2) + " s.");
  if (prospects.tare) can.emplace_back("Whether a tare at the start of a session helps.");
  if (prospects.temperature)
    can.push_back("The influence of the temperature, if it differs by more than " +
                  settings::roundedText(calibration::kLeastTemperatureSpan) + " K from cycle to cycle.");
  text += items(can, "  ") + "\nThey cannot tell:\n" + items(limitsOf(prospects), "  ");
  text += "\nWhat a cut costs:\n";
  return text + cutsText(cutsOf(plan, prospects));
}

std::vector<std::string> lacksBeside(const SessionPlan& whole, const SessionPlan& plan) {
  return lossesBetween(prospectsOf(whole), prospectsOf(plan));
}

std::string stepsText(const SessionPlan& plan) {
  std::string text;
  for (const SessionStep& step : sessionSteps(plan)) {
    const long seconds = std::lround(step.begin);
    const auto two = [](long value) { return (value < 10 ? "0" : "") + std::to_string(value); };
    text += std::to_string(seconds / 3600) + ":" + two(seconds / 60 % 60) + ":" + two(seconds % 60) +
            "  mount " + std::to_string(step.mount) + " " + step.surface +
            (step.recorded ? "  " : "  (not recorded) ") + instruction(step) + "\n";
  }
  return text;
}

}  // namespace fsr::session
