#include "session/losses.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "calibration/history_training.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "session/plan_steps.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

using settings::roundedText;
using Sentences = std::vector<std::string>;

constexpr std::size_t kUnitsFor95 = 19;  // 19 / (19 + 1) = 95 %

std::string wordList(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t w = 0; w < words.size(); ++w)
    text += (w == 0 ? "" : w + 1 == words.size() ? " and " : ", ") + words[w];
  return text;
}

// The reason of one effect for several: "It needs ..." becomes "They need ...".
std::string forMany(std::string reason) {
  static const std::pair<const char*, const char*> kMany[] = {{"It needs", "They need"},
                                                              {"It is", "They are"},
                                                              {"cannot show it.", "cannot show them."},
                                                              {"all of it.", "all of them."}};
  for (const auto& [one, many] : kMany) {
    const std::size_t at = reason.find(one);
    if (at != std::string::npos) reason.replace(at, std::string(one).size(), many);
  }
  return reason;
}

// One sentence for all effects with the same reason, in the order of the library.
void tellUntold(const std::vector<UntoldEffect>& effects, Sentences& sentences) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_reason;
  for (const UntoldEffect& effect : effects) {
    auto same = std::find_if(by_reason.begin(), by_reason.end(),
                             [&](const auto& entry) { return entry.first == effect.reason; });
    if (same == by_reason.end()) same = by_reason.insert(by_reason.end(), {effect.reason, {}});
    same->second.push_back(effect.id);
  }
  for (const auto& [reason, ids] : by_reason) {
    sentences.push_back("discrepancy cannot name " + wordList(ids) + " alone. " +
                        (ids.size() > 1 ? forMany(reason) : reason));
  }
}

void tellCycles(std::size_t cycles, std::size_t before, Sentences& sentences) {
  const std::size_t sections = calibration::CalibrationOptions{}.folds;
  const std::size_t wanted = 2 * discrepancy::DiscrepancyOptions{}.folds;
  const std::string start = "A surface has " + std::to_string(cycles) + (cycles == 1 ? " cycle" : " cycles");
  if (cycles < sections && before >= sections) {
    sentences.push_back(start + ", fewer than the " + std::to_string(sections) +
                        " sections of the cross-validation: its error is stated too small.");
  } else if (cycles < wanted && before >= wanted) {
    sentences.push_back(start + ", fewer than the " + std::to_string(wanted) +
                        " by which discrepancy compares explanations: two for each of its folds.");
  }
}

std::string coverageText(std::size_t mounts) {
  return "Intervals with the mounts as units can cover at most " +
         roundedText(100 * double(mounts) / double(mounts + 1), 3) + " % of new mounts (" +
         std::to_string(mounts) + (mounts == 1 ? " mount)" : " mounts)") + "; 95 % needs " +
         std::to_string(kUnitsFor95) + " mounts.";
}

const char kNoHoldOut[] = "discrepancy can hold out no cycle, so that it proves nothing.";
const char kNoRemount[] = "The error of another mount is not assessed: no surface is mounted twice.";
const char kNoInner[] = "The error between surfaces is not assessed: no surface lies between two others.";
const char kNotAgain[] =
    "Ageing and drift cannot be distinguished from bending: the first surface is not repeated as the last "
    "one.";
const char kNoTare[] = "train cannot assess a tare: no surface has two recordings that start with a rest.";
const char kNotConditioned[] =
    "The sheet is not conditioned: its first loadings, which differ from later ones, are in the recordings.";
const char kNoThermometer[] = "train cannot correct for the temperature: it is not recorded.";

std::string noHistory(const Prospects& prospects) {
  return "train learns no memory of the sheet: " +
         calibration::whyNoProtocolIsLeftOut(prospects.protocols.size()) + ".";
}

void tellCurvatures(const Prospects& more, const Prospects& less, Sentences& sentences) {
  if (more.curvatures.empty() || less.curvatures.empty()) return;
  const auto range = [](double low, double high) {
    return roundedText(low, 3) + " to " + roundedText(high, 3) + " 1/m";
  };
  const double low = less.curvatures.front(), high = less.curvatures.back();
  const double from = more.curvatures.front(), to = more.curvatures.back();
  const auto extrapolated = [](const std::string& text) {
    return "Curvatures from " + text + " are extrapolated: no surface is as much bent.";
  };
  if (from < low) sentences.push_back(extrapolated(range(from, low)));
  if (to > high) sentences.push_back(extrapolated(range(high, to)));
  if (less.inner() == 0 && more.inner() > 0) {
    sentences.emplace_back(kNoInner);
  } else if (less.inner() < more.inner()) {
    sentences.push_back("The error between surfaces is measured on " + std::to_string(less.inner()) +
                        (less.inner() == 1 ? " surface" : " surfaces") + " instead of " +
                        std::to_string(more.inner()) + ".");
  }
}

void tellHistory(const Prospects& more, const Prospects& less, Sentences& sentences) {
  if (more.history && !less.history) {
    sentences.push_back(noHistory(less));
    return;
  }
  if (less.history && less.protocols.size() < more.protocols.size()) {
    sentences.push_back("train tests the memory of the sheet on " + std::to_string(less.protocols.size()) +
                        " protocols instead of " + std::to_string(more.protocols.size()) + ".");
  }
  if (less.history && less.longest_memory < 0.99 * more.longest_memory) {
    sentences.push_back("The longest memory that train can learn is " + roundedText(less.longest_memory, 2) +
                        " s instead of " + roundedText(more.longest_memory, 2) + " s.");
  }
}

// A plan without a piece.
struct Shorter {
  std::string what;
  SessionPlan plan;
};

void leaveOutSurfaces(const SessionPlan& plan, std::vector<Shorter>& all) {
  for (std::size_t s = 0; plan.surfaces.size() > 1 && s < plan.surfaces.size(); ++s) {
    Shorter cut{"without " + plan.surfaces[s].surface.name, plan};
    cut.plan.surfaces.erase(cut.plan.surfaces.begin() + static_cast<std::ptrdiff_t>(s));
    all.push_back(cut);
  }
}

void leaveOutMounts(const SessionPlan& plan, std::vector<Shorter>& all) {
  Shorter once{"with every surface mounted once", plan};
  for (PlannedSurface& surface : once.plan.surfaces) surface.mounts = 1;
  if (mountsOf(once.plan) < mountsOf(plan)) all.push_back(once);
  if (!plan.repeat_first) return;
  all.push_back({"without the first surface at the end", plan});
  all.back().plan.repeat_first = false;
}

void leaveOutParts(const SessionPlan& plan, std::vector<Shorter>& all) {
  for (std::size_t p = 0; plan.program.size() > 1 && p < plan.program.size(); ++p) {
    if (std::holds_alternative<simulation::RestPart>(plan.program[p])) continue;
    Shorter cut{"without " + partWords(plan.program[p]), plan};
    cut.plan.program.erase(cut.plan.program.begin() + static_cast<std::ptrdiff_t>(p));
    if (largestPeak(cut.plan) > 0) all.push_back(cut);
  }
  Shorter half{"with half of the cycles", plan};
  bool fewer = false;
  for (simulation::ProgramPart& part : half.plan.program) {
    auto* const cycles = std::get_if<simulation::ChamberProtocol>(&part);
    if (cycles == nullptr || cycles->cycles < 2) continue;
    cycles->cycles = (cycles->cycles + 1) / 2;
    fewer = true;
  }
  if (fewer) all.push_back(half);
}

void leaveOutRest(const SessionPlan& plan, std::vector<Shorter>& all) {
  for (std::size_t b = 0; b < plan.breaks.size(); ++b) {
    Shorter cut{"without the break behind mount " + std::to_string(plan.breaks[b].after), plan};
    cut.plan.breaks.erase(cut.plan.breaks.begin() + static_cast<std::ptrdiff_t>(b));
    all.push_back(cut);
  }
  if (plan.conditioning.cycles > 0) {
    all.push_back({"without the conditioning", plan});
    all.back().plan.conditioning.cycles = 0;
  }
  if (!plan.thermometer) return;
  all.push_back({"without the thermometer", plan});
  all.back().plan.thermometer = false;
}

/// Called by std::visit.
struct Words {
  std::string operator()(const simulation::ChamberProtocol& p) const {
    const std::string rate = roundedText(p.fill_rate / 1e3, 3);
    const std::string vent = p.vent_rate == p.fill_rate ? "" : " and " + roundedText(p.vent_rate / 1e3, 3);
    return std::to_string(p.cycles) + (p.cycles == 1 ? " cycle to " : " cycles to ") +
           settings::roundedKilopascals(p.peak, 4) + " at " + rate + vent + " kPa/s, dwells of " +
           roundedText(p.dwell_peak, 3) + " s";
  }
  std::string operator()(const simulation::HoldPart& p) const {
    return "the hold of " + roundedText(p.duration, 4) + " s at " +
           settings::roundedKilopascals(p.pressure, 4);
  }
  std::string operator()(const simulation::LoopsPart& p) const {
    return std::to_string(p.loops) + (p.loops == 1 ? " partial loop from " : " partial loops from ") +
           settings::roundedKilopascals(p.low, 4) + " to " + settings::roundedKilopascals(p.high, 4);
  }
  std::string operator()(const simulation::RestPart& p) const {
    return "the rest of " + roundedText(p.duration, 4) + " s";
  }
};

}  // namespace

std::string partWords(const simulation::ProgramPart& part) {
  return std::visit(Words{}, part);
}

std::vector<std::string> limitsOf(const Prospects& prospects) {
  Sentences sentences;
  if (!prospects.training.empty())
    sentences.push_back("train refuses the recordings: " + prospects.training + ".");
  if (!prospects.discrepancy.empty())
    sentences.push_back("discrepancy refuses the recordings: " + prospects.discrepancy + ".");
  tellUntold(prospects.untold, sentences);
  if (prospects.discrepancy.empty())
    tellCycles(prospects.fewest_cycles, static_cast<std::size_t>(-1), sentences);
  if (prospects.discrepancy.empty() && prospects.hold_out == 0) sentences.emplace_back(kNoHoldOut);
  if (!prospects.curvatures.empty()) {
    sentences.push_back("Curvatures below " + roundedText(prospects.curvatures.front(), 3) + " and above " +
                        roundedText(prospects.curvatures.back(), 3) +
                        " 1/m are extrapolated, and so are pressures above " +
                        settings::roundedKilopascals(prospects.highest, 4) + ".");
  }
  if (prospects.inner() == 0) sentences.emplace_back(kNoInner);
  if (prospects.remounted == 0) sentences.emplace_back(kNoRemount);
  if (!prospects.first_again && prospects.curvatures.size() > 1) sentences.emplace_back(kNotAgain);
  if (prospects.mounts < kUnitsFor95) sentences.push_back(coverageText(prospects.mounts));
  if (!prospects.history) sentences.push_back(noHistory(prospects));
  if (!prospects.tare) sentences.emplace_back(kNoTare);
  if (!prospects.conditioned) sentences.emplace_back(kNotConditioned);
  if (!prospects.temperature) sentences.emplace_back(kNoThermometer);
  return sentences;
}

std::vector<std::string> lossesBetween(const Prospects& more, const Prospects& less) {
  Sentences sentences;
  if (more.training.empty() && !less.training.empty())
    sentences.push_back("train refuses the recordings: " + less.training + ".");
  if (more.discrepancy.empty() && !less.discrepancy.empty())
    sentences.push_back("discrepancy refuses the recordings: " + less.discrepancy + ".");
  std::vector<UntoldEffect> untold;
  for (const UntoldEffect& effect : less.untold) {
    if (std::count(more.told.begin(), more.told.end(), effect.id)) untold.push_back(effect);
  }
  tellUntold(untold, sentences);
  if (less.discrepancy.empty()) tellCycles(less.fewest_cycles, more.fewest_cycles, sentences);
  if (less.discrepancy.empty() && more.hold_out > 0 && less.hold_out == 0) sentences.emplace_back(kNoHoldOut);
  tellCurvatures(more, less, sentences);
  if (less.highest < 0.99 * more.highest)
    sentences.push_back("Pressures above " + settings::roundedKilopascals(less.highest, 4) +
                        " are extrapolated.");
  if (more.remounted > 0 && less.remounted == 0) {
    sentences.emplace_back(kNoRemount);
  } else if (less.remounted < more.remounted) {
    sentences.push_back("The error of another mount is measured on " + std::to_string(less.remounted) +
                        (less.remounted == 1 ? " surface" : " surfaces") + " instead of " +
                        std::to_string(more.remounted) + ".");
  }
  if (more.first_again && !less.first_again) sentences.emplace_back(kNotAgain);
  if (less.mounts < more.mounts && less.mounts < kUnitsFor95) sentences.push_back(coverageText(less.mounts));
  tellHistory(more, less, sentences);
  if (more.tare && !less.tare) sentences.emplace_back(kNoTare);
  if (more.conditioned && !less.conditioned) sentences.emplace_back(kNotConditioned);
  if (more.temperature && !less.temperature) sentences.emplace_back(kNoThermometer);
  return sentences;
}

void fitBreaks(SessionPlan& plan) {
  const auto mounts = static_cast<unsigned>(mountsOf(plan));
  std::vector<Break> fitting;
  for (Break one : plan.breaks) {
    one.after = std::min(one.after, mounts - 1);
    if (one.after > (fitting.empty() ? 0 : fitting.back().after)) fitting.push_back(one);
  }
  plan.breaks = fitting;
}

std::vector<Cut> cutsOf(const SessionPlan& plan, const Prospects& prospects) {
  std::vector<Shorter> all;
  leaveOutSurfaces(plan, all);
  leaveOutMounts(plan, all);
  leaveOutParts(plan, all);
  leaveOutRest(plan, all);
  std::vector<Cut> cuts;
  for (Shorter& one : all) {
    fitBreaks(one.plan);
    cuts.push_back({one.what, sessionDuration(plan) - sessionDuration(one.plan),
                    lossesBetween(prospects, prospectsOf(one.plan))});
  }
  return cuts;
}

}  // namespace fsr::session
