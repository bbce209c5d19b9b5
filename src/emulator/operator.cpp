#include "emulator/operator.h"

#include <algorithm>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::emulator {

namespace {

constexpr double kFirstRate = 17e3;           // where no instruction has named a rate yet [Pa/s]
constexpr double kFirstPeak = 100e3;          // likewise a peak [Pa]
constexpr double kPause = 30;                 // of pause_in_cycle [s]
constexpr double kBeforeTheNextHold = 3;      // without load, after an attempt was rejected [s]
constexpr double kBeforeSecondThought = 1;    // from the confirmation to the wrong surface [s]
constexpr std::uint32_t kPutOnAgain = 10000;  // added to the mount's number each time

bool aboutSurfaces(Slip slip) {
  return slip == Slip::kNextSurface || slip == Slip::kSwapSurfaces || slip == Slip::kWrongSurfaceLater;
}

// Whether a remark makes a person look at the sheet.
bool isAboutTheSheet(const std::string& remark) {
  return remark.find("surface") != std::string::npos || remark.find("sheet") != std::string::npos;
}

}  // namespace

std::string describe(const Act& act) {
  switch (act.kind) {
    case Act::Kind::kTakeOff:
      return "take the sheet off";
    case Act::Kind::kPutOn:
      return "put the sheet on " + act.surface + (act.turned_over ? ", turned over" : "");
    case Act::Kind::kConfirm:
      return "confirm";
    case Act::Kind::kUnplugBoard:
      return "unplug the board";
    case Act::Kind::kPlugBoard:
      return "plug the board in";
    case Act::Kind::kUnplugTransducer:
      return "unplug the transducer";
    case Act::Kind::kSilenceTransducer:
      return "switch the transducer off";
    case Act::Kind::kPlugTransducer:
      return "plug the transducer in";
    case Act::Kind::kLoseTaxel:
      return "pull at the cable of the sheet";
    case Act::Kind::kFixTaxels:
      return "press the connector of the sheet down";
    case Act::Kind::kCloseTerminal:
      return "close the terminal of the conductor";
  }
  return "";
}

Habits Habits::exact() {
  Habits habits;
  habits.reaction_least = habits.reaction_most = habits.change_least = habits.change_most = 0;
  habits.confirm = habits.peak = habits.rate = habits.dwell = 0;
  return habits;
}

Operator::Operator(const OperatorOptions& options)
    : options_(options),
      random_(statistics::randomStream(options.seed, "operator")),
      used_(options.mistakes.size(), false),
      asked_surface_(options.lies_on),
      lies_on_(options.lies_on) {
  pressed_.peak = kFirstPeak;
  pressed_.rate = kFirstRate;
  for (const ScriptedMistake& mistake : options_.mistakes) {
    if (!aboutSurfaces(mistakeCalled(mistake.name).slip) || options_.shelf.size() > 1) continue;
    throw settings::InputError("mistakes: " + mistake.name +
                               " needs two surfaces or more on the shelf, but there are " +
                               std::to_string(options_.shelf.size()));
  }
}

double Operator::draw(double least, double most) {
  return least + (most - least) * random_.uniform(drawn_++);
}

double Operator::around(double value, double share) {
  return value * draw(1 - share, 1 + share);
}

// --- instructions ------------------------------------------------------------------------------------

void Operator::instruct(double time, const Task& task) {
  validate(task);
  const std::string before = std::exchange(remark_, task.remark);
  const bool again = task_ && sameTask(*task_, task);
  const std::string rejected = rejection(task.remark);
  if (!again || (!rejected.empty() && rejected != rejection(before))) return begin(time, task);
  if (task.remark.empty() || task.remark == before) return;
  const double seen =
      std::max(time, deaf_until_) + draw(options_.habits.reaction_least, options_.habits.reaction_most);
  repair(seen);
  const bool vents = task.kind == TaskKind::kCycle || task.kind == TaskKind::kCondition;
  if (vents && seen > done_) {
    course_.cut(seen);
    course_.rampTo(0, pressed_.rate);
  }
}

void Operator::begin(double time, const Task& task) {
  const double seen = std::max(time, deaf_until_);
  const double begin = seen + draw(options_.habits.reaction_least, options_.habits.reaction_most);
  // A task that has not been begun is never begun.
  forgetFrom(task_ && begin_ > time ? begin_ : begin);
  course_.cut(begin);
  task_ = task;
  begin_ = begin;
  if (task.kind == TaskKind::kMount) {
    asked_surface_ = task.surface;
    asked_mount_ = task.mount;
  }
  if (!task.remark.empty()) repair(begin);
  if (!rejection(task.remark).empty()) putSheetRight();
  Task todo = task;
  if (!(todo.rate > 0)) todo.rate = pressed_.rate;
  const Mistake mistake = nextMistake(task, begin);
  if (mistake.change != nullptr) mistake.change(todo);
  carryOut(todo, mistake.slip);
  if (task.peak > 0) pressed_ = task;
  if (!(pressed_.rate > 0)) pressed_.rate = todo.rate;
  done_ = std::max(done_, course_.end());
}

void Operator::forgetFrom(double time) {
  course_.cut(time);
  const auto drops = [time](const PlannedAct& planned) {
    const bool ends = planned.keep == Keep::kWithTask || planned.act.kind == Act::Kind::kConfirm;
    return ends && planned.act.time >= time;
  };
  // Where a mounting is given up, the sheet stays where it was taken to.
  const auto given_up = std::find_if(acts_.begin(), acts_.end(), [&](const PlannedAct& planned) {
    return drops(planned) && planned.act.kind == Act::Kind::kPutOn;
  });
  if (given_up != acts_.end()) lies_on_.clear();
  acts_.erase(std::remove_if(acts_.begin(), acts_.end(), drops), acts_.end());
}

Mistake Operator::nextMistake(const Task& task, double time) {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const Mistake& mistake = mistakeCalled(options_.mistakes[i].name);
    if (used_[i] || task.step < options_.mistakes[i].step || !mistake.suits(task)) continue;
    used_[i] = true;
    made_.push_back({mistake.name, task.step, time});
    return mistake;
  }
  Mistake none;
  none.slip = Slip::kNone;
  return none;
}

std::vector<std::string> Operator::pending() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (!used_[i]) names.push_back(options_.mistakes[i].name);
  }
  return names;
}

// --- acts ------------------------------------------------------------------------------------------

std::vector<Act> Operator::takeActs(double time) {
  const bool presses = task_ && task_->kind != TaskKind::kMount && task_->peak > 0;
  if (presses && time > done_ + options_.habits.patience) begin(time, Task(*task_));
  std::vector<Act> acts;
  const auto later = std::find_if(acts_.begin(), acts_.end(),
                                  [time](const PlannedAct& planned) { return planned.act.time > time; });
  std::for_each(acts_.begin(), later, [&](const PlannedAct& planned) { acts.push_back(planned.act); });
  acts_.erase(acts_.begin(), later);
  return acts;
}

void Operator::plan(double time, Act::Kind kind, Keep keep) {
  PlannedAct planned{{}, keep};
  planned.act.time = time;
  planned.act.kind = kind;
  if (kind == Act::Kind::kLoseTaxel) planned.act.pick = draw(0, 1);
  insert(planned);
}

void Operator::insert(const PlannedAct& planned) {
  const double time = planned.act.time;
  const auto later = std::find_if(acts_.begin(), acts_.end(),
                                  [time](const PlannedAct& other) { return other.act.time > time; });
  acts_.insert(later, planned);
}

// Takes the sheet off and puts it on a surface, from the end of the course on. The chamber is vented first.
void Operator::putOn(const std::string& surface, bool turned_over, Keep keep) {
  course_.rampTo(0, pressed_.rate);
  const double change = draw(options_.habits.change_least, options_.habits.change_most);
  if (change > 0) plan(course_.end(), Act::Kind::kTakeOff, keep);
  course_.stay(change);
  again_ = put_on_mount_ == asked_mount_ ? again_ + 1 : 0;
  put_on_mount_ = asked_mount_;
  PlannedAct planned{{}, keep};
  planned.act = {
      course_.end(), Act::Kind::kPutOn, surface, asked_mount_ + again_ * kPutOnAgain, turned_over, 0};
  insert(planned);
  lies_on_ = surface;
  turned_over_ = turned_over;
}

// Everything that is to be repaired at some time is repaired now.
void Operator::repair(double time) {
  for (PlannedAct& planned : acts_) {
    if (planned.keep == Keep::kRepair) planned.act.time = std::min(planned.act.time, time);
  }
  std::stable_sort(acts_.begin(), acts_.end(),
                   [](const PlannedAct& a, const PlannedAct& b) { return a.act.time < b.act.time; });
  if (taxel_out_) plan(time, Act::Kind::kFixTaxels, Keep::kAlways);
  taxel_out_ = false;
}

void Operator::putSheetRight() {
  swapped_.reset();
  if (task_->kind == TaskKind::kMount) return;  // mount() does it
  const bool wrong = lies_on_ != asked_surface_ || turned_over_;
  if (lies_on_.empty() || (wrong && isAboutTheSheet(task_->remark))) putOn(asked_surface_, false);
}

// --- tasks -----------------------------------------------------------------------------------------

void Operator::carryOut(const Task& task, Slip slip) {
  done_ = begin_;
  switch (task.kind) {
    case TaskKind::kMount:
      return mount(task, slip);
    case TaskKind::kCondition:
    case TaskKind::kCycle:
      press(task, slip);
      break;
    case TaskKind::kHold:
      hold(task, slip);
      break;
    case TaskKind::kLoop:
      loop(task);
      break;
    case TaskKind::kRest:
    case TaskKind::kBreak:
      rest(task, slip);
      break;
    case TaskKind::kDone:
      course_.rampTo(0, task.rate);
      break;
  }
  if (task.confirm) confirmLater(options_.habits.confirm);
}

void Operator::confirmLater(double delay) {
  done_ = course_.end() + delay;
  plan(done_, Act::Kind::kConfirm);
}

std::string Operator::nextOnShelf(const std::string& surface) const {
  const auto& shelf = options_.shelf;
  const auto here = std::find(shelf.begin(), shelf.end(), surface);
  if (here == shelf.end()) return shelf.front();
  return std::next(here) == shelf.end() ? shelf.front() : *std::next(here);
}

void Operator::mount(const Task& task, Slip slip) {
  course_.rampTo(0, task.rate);
  const bool lies_right = put_on_mount_ == task.mount && lies_on_ == task.surface && !turned_over_;
  if (slip == Slip::kNextSurface) {
    putOn(nextOnShelf(task.surface), false);
  } else if (slip == Slip::kSwapSurfaces) {
    putOn(nextOnShelf(task.surface), false);
    swapped_ = task.surface;
  } else if (swapped_ && *swapped_ != task.surface) {
    putOn(*swapped_, false);
    swapped_.reset();
  } else if (slip == Slip::kSurfaceBefore) {
    putOn(lies_on_, turned_over_);
  } else if (slip != Slip::kNoMounting && !(lies_right && slip == Slip::kNone)) {
    putOn(task.surface, slip == Slip::kTurnedOver);
  }
  if (slip == Slip::kPressBeforeConfirming) press(pressed_, Slip::kNone);
  if (slip == Slip::kNoConfirmation) {
    plan(course_.end() + options_.habits.patience, Act::Kind::kConfirm, Keep::kRepair);
  } else {
    confirmLater(options_.habits.confirm);
  }
  if (slip != Slip::kWrongSurfaceLater) return;
  course_.stay(done_ + kBeforeSecondThought - course_.end());
  putOn(nextOnShelf(task.surface), false, Keep::kAlways);
  deaf_until_ = course_.end();
}

void Operator::press(const Task& task, Slip slip) {
  course_.rampTo(0, task.rate);
  if (slip == Slip::kNothingDone) course_.stay(options_.habits.patience);
  course_.stay(task.dwell_rest);
  fill(task, slip);
  if (slip != Slip::kTwice) return;
  course_.stay(task.dwell_rest);
  fill(task, Slip::kNone);
  deaf_until_ = course_.end();
}

// Fills, dwells and vents.
void Operator::fill(const Task& task, Slip slip) {
  const double peak = around(task.peak, options_.habits.peak);
  const double up = around(task.rate, options_.habits.rate), down = around(task.rate, options_.habits.rate);
  const double dwell = task.dwell_peak + draw(0, options_.habits.dwell);
  handle(slip, course_.end() + peak / 2 / up);
  if (slip == Slip::kStopHalfway || slip == Slip::kPause) course_.rampTo(peak / 2, up);
  if (slip == Slip::kStopHalfway) return course_.rampTo(0, down);
  if (slip == Slip::kPause) course_.stay(kPause);
  if (slip == Slip::kValveOpened) {
    course_.rampTo(0.6 * peak, up);
    course_.rampTo(0.2 * peak, 10 * down);
  }
  course_.rampTo(peak, up);
  if (slip == Slip::kLeak) {
    course_.moveTo(0.8 * peak, dwell);
  } else {
    course_.stay(dwell);
  }
  course_.rampTo(slip == Slip::kNoUnloading ? peak / 2 : 0, down);
}

// What the hands do in mid-cycle.
void Operator::handle(Slip slip, double half_way) {
  const double repaired = half_way + options_.habits.repair;
  const auto breakAndRepair = [&](Act::Kind fault, Act::Kind repair) {
    plan(half_way, fault);
    plan(repaired, repair, Keep::kRepair);
  };
  switch (slip) {
    case Slip::kSheetOff:
      plan(half_way, Act::Kind::kTakeOff);
      lies_on_.clear();
      break;
    case Slip::kTaxelOut:
      plan(half_way, Act::Kind::kLoseTaxel);
      taxel_out_ = true;
      break;
    case Slip::kBoardUnplugged:
      breakAndRepair(Act::Kind::kUnplugBoard, Act::Kind::kPlugBoard);
      break;
    case Slip::kTransducerUnplugged:
      breakAndRepair(Act::Kind::kUnplugTransducer, Act::Kind::kPlugTransducer);
      break;
    case Slip::kTransducerSilent:
      breakAndRepair(Act::Kind::kSilenceTransducer, Act::Kind::kPlugTransducer);
      break;
    case Slip::kTerminalClosed:
      plan(half_way, Act::Kind::kCloseTerminal);
      break;
    default:
      break;
  }
}

void Operator::hold(const Task& task, Slip slip) {
  const double peak = around(task.peak, options_.habits.peak);
  const double planned = task.dwell_peak > 0 ? task.dwell_peak : task.duration;
  const double dwell = planned + draw(0, options_.habits.dwell);
  if (!rejection(task.remark).empty()) {  // the next attempt begins at rest
    course_.rampTo(0, task.rate);
    course_.stay(kBeforeTheNextHold);
  }
  course_.rampTo(peak, around(task.rate, options_.habits.rate));
  course_.moveTo(slip == Slip::kLeak ? 0.8 * peak : peak, dwell);
}

void Operator::loop(const Task& task) {
  const double rate = around(task.rate, options_.habits.rate);
  const double low = around(task.low, options_.habits.peak);
  course_.rampTo(low, rate);
  course_.rampTo(around(task.peak, options_.habits.peak), rate);
  course_.rampTo(low, rate);
}

void Operator::rest(const Task& task, Slip slip) {
  const double length = task.dwell_rest > 0 ? task.dwell_rest : task.duration;
  course_.rampTo(0, task.rate);
  if (slip == Slip::kPressAtRest) {
    course_.stay(length / 3);
    fill(pressed_, Slip::kNone);
  }
  course_.stay(length + draw(0, options_.habits.dwell));
}

}  // namespace fsr::emulator
