#include "emulator/mistakes.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::emulator {

namespace {

constexpr double kLongDwell = 5;  // shorter dwells are within the usual tolerance of 2 s anyway [s]

bool mounts(const Task& t) {
  return t.kind == TaskKind::kMount;
}
bool conditions(const Task& t) {
  return t.kind == TaskKind::kCondition;
}
bool cycles(const Task& t) {
  return t.kind == TaskKind::kCycle;
}
bool endsTheCycles(const Task& t) {
  return cycles(t) && t.cycle >= t.cycles;
}
bool rests(const Task& t) {
  return t.kind == TaskKind::kRest && std::max(t.dwell_rest, t.duration) >= kLongDwell;
}
// The first loop may come from zero.
bool loopsAgain(const Task& t) {
  return t.kind == TaskKind::kLoop && t.low > 0 && t.cycle > 1;
}
bool reachesAPeak(const Task& t) {
  return cycles(t) || t.kind == TaskKind::kHold;
}
bool dwells(const Task& t) {
  return (cycles(t) && t.dwell_peak >= kLongDwell) ||
         (t.kind == TaskKind::kHold && std::max(t.dwell_peak, t.duration) >= kLongDwell);
}

void lowerPeak(Task& t) {
  t.peak *= 0.8;
}
void raisePeak(Task& t) {
  t.peak = std::min(1.15 * t.peak, 780e3);  // below the limit of the chamber, which has a valve there
}
void faster(Task& t) {
  t.rate *= 2;
}
void slower(Task& t) {
  t.rate *= 0.4;
}
void shortenDwell(Task& t) {
  t.dwell_peak *= 0.2;
}
void lengthenDwell(Task& t) {
  t.dwell_peak += 15;
}
void loopToZero(Task& t) {
  t.low = 0;
}

std::string names() {
  std::string text;
  for (const Mistake& mistake : mistakes()) text += (text.empty() ? "" : ", ") + mistake.name;
  return text;
}

ScriptedMistake readMistake(const std::string& text) {
  const std::size_t at = text.find('@');
  ScriptedMistake result{mistakeCalled(text.substr(0, at)).name, 0};
  if (at == std::string::npos) return result;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + at + 1, end, result.step);
  if (read.ec != std::errc() || read.ptr != end) {
    throw settings::InputError("mistakes: \"" + text +
                               "\" has no number of a step behind \"@\"; write e.g. peak_too_low@5");
  }
  return result;
}

}  // namespace

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> kMistakes = {
      {"skip_surface", "puts the sheet on the next surface of the shelf instead of the one asked for",
       Notice::kReadings, "other_surface mounts_disagree", Slip::kNextSurface, mounts, nullptr},
      {"swap_surfaces",
       "puts the sheet on the next surface first, and on the one asked for at the next mount",
       Notice::kReadings, "other_surface mounts_disagree", Slip::kSwapSurfaces, mounts, nullptr},
      {"repeat_surface", "puts the sheet back on the surface from which it was taken", Notice::kReadings,
       "other_surface mounts_disagree", Slip::kSurfaceBefore, mounts, nullptr},
      {"wrong_surface_later", "confirms the right surface, then takes another one", Notice::kReadings,
       "other_surface mounts_disagree", Slip::kWrongSurfaceLater, mounts, nullptr},
      {"turned_over", "puts the sheet on with its other face up", Notice::kReadings,
       "other_surface mounts_disagree", Slip::kTurnedOver, mounts, nullptr},
      {"confirm_without_mounting", "confirms and leaves the sheet where it lies", Notice::kReadings,
       "other_surface mounts_disagree", Slip::kNoMounting, mounts, nullptr},
      {"forget_confirming", "puts the sheet on and does not confirm until asked again", Notice::kWaiting, "",
       Slip::kNoConfirmation, mounts, nullptr},
      {"press_before_confirming", "fills the chamber before the mount is confirmed", Notice::kPressure,
       "not_confirmed", Slip::kPressBeforeConfirming, mounts, nullptr},
      {"forget_conditioning", "leaves the chamber at rest instead of conditioning", Notice::kWaiting, "",
       Slip::kNothingDone, conditions, nullptr},
      {"forget_rest", "fills the chamber during the rest", Notice::kPressure, "rest_too_short rest_disturbed",
       Slip::kPressAtRest, rests, nullptr},
      {"skip_cycle", "leaves the chamber at rest: one cycle too few", Notice::kWaiting, "",
       Slip::kNothingDone, cycles, nullptr},
      {"extra_cycle", "does the last cycle twice: one cycle too many", Notice::kPressure,
       "rest_too_short rest_disturbed rest_not_reached peak_overshot", Slip::kTwice, endsTheCycles, nullptr},
      {"stop_halfway", "vents at half of the peak", Notice::kPressure, "peak_missed", Slip::kStopHalfway,
       cycles, nullptr},
      {"peak_too_low", "stops filling at 80 % of the peak", Notice::kPressure, "peak_missed chamber_stalled",
       Slip::kNumbers, reachesAPeak, lowerPeak},
      {"peak_too_high", "stops filling at 115 % of the peak", Notice::kPressure, "peak_overshot",
       Slip::kNumbers, reachesAPeak, raisePeak},
      {"too_fast", "fills and vents at twice the rate", Notice::kPressure, "fill_too_fast vent_too_fast",
       Slip::kNumbers, cycles, faster},
      {"too_slow", "fills and vents at 40 % of the rate", Notice::kPressure, "fill_too_slow vent_too_slow",
       Slip::kNumbers, cycles, slower},
      {"dwell_too_short", "vents after a fifth of the dwell", Notice::kPressure, "dwell_too_short",
       Slip::kNumbers, dwells, shortenDwell},
      {"dwell_too_long", "vents 15 s late", Notice::kPressure, "dwell_too_long", Slip::kNumbers, cycles,
       lengthenDwell},
      {"leak", "overlooks a leak: the pressure falls to 80 % during the dwell", Notice::kPressure, "leak",
       Slip::kLeak, dwells, nullptr},
      {"no_unloading", "vents to half of the peak only", Notice::kPressure, "no_unloading rest_not_reached",
       Slip::kNoUnloading, cycles, nullptr},
      {"pause_in_cycle", "stops for 30 s at half of the peak, then goes on", Notice::kPressure,
       "fill_too_slow chamber_stalled", Slip::kPause, cycles, nullptr},
      {"valve_opened", "opens the valve at 60 % of the peak, closes it at 20 % and goes on",
       Notice::kPressure, "peak_missed", Slip::kValveOpened, cycles, nullptr},
      {"loop_to_zero", "vents to zero before a further partial loop", Notice::kPressure,
       "base_missed no_unloading", Slip::kNumbers, loopsAgain, loopToZero},
      {"sheet_off", "lets the sheet slip off its surface in mid-cycle", Notice::kPressure, "sheet_off",
       Slip::kSheetOff, cycles, nullptr},
      {"taxel_out", "pulls at the cable, so that a taxel has no contact", Notice::kPressure, "taxel_fell_out",
       Slip::kTaxelOut, cycles, nullptr},
      {"board_unplugged", "unplugs the board in mid-cycle", Notice::kPressure, "scans_lost pressure_lost",
       Slip::kBoardUnplugged, cycles, nullptr},
      {"transducer_unplugged", "unplugs the transducer in mid-cycle: it reads the lower end of its range",
       Notice::kPressure, "pressure_invalid pressure_lost", Slip::kTransducerUnplugged, cycles, nullptr},
      {"transducer_silent", "switches the transducer off in mid-cycle: no more readings come",
       Notice::kPressure, "pressure_lost", Slip::kTransducerSilent, cycles, nullptr},
      {"terminal_closed", "closes the conductor's terminal in mid-cycle", Notice::kPressure, "not_confirmed",
       Slip::kTerminalClosed, cycles, nullptr},
  };
  return kMistakes;
}

const Mistake& mistakeCalled(const std::string& name) {
  for (const Mistake& mistake : mistakes()) {
    if (mistake.name == name) return mistake;
  }
  throw settings::InputError("mistakes: there is no mistake \"" + name + "\"; there are " + names());
}

std::vector<ScriptedMistake> readMistakes(const std::string& script) {
  std::vector<ScriptedMistake> result;
  std::istringstream stream(script);
  for (std::string text; std::getline(stream, text, ',');) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    result.push_back(readMistake(text.substr(begin, text.find_last_not_of(' ') + 1 - begin)));
  }
  return result;
}

}  // namespace fsr::emulator
