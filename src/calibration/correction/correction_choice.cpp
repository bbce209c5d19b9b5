#include "calibration/correction/correction_choice.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/paired_tests.h"

namespace fsr::calibration {

namespace {

constexpr ChangeModel kModels[kChangeModels] = {ChangeModel::kNone, ChangeModel::kSheet,
                                                ChangeModel::kTaxels};

using Cycles = CorrectionFit::Cycles;
using Held = std::array<std::vector<SquaredErrors>, kChangeModels>;  // of each cycle that was left out

void add(const SquaredErrors& more, SquaredErrors& sum) {
  sum.sum += more.sum;
  sum.expected += more.expected;
  sum.readings += more.readings;
}

SquaredErrors total(const std::vector<SquaredErrors>& errors) {
  SquaredErrors sum;
  for (const SquaredErrors& one : errors) add(one, sum);
  return sum;
}

Held leaveEachOut(const CorrectionFit& fit, const Cycles& cycles) {
  Held held;
  for (std::size_t out = 0; out < cycles.size(); ++out) {
    if (!cycles[out]) continue;
    Cycles rest = cycles;
    rest[out] = false;
    for (std::size_t m = 0; m < kChangeModels; ++m)
      held[m].push_back(fit.errors(fit.fit(kModels[m], rest), out));
  }
  return held;
}

std::size_t best(const Held& held, ChangeModel richest) {
  std::size_t best = 0;
  for (std::size_t m = 1; m <= static_cast<std::size_t>(richest); ++m) {
    if (total(held[m]).sum < total(held[best]).sum) best = m;
  }
  return best;
}

double oneSidedP(const std::vector<SquaredErrors>& none, const std::vector<SquaredErrors>& choice) {
  std::vector<double> before, after;
  for (std::size_t i = 0; i < none.size(); ++i) {
    if (none[i].readings == 0 || !(none[i].sum > 0) || !(choice[i].sum > 0)) continue;
    before.push_back(std::log(none[i].mean()));
    after.push_back(std::log(choice[i].mean()));
  }
  if (before.size() < kLeastCycles) return 1;
  try {
    const statistics::PairedT test = statistics::pairedT(before, after);
    return test.mean_difference > 0 ? test.test.p / 2 : 1 - test.test.p / 2;
  } catch (const settings::InputError&) {
    return before.front() > after.front() ? 0 : 1;  // all cycles gain or lose exactly the same
  }
}

}  // namespace

CorrectionChoice chooseCorrection(const CorrectionFit& fit, ChangeModel richest) {
  const Cycles all(fit.readings().cycles(), true);
  const Held held = leaveEachOut(fit, all);
  CorrectionChoice choice;
  for (std::size_t m = 0; m < kChangeModels; ++m) choice.rmse[m] = std::sqrt(total(held[m]).mean());
  const SquaredErrors none = total(held[0]);
  choice.expected = std::sqrt(none.expected / double(none.readings));
  choice.model = kModels[best(held, richest)];
  choice.changes = fit.fit(choice.model, all);
  std::vector<SquaredErrors> nested;
  for (std::size_t out = 0; out < all.size(); ++out) {
    Cycles rest = all;
    rest[out] = false;
    nested.push_back(held[best(leaveEachOut(fit, rest), richest)][out]);
  }
  choice.nested = std::sqrt(total(nested).mean());
  choice.p = oneSidedP(held[0], nested);
  return choice;
}

}  // namespace fsr::calibration
