// A map with a model of the sheet's memory gives bounded pressures for any sequence of readings, stamps,
// tares and rests, and its answer never feeds back: the same readings give the same answer whatever was
// published.
#include <cmath>
#include <vector>

#include "calibration/stages/memory/history_state.h"
#include "fuzz/fuzz_file.h"
#include "fuzz/hdf5_damage.h"

namespace {

constexpr double kPressures = 700e3;  // static answers lie within -kPressures and kPressures [Pa]

fsr::calibration::HistoryModel someModel() {
  fsr::calibration::HistoryModel model;
  model.family = fsr::calibration::HistoryFamily::kBoth;
  model.knot = model.deviation_knot = {0, 300e3, 600e3};
  model.correction = {2e3, 0, -4e3};
  model.radius = {10e3, 60e3, 200e3};
  model.play_weight = {-0.3, -0.1, -0.02};
  model.time_constant = {0.3, 5};
  model.memory_weight = {-0.05, 0.02};
  model.loading_deviation = model.unloading_deviation = {2e3, 3e3, 4e3};
  return model;
}

// |c|, the plays and the memories at most; a float's digits.
constexpr double kBound = 4e3 + (3e3 + 6e3 + 4e3) + 0.07 * 2 * kPressures + 1;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::Numbers numbers(bytes, size);
  fsr::calibration::HistoryState state(someModel(), 2);
  double time = 0;
  for (std::size_t i = 0; i < size / 4; ++i) {
    const auto what = numbers.next<std::uint8_t>();
    const auto value = numbers.next<std::int16_t>();
    if (what == 0) state.rest();
    if (what == 1) state.forget();
    if (what == 2) state.forget(1);
    time = what == 3 ? double(value) : what == 4 ? NAN : time + 0.01 * (what % 8);
    if (std::isnan(time)) time = 0;
    state.beginScan(what == 5 ? INFINITY : time);
    for (std::size_t taxel = 0; taxel < 2; ++taxel) {
      const double x = what == 6 ? double(NAN) : kPressures * value / 32768.0;
      float pressure = float(x), deviation = 1;
      const auto answer = state.correct(taxel, what == 7 + taxel, pressure, deviation);
      if (answer != fsr::calibration::HistoryAnswer::kNoReading) {
        const bool settled = answer == fsr::calibration::HistoryAnswer::kSettled;
        fuzz::require(std::abs(double(pressure) - x) <= kBound && deviation >= 2e3f &&
                      deviation <= (settled ? 8e3f : 40e3f));
      } else {
        fuzz::require(std::isnan(x) || (pressure == float(x) && deviation == 1));
      }
    }
  }
  return 0;
}
