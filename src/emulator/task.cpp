#include "emulator/task.h"

#include <sstream>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"
#include "fsr_pressure_map/simulation/chamber.h"

namespace fsr::emulator {

namespace {

const settings::Range kPressure{0, simulation::kChamberRating, "Pa gauge (the chamber is rated at 793 kPa)"};
const settings::Range kRate{1, 1e7, "Pa/s"};
const settings::Range kTime{0, 1e7, "s"};

auto fields(const Task& t) {
  return std::tie(t.kind, t.step, t.surface, t.mount, t.cycle, t.cycles, t.low, t.peak, t.rate, t.dwell_peak,
                  t.dwell_rest, t.duration, t.confirm);
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

bool sameTask(const Task& a, const Task& b) {
  return fields(a) == fields(b);
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

}  // namespace fsr::emulator
