#include "session/plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/session/tare.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "dataset/conditioning.h"
#include "discrepancy/decide/candidates.h"
#include "discrepancy/samples/available_evidence.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "session/plan_steps.h"
#include "settings/number_text.h"
#include "settings/text.h"
#include "simulation/effects/effect_library.h"
#include "simulation/settings_text.h"

namespace fsr::session {

namespace {

using settings::roundedText;
using Sentences = std::vector<std::string>;

constexpr double kLongBreak = 3600;  // from which clock time and use of the sheet differ [s]
constexpr double kTwoPaces = 1.5;    // ratio of two paces, from which `discrepancy` tells them apart
constexpr double kDwelling = 0.1;    // likewise share of the time of a cycle that is a dwell
constexpr double kUnitsFor95 = 19;   // mounts: 19 / (19 + 1) = 95 %

/// What the recordings of a plan contain.
struct Contents {
  double mounts = 0;
  double remounted = 0;                  // surfaces with two mounts or more
  double cycles = 0;                     // cycles, loops and holds on the surface that has fewest
  double protocols = 0;                  // ways in which the chamber is driven
  double longest_hold = 0, highest = 0;  // [s], [Pa]
  std::vector<double> curvatures;        // of the surfaces, ascending [1/m]
  bool rest_first = false, first_again = false, conditioned = false;
  discrepancy::AvailableEvidence evidence;
};

Contents contentsOf(const SessionPlan& plan) {
  Contents contents;
  std::set<std::tuple<double, double, double>> driven;
  double slowest = 1e9, fastest = 0;  // [Pa/s]
  bool dwells = false;
  for (const SessionStep& step : sessionSteps(plan)) {
    if (step.mount > 1 || !step.recorded) continue;
    contents.longest_hold =
        std::max({contents.longest_hold, step.dwell_peak, step.loads() ? 0 : step.dwell_rest});
    if (!step.loads()) continue;
    driven.insert({step.fill_rate, step.peak, step.dwell_peak});
    contents.cycles += 1;
    slowest = std::min(slowest, step.fill_rate);
    fastest = std::max(fastest, step.fill_rate);
    dwells |= step.kind == StepKind::kHold || step.dwell_peak > kDwelling * step.duration;
  }
  contents.protocols = static_cast<double>(driven.size());
  std::vector<unsigned> visits;
  for (const PlannedSurface& one : plan.surfaces) {
    visits.push_back(one.mounts + (visits.empty() && plan.repeat_first ? 1 : 0));
    contents.remounted += visits.back() > 1;
    contents.curvatures.push_back(bendOf(one.surface));
  }
  std::sort(contents.curvatures.begin(), contents.curvatures.end());
  contents.cycles *= *std::min_element(visits.begin(), visits.end());
  contents.mounts = static_cast<double>(mountsOf(plan));
  contents.highest = largestPeak(plan);
  contents.rest_first = plan.rest.before >= calibration::TareOptions{}.window;
  const std::vector<PlannedMount> order = mountOrder(plan);
  contents.first_again =
      plan.surfaces.size() > 1 && order.size() > 2 && order.front().surface == order.back().surface;
  contents.conditioned = plan.conditioning.cycles > 0;
  contents.evidence.thermometer = plan.thermometer;
  contents.evidence.two_rates = dwells || fastest > kTwoPaces * slowest;
  contents.evidence.mount_labels = true;
  contents.evidence.remounted = contents.remounted > 0;
  for (const Break& one : plan.breaks) contents.evidence.uneven_pace |= one.duration >= kLongBreak;
  return contents;
}

// ---- what recordings may tell ------------------------------------------------------------------------

/// Something that recordings may tell.
struct Question {
  const char* what;
  const char* lacking;                // why they do not
  const char* unit;                   // of the amount; null = it is told or not
  double (*amount)(const Contents&);  // 0 = they do not
};

constexpr Question kQuestions[] = {
    {"The error of another mount", "no surface is mounted twice", "surfaces",
     [](const Contents& c) { return c.remounted; }},
    {"The error between surfaces", "no surface lies between two others", "surfaces",
     [](const Contents& c) { return std::max(0.0, double(c.curvatures.size()) - 2); }},
    {"Ageing and drift, apart from bending", "the first surface is not repeated as the last one", nullptr,
     [](const Contents& c) { return double(c.first_again || c.curvatures.size() == 1); }},
    {"The memory of the sheet, for train",
     "all cycles have one protocol; add a second pace, short and long dwells, and partial loops", "protocols",
     [](const Contents& c) { return c.protocols > 1 ? c.protocols : 0; }},
    {"The memory of the sheet, by its time constants", "all cycles have one protocol", "longest [s]",
     [](const Contents& c) {
       return c.protocols > 1 ? calibration::historyGrid(0, c.highest, c.longest_hold).longestMeasured() : 0;
     }},
    {"Whether a tare at the start of a session helps", "no surface has two recordings that start with a rest",
     nullptr, [](const Contents& c) { return double(c.remounted > 0 && c.rest_first); }},
    {"The influence of the temperature, where it changes", "no thermometer is recorded", nullptr,
     [](const Contents& c) { return double(c.evidence.thermometer); }},
    {"The sheet as it is after its first loadings", "it is not conditioned", nullptr,
     [](const Contents& c) { return double(c.conditioned); }},
    {"The held-out error, by the sections of the cross-validation",
     "a surface has fewer cycles than sections, so that the error is stated too small", nullptr,
     [](const Contents& c) { return double(c.cycles >= double(calibration::CalibrationOptions{}.folds)); }},
    {"Which of two explanations discrepancy prefers",
     "a surface has fewer than two cycles for each of its folds", nullptr,
     [](const Contents& c) {
       return double(c.cycles >= 2 * double(discrepancy::DiscrepancyOptions{}.folds));
     }},
    {"Whether what discrepancy finds holds on cycles held out", "at least 3 cycles are needed on all mounts",
     nullptr, [](const Contents& c) { return double(c.cycles * double(c.curvatures.size()) >= 3); }},
};

// "The error of another mount (surfaces: 6)."
std::string told(const Question& question, double amount) {
  std::string text = question.what;
  if (question.unit != nullptr)
    text += std::string(" (") + question.unit + ": " + roundedText(amount, 3) + ")";
  return text + ".";
}

std::string untold(const Question& question) {
  return std::string(question.what) + ": " + question.lacking + ".";
}

std::string coverageText(double mounts) {
  return "Intervals with the mounts as units can cover at most " +
         roundedText(100 * mounts / (mounts + 1), 3) + " % of new mounts (" + roundedText(mounts) +
         (mounts == 1 ? " mount)" : " mounts)") + "; 95 % needs " + roundedText(kUnitsFor95) + " mounts.";
}

std::string rangeText(const Contents& contents) {
  return "Curvatures below " + roundedText(contents.curvatures.front(), 3) + " and above " +
         roundedText(contents.curvatures.back(), 3) + " 1/m are extrapolated, and so are pressures above " +
         settings::roundedPressure(contents.highest, 4) + ".";
}

// ---- effects that `discrepancy` could name alone -----------------------------------------------------

// Why an effect could not be named: the rules by which `discrepancy` lists it as not testable. Empty = it
// could.
std::string whyNot(const simulation::EffectInfo& info, const discrepancy::AvailableEvidence& evidence) {
  using simulation::EffectKind;
  if (info.kind == EffectKind::kListed) return "a gas chamber cannot show it";
  if ((info.kind == EffectKind::kAdditive || info.kind == EffectKind::kGrid) && discrepancy::isStatic(info))
    return "under a uniform pressure the static curves absorb all of it";
  if (!info.looked_for) return "not looked for in this version";
  std::string lacks;
  for (const simulation::Evidence need : info.needs) {
    if (!evidence.has(need)) lacks += (lacks.empty() ? "needs " : ", ") + simulation::name(need);
  }
  std::replace(lacks.begin(), lacks.end(), '_', ' ');
  if (lacks.empty() && info.detector == simulation::Detector::kMounts && !evidence.remounted)
    return "needs remounts";
  return lacks;
}

// Ids of the library, by the reason for which they could not be named.
std::map<std::string, Sentences> effectsByReason(const Contents& contents) {
  std::map<std::string, Sentences> effects;
  for (const simulation::EffectEntry& entry : simulation::EffectLibrary::shipped().entries()) {
    if (entry.info.kind == simulation::EffectKind::kBase || entry.info.with_bending) continue;
    effects[whyNot(entry.info, contents.evidence)].push_back(entry.info.id);
  }
  return effects;
}

// ---- text --------------------------------------------------------------------------------------------

std::string items(const Sentences& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += "  - " + sentence + "\n";
  return text;
}

// Few cycles are allowed, but the recordings will be told apart from conditioned ones.
std::string conditioningText(const SessionPlan& plan) {
  const unsigned cycles = plan.conditioning.cycles;
  if (cycles == 0) return "No conditioning.";
  const std::string text = "Conditioning before the first recording: " + std::to_string(cycles) +
                           (cycles == 1 ? " cycle to " : " cycles to ") +
                           settings::roundedPressure(conditioningPeak(plan), 4) + ".";
  if (cycles >= dataset::ConditioningOptions{}.cycles) return text;
  return text + " Makers of sensors ask for four or five: check_bag and train will say \"fewer than four\".";
}

Sentences needs(const SessionPlan& plan) {
  const auto name = [](const PlannedSurface& one) { return one.surface.name; };
  const auto on = [&](const PlannedMount& mount) { return name(plan.surfaces[mount.surface]); };
  const bool conditioned = plan.conditioning.cycles > 0;
  Sentences sentences = {
      "Surfaces: " + settings::joinedTexts(plan.surfaces, name) + ".",
      "Chamber: up to " +
          settings::roundedPressure(conditioned ? conditioningPeak(plan) : largestPeak(plan), 4) + ".",
      plan.thermometer ? "A thermometer (topic temperature)." : "No thermometer.",
      conditioningText(plan),
      "Order: " + settings::joinedTexts(mountOrder(plan), on) + ".",
      "On each mount, " + timeText(recordingDuration(plan)) + ": " +
          settings::joinedTexts(plan.program, simulation::programText) + ". Rest of " +
          roundedText(plan.rest.before) + " s before and " + roundedText(plan.rest.after) + " s after."};
  for (const Break& one : plan.breaks)
    sentences.push_back("Break of " + timeText(one.duration) + " behind mount " + std::to_string(one.after) +
                        ".");
  return sentences;
}

Sentences canTell(const SessionPlan& plan) {
  const Contents contents = contentsOf(plan);
  Sentences sentences;
  if (const Sentences effects = effectsToldBy(plan); !effects.empty())
    sentences.push_back("discrepancy can name " + settings::joined(effects) + ".");
  for (const Question& one : kQuestions) {
    if (one.amount(contents) > 0) sentences.push_back(told(one, one.amount(contents)));
  }
  return sentences;
}

}  // namespace

std::vector<std::string> effectsToldBy(const SessionPlan& plan) {
  return effectsByReason(contentsOf(plan))[""];
}

std::vector<std::string> limitsOf(const SessionPlan& plan) {
  const Contents contents = contentsOf(plan);
  Sentences sentences;
  for (const Question& one : kQuestions) {
    if (one.amount(contents) == 0) sentences.push_back(untold(one));
  }
  for (const auto& [reason, effects] : effectsByReason(contents)) {
    if (!reason.empty())
      sentences.push_back("discrepancy cannot name alone: " + settings::joined(effects) + " (" + reason +
                          ").");
  }
  sentences.push_back(rangeText(contents));
  if (contents.mounts < kUnitsFor95) sentences.push_back(coverageText(contents.mounts));
  return sentences;
}

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
  return headline(plan) + "\n\nNeeded:\n" + items(needs(plan)) +
         "\nThe recordings can tell, as far as the protocol decides:\n" + items(canTell(plan)) +
         "\nThey cannot tell:\n" + items(limitsOf(plan));
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
