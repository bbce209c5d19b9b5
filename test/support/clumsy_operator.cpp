#include "support/clumsy_operator.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace test_support {

using fsr::emulator::Act;
using fsr::emulator::Board;
using fsr::emulator::LineDamage;
using fsr::emulator::Task;
using fsr::emulator::TaskKind;

namespace {

constexpr double kPause = 30;               // of pause_in_cycle [s]
constexpr double kBeforeSecondThought = 1;  // from the confirmation to the wrong surface [s]
constexpr double kLongDwell = 5;            // shorter dwells are within the usual tolerance of 2 s anyway [s]

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

// A surface as a sheet feels it whose other face is up: turned by half a turn round the axis y.
fsr::matrix::Surface turnedOver(fsr::matrix::Surface surface) {
  for (fsr::matrix::Curvature& one : surface.curvature) one = {-one.x, -one.y, one.xy};
  return surface;
}

}  // namespace

const char kCloseTerminal[] = "close the terminal of the conductor";

const std::vector<Mistake>& mistakes() {
  constexpr char kOtherSurface[] = "other_surface mounts_disagree";
  static const std::vector<Mistake> kMistakes = {
      {"skip_surface", Notice::kReadings, kOtherSurface, Slip::kNextSurface, mounts, nullptr},
      {"swap_surfaces", Notice::kReadings, kOtherSurface, Slip::kSwapSurfaces, mounts, nullptr},
      {"repeat_surface", Notice::kReadings, kOtherSurface, Slip::kSurfaceBefore, mounts, nullptr},
      {"wrong_surface_later", Notice::kReadings, kOtherSurface, Slip::kWrongSurfaceLater, mounts, nullptr},
      {"turned_over", Notice::kReadings, kOtherSurface, Slip::kTurnedOver, mounts, nullptr},
      {"confirm_without_mounting", Notice::kReadings, kOtherSurface, Slip::kNoMounting, mounts, nullptr},
      {"forget_confirming", Notice::kWaiting, "", Slip::kNoConfirmation, mounts, nullptr},
      {"press_before_confirming", Notice::kPressure, "not_confirmed", Slip::kPressBeforeConfirming, mounts,
       nullptr},
      {"forget_conditioning", Notice::kWaiting, "", Slip::kNothingDone, conditions, nullptr},
      {"forget_rest", Notice::kPressure, "rest_too_short rest_disturbed", Slip::kPressAtRest, rests, nullptr},
      {"skip_cycle", Notice::kWaiting, "", Slip::kNothingDone, cycles, nullptr},
      {"extra_cycle", Notice::kPressure, "rest_too_short rest_disturbed rest_not_reached peak_overshot",
       Slip::kTwice, endsTheCycles, nullptr},
      {"stop_halfway", Notice::kPressure, "peak_missed", Slip::kStopHalfway, cycles, nullptr},
      {"peak_too_low", Notice::kPressure, "peak_missed chamber_stalled", Slip::kNumbers, reachesAPeak,
       [](Task& t) { t.peak *= 0.8; }},
      // Below the limit of the chamber, which has a valve there.
      {"peak_too_high", Notice::kPressure, "peak_overshot", Slip::kNumbers, reachesAPeak,
       [](Task& t) { t.peak = std::min(1.15 * t.peak, 780e3); }},
      {"too_fast", Notice::kPressure, "fill_too_fast vent_too_fast", Slip::kNumbers, cycles,
       [](Task& t) { t.rate *= 2; }},
      {"too_slow", Notice::kPressure, "fill_too_slow vent_too_slow", Slip::kNumbers, cycles,
       [](Task& t) { t.rate *= 0.4; }},
      {"dwell_too_short", Notice::kPressure, "dwell_too_short", Slip::kNumbers, dwells,
       [](Task& t) { t.dwell_peak *= 0.2; }},
      {"dwell_too_long", Notice::kPressure, "dwell_too_long", Slip::kNumbers, cycles,
       [](Task& t) { t.dwell_peak += 15; }},
      {"leak", Notice::kPressure, "leak", Slip::kLeak, dwells, nullptr},
      {"no_unloading", Notice::kPressure, "no_unloading rest_not_reached", Slip::kNoUnloading, cycles,
       nullptr},
      {"pause_in_cycle", Notice::kPressure, "fill_too_slow chamber_stalled", Slip::kPause, cycles, nullptr},
      {"valve_opened", Notice::kPressure, "peak_missed", Slip::kValveOpened, cycles, nullptr},
      {"loop_to_zero", Notice::kPressure, "base_missed no_unloading", Slip::kNumbers, loopsAgain,
       [](Task& t) { t.low = 0; }},
      {"sheet_off", Notice::kPressure, "sheet_off", Slip::kSheetOff, cycles, nullptr},
      {"taxel_out", Notice::kPressure, "taxel_fell_out", Slip::kTaxelOut, cycles, nullptr},
      {"board_unplugged", Notice::kPressure, "scans_lost pressure_lost", Slip::kBoardUnplugged, cycles,
       nullptr},
      {"transducer_unplugged", Notice::kPressure, "pressure_invalid pressure_lost",
       Slip::kTransducerUnplugged, cycles, nullptr},
      {"transducer_silent", Notice::kPressure, "pressure_lost", Slip::kTransducerSilent, cycles, nullptr},
      {"terminal_closed", Notice::kPressure, "not_confirmed", Slip::kTerminalClosed, cycles, nullptr},
  };
  return kMistakes;
}

const Mistake& mistakeCalled(const std::string& name) {
  for (const Mistake& mistake : mistakes()) {
    if (mistake.name == name) return mistake;
  }
  throw std::out_of_range("no mistake " + name);
}

ClumsyOperator::ClumsyOperator(const ClumsyOptions& options) : Operator(options.person), clumsy_(options) {
  std::istringstream stream(options.script);
  for (std::string one; std::getline(stream, one, ',');) {
    const std::size_t at = one.find('@');
    const unsigned long step = at == std::string::npos ? 0 : std::stoul(one.substr(at + 1));
    script_.push_back({mistakeCalled(one.substr(0, at)), static_cast<std::uint32_t>(step), false});
  }
}

std::vector<std::string> ClumsyOperator::pending() const {
  std::vector<std::string> names;
  for (const Scripted& one : script_) {
    if (!one.used) names.push_back(one.mistake.name);
  }
  return names;
}

// --- what is noticed ---------------------------------------------------------------------------------

void ClumsyOperator::hear(double time, const Task& task) {
  const double seen =
      std::max(time, deaf_until_) + draw(options_.habits.reaction_least, options_.habits.reaction_most);
  repair(seen);
  const bool vents = task.kind == TaskKind::kCycle || task.kind == TaskKind::kCondition;
  if (!vents || seen <= done_) return;
  course_.cut(seen);
  vent(pressed_.rate);
}

// Everything that is to be repaired at some time is repaired now.
void ClumsyOperator::repair(double time) {
  for (Act& act : acts_) {
    if (act.stays) act.time = std::min(act.time, time);
  }
  std::stable_sort(acts_.begin(), acts_.end(), [](const Act& a, const Act& b) { return a.time < b.time; });
  if (taxel_out_)
    does(
        time, "press the connector of the sheet down",
        [](Board& board, LineDamage&, double) { board.fixTaxels(); }, true);
  taxel_out_ = false;
}

void ClumsyOperator::prepare(double time, const Task& task) {
  if (!task.remark.empty()) repair(time);
  if (fsr::emulator::rejection(task.remark).empty()) return;
  swapped_.clear();
  if (task.kind == TaskKind::kMount) return;  // mount() does it
  const bool about_the_sheet =
      task.remark.find("surface") != std::string::npos || task.remark.find("sheet") != std::string::npos;
  if (lies_on_.empty() || (about_the_sheet && (lies_on_ != asked_surface_ || turned_over_))) {
    putOn(asked_surface_);
    turned_over_ = false;
  }
}

void ClumsyOperator::does(double time, const std::string& words, const Change& change, bool stays) {
  Act act;
  act.time = time;
  act.kind = Act::Kind::kOther;
  act.words = words;
  act.change = change;
  act.stays = stays;
  plan(act);
}

// --- tasks -------------------------------------------------------------------------------------------

void ClumsyOperator::carryOut(Task task) {
  slip_ = Slip::kNone;
  for (Scripted& one : script_) {
    if (one.used || task.step < one.step || !one.mistake.suits(*task_)) continue;
    one.used = true;
    made_.push_back({one.mistake.name, task.step, done_});
    slip_ = one.mistake.slip;
    if (one.mistake.change != nullptr) one.mistake.change(task);
    break;
  }
  Operator::carryOut(task);
}

std::string ClumsyOperator::nextOnShelf(const std::string& surface) const {
  const auto& shelf = clumsy_.shelf;
  const auto here = std::find(shelf.begin(), shelf.end(), surface);
  return here == shelf.end() || std::next(here) == shelf.end() ? shelf.front() : *std::next(here);
}

void ClumsyOperator::putOnTurnedOver(const std::string& surface) {
  putOn(surface);
  turned_over_ = true;
  Act& act =
      *std::find_if(acts_.begin(), acts_.end(), [](const Act& one) { return one.kind == Act::Kind::kPutOn; });
  act.kind = Act::Kind::kOther;
  act.words = "put the sheet on " + surface + ", turned over";
  act.change = [called = clumsy_.surface_called, surface, mount = act.mount](Board& board, LineDamage&,
                                                                             double) {
    fsr::matrix::Surface laid = turnedOver(called(surface));
    laid.mount = mount;
    board.mount(laid);
  };
}

void ClumsyOperator::mount(const Task& task) {
  vent(task.rate);
  std::string surface = task.surface;
  const bool swapped = !swapped_.empty() && swapped_ != task.surface;
  if (slip_ == Slip::kSwapSurfaces) swapped_ = task.surface;
  if (slip_ == Slip::kNextSurface || slip_ == Slip::kSwapSurfaces) {
    surface = nextOnShelf(task.surface);
  } else if (swapped) {
    surface = swapped_;
    swapped_.clear();
  } else if (slip_ == Slip::kSurfaceBefore) {
    surface = lies_on_;
  }
  const bool lies_right = put_on_mount_ == task.mount && lies_on_ == surface && !turned_over_;
  if (slip_ == Slip::kTurnedOver) {
    putOnTurnedOver(surface);
  } else if (slip_ != Slip::kNoMounting && (!lies_right || slip_ != Slip::kNone)) {
    putOn(surface);
    turned_over_ = false;
  }
  if (slip_ == Slip::kPressBeforeConfirming) Operator::press(pressed_);
  confirmLater(slip_ == Slip::kNoConfirmation ? options_.habits.patience : options_.habits.confirm);
  if (slip_ == Slip::kNoConfirmation) {
    done_ = course_.end();
    for (Act& act : acts_) act.stays = act.stays || act.kind == Act::Kind::kConfirm;
  }
  if (slip_ != Slip::kWrongSurfaceLater) return;
  course_.stay(done_ + kBeforeSecondThought - course_.end());
  putOn(nextOnShelf(task.surface));
  deaf_until_ = course_.end() + 1e-3;
}

void ClumsyOperator::press(const Task& task) {
  vent(task.rate);
  if (slip_ == Slip::kNothingDone) course_.stay(options_.habits.patience);
  Operator::press(task);
  if (slip_ != Slip::kTwice) return;
  slip_ = Slip::kNone;
  Operator::press(task);
  deaf_until_ = course_.end();
}

void ClumsyOperator::fill(const Task& task) {
  const double peak = around(task.peak, options_.habits.peak);
  const double up = around(task.rate, options_.habits.rate), down = around(task.rate, options_.habits.rate);
  const double dwell = task.dwell_peak + draw(0, options_.habits.dwell);
  handle(course_.end() + peak / 2 / up);
  if (slip_ == Slip::kStopHalfway || slip_ == Slip::kPause) course_.rampTo(peak / 2, up);
  if (slip_ == Slip::kStopHalfway) return vent(down);
  if (slip_ == Slip::kPause) course_.stay(kPause);
  if (slip_ == Slip::kValveOpened) {
    course_.rampTo(0.6 * peak, up);
    course_.rampTo(0.2 * peak, 10 * down);
  }
  course_.rampTo(peak, up);
  course_.moveTo(slip_ == Slip::kLeak ? 0.8 * peak : peak, dwell);
  course_.rampTo(slip_ == Slip::kNoUnloading ? peak / 2 : 0, down);
}

// What the hands do in mid-cycle.
void ClumsyOperator::handle(double half_way) {
  using Line = Board::TransducerLine;
  const auto breakAndRepair = [&](const char* fault, const Change& broken, const char* repair,
                                  const Change& repaired) {
    does(half_way, fault, broken);
    does(half_way + clumsy_.repair, repair, repaired, true);
  };
  const auto line = [](Line state) {
    return [state](Board& board, LineDamage&, double time) { board.setTransducer(state, time); };
  };
  const auto plug = [](bool out) {
    return [out](Board&, LineDamage& damage, double) { damage.unplugged = out; };
  };
  if (slip_ == Slip::kSheetOff) {
    plan(half_way, Act::Kind::kTakeOff);
    lies_on_.clear();
  } else if (slip_ == Slip::kTaxelOut) {
    taxel_out_ = true;
    does(half_way, "pull at the cable of the sheet",
         [](Board& board, LineDamage&, double) { board.loseTaxel(5); });  // it has neighbours on all sides
  } else if (slip_ == Slip::kBoardUnplugged) {
    breakAndRepair("unplug the board", plug(true), "plug the board in", plug(false));
  } else if (slip_ == Slip::kTransducerUnplugged) {
    breakAndRepair("unplug the transducer", line(Line::kUnplugged), "plug the transducer in",
                   line(Line::kWorks));
  } else if (slip_ == Slip::kTransducerSilent) {
    breakAndRepair("switch the transducer off", line(Line::kSilent), "plug the transducer in",
                   line(Line::kWorks));
  } else if (slip_ == Slip::kTerminalClosed) {
    does(half_way, kCloseTerminal, [](Board&, LineDamage&, double) {});
  }
}

void ClumsyOperator::hold(const Task& task) {
  const double begin = course_.end();
  Operator::hold(task);
  if (slip_ != Slip::kLeak) return;
  const double end = course_.end(), peak = course_.pressure();
  const double dwell = task.dwell_peak > 0 ? task.dwell_peak : task.duration;
  course_.cut(std::max(begin, end - dwell));
  course_.moveTo(0.8 * peak, dwell);
}

void ClumsyOperator::rest(const Task& task) {
  vent(task.rate);
  if (slip_ == Slip::kPressAtRest) {
    course_.stay((task.dwell_rest > 0 ? task.dwell_rest : task.duration) / 3);
    Operator::fill(pressed_);
  }
  Operator::rest(task);
}

}  // namespace test_support
