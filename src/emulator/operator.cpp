#include "emulator/operator.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"
#include "fsr_pressure_map/simulation/chamber.h"

namespace fsr::emulator {

namespace {

constexpr double kFirstRate = 17e3;           // where no instruction has named a rate yet [Pa/s]
constexpr double kFirstPeak = 100e3;          // likewise a peak [Pa]
constexpr double kBeforeTheNextHold = 3;      // without load, after an attempt was rejected [s]
constexpr std::uint32_t kPutOnAgain = 10000;  // added to the mount's number each time

const settings::Range kPressure{0, simulation::kChamberRating, "Pa gauge (the chamber is rated at 793 kPa)"};
const settings::Range kRate{1, 1e7, "Pa/s"};
const settings::Range kTime{0, 1e7, "s"};

// Whether two instructions ask for the same, whatever they remark.
bool sameTask(const Task& a, const Task& b) {
  const auto fields = [](const Task& t) {
    return std::tie(t.kind, t.step, t.surface, t.mount, t.cycle, t.cycles, t.low, t.peak, t.rate,
                    t.dwell_peak, t.dwell_rest, t.duration, t.confirm);
  };
  return fields(a) == fields(b);
}

void require(const Task& task, const char* field, double value, const settings::Range& range) {
  if (range.contains(value)) return;
  std::ostringstream sentence;
  sentence << "instruction of step " << task.step << " (" << name(task.kind) << "): " << field << " is "
           << value << ", but must be " << range.text();
  throw settings::InputError(sentence.str());
}

}  // namespace

std::string name(TaskKind kind) {
  static const char* const kNames[] = {"condition", "mount", "rest",  "cycle",
                                       "loop",      "hold",  "break", "done"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string rejection(const std::string& remark) {
  const std::size_t begin = remark.find("rejected: ");
  return begin == std::string::npos ? "" : remark.substr(begin);
}

void validate(const Task& task) {
  require(task, "low", task.low, kPressure);
  require(task, "peak", task.peak, kPressure);
  if (task.rate != 0) require(task, "rate", task.rate, kRate);
  require(task, "dwell_peak", task.dwell_peak, kTime);
  require(task, "dwell_rest", task.dwell_rest, kTime);
  require(task, "duration", task.duration, kTime);
  if (task.kind == TaskKind::kMount && task.surface.empty()) {
    throw settings::InputError("instruction of step " + std::to_string(task.step) +
                               " (mount): surface is empty, but must be the name of a surface");
  }
}

std::string describe(const Act& act) {
  switch (act.kind) {
    case Act::Kind::kTakeOff:
      return "take the sheet off";
    case Act::Kind::kPutOn:
      return "put the sheet on " + act.surface;
    case Act::Kind::kConfirm:
      return "confirm";
    case Act::Kind::kOther:
      break;
  }
  return act.words;
}

Habits Habits::exact() {
  Habits habits;
  habits.reaction_least = habits.reaction_most = habits.change_least = habits.change_most = 0;
  habits.confirm = habits.peak = habits.rate = habits.dwell = 0;
  return habits;
}

Operator::Operator(const OperatorOptions& options)
    : options_(options),
      asked_surface_(options.lies_on),
      lies_on_(options.lies_on),
      random_(statistics::randomStream(options.seed, "operator")) {
  pressed_.peak = kFirstPeak;
  pressed_.rate = kFirstRate;
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
  if (!task.remark.empty() && task.remark != before) hear(time, task);
}

void Operator::begin(double time, const Task& task) {
  const double begin =
      std::max(time, deaf_until_) + draw(options_.habits.reaction_least, options_.habits.reaction_most);
  // A task that has not been begun is never begun.
  forgetFrom(task_ && begin_ > time ? begin_ : begin);
  course_.cut(begin);
  task_ = task;
  begin_ = done_ = begin;
  if (task.kind == TaskKind::kMount) {
    asked_surface_ = task.surface;
    asked_mount_ = task.mount;
  }
  prepare(begin, task);
  Task todo = task;
  if (!(todo.rate > 0)) todo.rate = pressed_.rate;
  carryOut(todo);
  if (task.peak > 0) pressed_ = task;
  if (!(pressed_.rate > 0)) pressed_.rate = todo.rate;
  done_ = std::max(done_, course_.end());
}

void Operator::forgetFrom(double time) {
  course_.cut(time);
  const auto drops = [time](const Act& act) {
    return act.time >= time && (!act.stays || act.kind == Act::Kind::kConfirm);
  };
  // Where a mounting is given up, the sheet stays where it was taken to.
  for (const Act& act : acts_) {
    if (drops(act) && act.kind == Act::Kind::kPutOn) lies_on_.clear();
  }
  acts_.erase(std::remove_if(acts_.begin(), acts_.end(), drops), acts_.end());
}

// --- acts ------------------------------------------------------------------------------------------

std::vector<Act> Operator::takeActs(double time) {
  const bool presses = task_ && task_->kind != TaskKind::kMount && task_->peak > 0;
  if (presses && time > done_ + options_.habits.patience) begin(time, Task(*task_));
  const auto later =
      std::find_if(acts_.begin(), acts_.end(), [time](const Act& act) { return act.time > time; });
  std::vector<Act> acts(acts_.begin(), later);
  acts_.erase(acts_.begin(), later);
  return acts;
}

void Operator::plan(Act act) {
  const auto later =
      std::find_if(acts_.begin(), acts_.end(), [&](const Act& other) { return other.time > act.time; });
  acts_.insert(later, std::move(act));
}

void Operator::plan(double time, Act::Kind kind) {
  Act act;
  act.time = time;
  act.kind = kind;
  plan(act);
}

// Takes the sheet off and puts it on a surface, from the end of the course on. The chamber is vented first.
void Operator::putOn(const std::string& surface) {
  vent(pressed_.rate);
  const double change = draw(options_.habits.change_least, options_.habits.change_most);
  if (change > 0) plan(course_.end(), Act::Kind::kTakeOff);
  course_.stay(change);
  again_ = put_on_mount_ == asked_mount_ ? again_ + 1 : 0;
  put_on_mount_ = asked_mount_;
  Act act;
  act.time = course_.end();
  act.kind = Act::Kind::kPutOn;
  act.surface = surface;
  act.mount = asked_mount_ + again_ * kPutOnAgain;
  plan(act);
  lies_on_ = surface;
}

void Operator::confirmLater(double delay) {
  done_ = course_.end() + delay;
  plan(done_, Act::Kind::kConfirm);
}

// --- tasks -----------------------------------------------------------------------------------------

void Operator::carryOut(Task task) {
  switch (task.kind) {
    case TaskKind::kMount:
      return mount(task);
    case TaskKind::kCondition:
    case TaskKind::kCycle:
      press(task);
      break;
    case TaskKind::kHold:
      hold(task);
      break;
    case TaskKind::kLoop:
      loop(task);
      break;
    case TaskKind::kRest:
    case TaskKind::kBreak:
      rest(task);
      break;
    case TaskKind::kDone:
      vent(task.rate);
      break;
  }
  if (task.confirm) confirmLater(options_.habits.confirm);
}

void Operator::mount(const Task& task) {
  vent(task.rate);
  if (put_on_mount_ != task.mount || lies_on_ != task.surface) putOn(task.surface);
  confirmLater(options_.habits.confirm);
}

void Operator::press(const Task& task) {
  vent(task.rate);
  course_.stay(task.dwell_rest);
  fill(task);
}

// Fills, dwells and vents.
void Operator::fill(const Task& task) {
  const double peak = around(task.peak, options_.habits.peak);
  const double up = around(task.rate, options_.habits.rate), down = around(task.rate, options_.habits.rate);
  course_.rampTo(peak, up);
  course_.stay(task.dwell_peak + draw(0, options_.habits.dwell));
  vent(down);
}

void Operator::hold(const Task& task) {
  const double peak = around(task.peak, options_.habits.peak);
  const double planned = task.dwell_peak > 0 ? task.dwell_peak : task.duration;
  const double dwell = planned + draw(0, options_.habits.dwell);
  if (!rejection(task.remark).empty()) {  // the next attempt begins at rest
    vent(task.rate);
    course_.stay(kBeforeTheNextHold);
  }
  course_.rampTo(peak, around(task.rate, options_.habits.rate));
  course_.stay(dwell);
}

void Operator::loop(const Task& task) {
  const double rate = around(task.rate, options_.habits.rate);
  const double low = around(task.low, options_.habits.peak);
  course_.rampTo(low, rate);
  course_.rampTo(around(task.peak, options_.habits.peak), rate);
  course_.rampTo(low, rate);
}

void Operator::rest(const Task& task) {
  const double length = task.dwell_rest > 0 ? task.dwell_rest : task.duration;
  vent(task.rate);
  course_.stay(length + draw(0, options_.habits.dwell));
}

void PressureCourse::cut(double time) {
  const double pressure = at(time);
  while (points_.size() > 1 && points_.back().time >= time) points_.pop_back();
  if (points_.back().time < time) points_.push_back({time, pressure});
}

void PressureCourse::rampTo(double pressure, double rate) {
  moveTo(pressure, std::abs(pressure - this->pressure()) / rate);
}

void PressureCourse::moveTo(double pressure, double duration) {
  if (duration > 0) points_.push_back({end() + duration, pressure});
}

double PressureCourse::at(double time) const {
  const auto next =
      std::upper_bound(points_.begin(), points_.end(), time,
                       [](double t, const simulation::PressurePoint& point) { return t < point.time; });
  if (next == points_.begin()) return points_.front().pressure;
  if (next == points_.end()) return points_.back().pressure;
  const auto from = next - 1;
  return from->pressure + (next->pressure - from->pressure) * (time - from->time) / (next->time - from->time);
}

}  // namespace fsr::emulator
