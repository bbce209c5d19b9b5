#include "session/prospects.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/session/session_rests.h"
#include "compensation/history_fit.h"
#include "dataset/protocols.h"
#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/samples/available_evidence.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "session/plan_steps.h"
#include "settings/settings.h"
#include "simulation/effects/effect_library.h"
#include "simulation/read_settings.h"

namespace fsr::session {

namespace {

constexpr double kScanRate = 4;  // of the simulated taxel [Hz]; the shortest feature of a course lasts 1 s

// The simplest sheet: what the recordings contain depends on the course of the pressure, not on the readings.
constexpr char kSheet[] =
    "simulation: plan\n"
    "matrix: {rows: 1, columns: 1}\n"
    "effects: {static_curve: {}, converter: {}}\n";

std::vector<dataset::Recording> recordingsOf(const SessionPlan& plan) {
  simulation::SimulationSettings rig =
      simulation::readSimulation(settings::Settings::fromText(kSheet, plan.origin));
  rig.board.scan_rate = rig.board.transducer_rate = kScanRate;
  rig.session = simulatedStations(plan);
  for (simulation::Station& station : rig.session) station.surface = discrepancy::oneTaxel(station.surface);
  std::vector<dataset::Recording> recordings = simulation::simulateSession(rig);
  if (!plan.thermometer) {
    for (dataset::Recording& recording : recordings) recording.temperature.clear();
  }
  return recordings;
}

template <typename Ask>
std::string refusal(Ask ask) {
  try {
    ask();
    return "";
  } catch (const settings::InputError& error) {
    return error.what();
  }
}

std::string lacking(const simulation::EffectInfo& info, const discrepancy::AvailableEvidence& evidence) {
  std::string text;
  for (const simulation::Evidence need : info.needs) {
    if (!evidence.has(need)) text += (text.empty() ? "" : ", ") + simulation::name(need);
  }
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

// No plan for a chamber with uniform gas pressure and one gauge contains these.
bool beyondAnyPlan(simulation::Evidence need) {
  return need == simulation::Evidence::kUnevenLoad || need == simulation::Evidence::kSecondReference ||
         need == simulation::Evidence::kVentedSheet;
}

// Why an effect could not be named alone: the rules of `discrepancy` for what it lists as not testable, and
// for the effects that stay beside another one because evidence is lacking. An empty reason = it could be
// named.
UntoldEffect judged(const simulation::EffectInfo& info, const discrepancy::AvailableEvidence& evidence) {
  const std::string lacks = lacking(info, evidence);
  const bool by_derivative =
      info.kind == simulation::EffectKind::kAdditive || info.kind == simulation::EffectKind::kGrid;
  if (info.kind == simulation::EffectKind::kListed) return {info.id, "A gas chamber cannot show it.", false};
  if (by_derivative && discrepancy::isStatic(info))
    return {info.id, "Under a uniform pressure the static curves absorb all of it.", false};
  if (!info.looked_for) return {info.id, "It is not looked for in this version.", false};
  if (!lacks.empty()) {
    const bool never = std::any_of(info.needs.begin(), info.needs.end(), beyondAnyPlan);
    return {info.id, "It needs " + lacks + ".", !never};
  }
  if (info.detector == simulation::Detector::kMounts && !evidence.remounted)
    return {info.id, "No surface is mounted twice.", true};
  return {info.id, "", true};
}

void askDiscrepancy(const std::vector<dataset::Recording>& recordings, Prospects& prospects) {
  discrepancy::DiscrepancyProblem problem;
  problem.recordings = recordings;
  problem.simulation.layout = recordings.front().layout;
  discrepancy::Measured measured;
  prospects.discrepancy = refusal([&] {
    discrepancy::validate(problem);
    measured = discrepancy::admit(problem);
  });
  if (!prospects.discrepancy.empty()) return;
  const discrepancy::AvailableEvidence evidence = discrepancy::availableEvidence(measured);
  for (const simulation::EffectEntry& entry : simulation::EffectLibrary::shipped().entries()) {
    if (entry.info.kind == simulation::EffectKind::kBase || entry.info.with_bending) continue;
    const UntoldEffect effect = judged(entry.info, evidence);
    if (effect.reason.empty()) prospects.told.push_back(effect.id);
    if (!effect.reason.empty()) prospects.untold.push_back(effect);
  }
  std::vector<std::size_t> cycles(measured.classes.size(), 0);
  for (const discrepancy::MeasuredCycle& cycle : measured.cycles) {
    ++cycles[measured.visits[cycle.visit].curvature_class];
    prospects.hold_out += cycle.use == discrepancy::CycleUse::kHoldOut ? 1 : 0;
  }
  prospects.fewest_cycles = *std::min_element(cycles.begin(), cycles.end());
}

void askTraining(const std::vector<dataset::Recording>& recordings, Prospects& prospects) {
  const calibration::CalibrationProblem problem{recordings, {}};
  prospects.training = refusal([&] { calibration::validate(problem); });
  if (!prospects.training.empty()) return;
  const dataset::ConditionClasses classes = dataset::poolConditions(recordings);
  prospects.tare = calibration::findSessions(recordings, classes).assessable();
  std::vector<dataset::Sections> sections;
  for (const dataset::Recording& recording : recordings)
    sections.push_back(dataset::divideIntoSections(recording, problem.options.folds));
  const dataset::Protocols protocols = dataset::protocolsOf(recordings, sections);
  prospects.protocols = protocols.names;
  // A surface has an answer without a protocol if it was recorded with another one, too.
  std::vector<std::set<std::uint32_t>> of_class(classes.classes.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      const std::uint32_t protocol = protocols.of_scan[r][i];
      if (protocol != dataset::Protocols::kOther)
        of_class[classes.class_of[r][recordings[r].condition[i]]].insert(protocol);
    }
  }
  prospects.history =
      std::any_of(of_class.begin(), of_class.end(), [](const auto& own) { return own.size() > 1; });
  const auto& times = compensation::historyGrid(protocols.highest, protocols.longest_hold).time_constants;
  if (prospects.history && !times.empty())
    prospects.longest_memory = *std::max_element(times.begin(), times.end());
}

}  // namespace

Prospects prospectsOf(const SessionPlan& plan) {
  Prospects prospects;
  for (const PlannedSurface& surface : plan.surfaces) prospects.curvatures.push_back(bendOf(surface.surface));
  std::sort(prospects.curvatures.begin(), prospects.curvatures.end());
  const std::vector<PlannedMount> order = mountOrder(plan);
  prospects.mounts = order.size();
  std::vector<unsigned> visits(plan.surfaces.size(), 0);
  for (const PlannedMount& mount : order) ++visits[mount.surface];
  prospects.remounted =
      static_cast<std::size_t>(std::count_if(visits.begin(), visits.end(), [](unsigned n) { return n > 1; }));
  prospects.first_again =
      order.size() > 2 && order.front().surface == order.back().surface && plan.surfaces.size() > 1;
  prospects.highest = largestPeak(plan);
  prospects.conditioned = plan.conditioning.cycles > 0;
  prospects.temperature = plan.thermometer;
  const std::vector<dataset::Recording> recordings = recordingsOf(plan);
  askDiscrepancy(recordings, prospects);
  askTraining(recordings, prospects);
  return prospects;
}

}  // namespace fsr::session
