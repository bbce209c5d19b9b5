#include "calibration/stages/deviation/budget_lines.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr const char* kName = "conditioning";
constexpr const char* kThen = "; ";  // between what is known of the conditioning and what was measured

// Contains no kThen.
std::string wordsOf(const std::vector<dataset::Conditioning>& sessions) {
  const auto number = static_cast<std::size_t>(
      std::count_if(sessions.begin(), sessions.end(), [](const auto& session) { return session.present(); }));
  if (number == 0) {
    const bool known = std::any_of(sessions.begin(), sessions.end(), [](const auto& s) { return s.known; });
    return known ? "sheet was not conditioned" : "not known whether the sheet was conditioned";
  }
  if (sessions.size() > 1) {
    return "conditioned before " + std::to_string(number) + " of " + std::to_string(sessions.size()) +
           " sessions";
  }
  const dataset::Conditioning& only = sessions.front();
  if (!only.enough)
    return "conditioned before the first recording, as the bags say: first loadings left out of the figure";
  return "conditioned: " + std::to_string(only.cycles) + " cycles to " +
         settings::fixedPressure(only.peak, 0) + " at the start of the bags";
}

}  // namespace

BudgetLine conditioningLine(const BudgetSums& sums, const std::vector<dataset::Conditioning>& sessions) {
  BudgetLine line;
  line.name = kName;
  line.note = wordsOf(sessions);
  std::string mean;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    const BudgetPoint& point = sums[p];
    if (point.firsts > 0) line.standard[p] = std::sqrt(std::max(0.0, point.first / point.firsts));
    mean += " " + settings::inShownUnit(point.first_change / point.firsts, 2);
  }
  if (std::all_of(line.standard.begin(), line.standard.end(),
                  [](double value) { return std::isnan(value); })) {
    line.note += std::string(kThen) + "no mount has three cycles that reach these pressures";
    return line;
  }
  line.source = BudgetSource::kMeasured;
  line.note += std::string(kThen) +
               "change from the first cycle of a mount to the later ones, root mean square; mean" + mean +
               ' ' + settings::shownUnitName();
  return line;
}

void restateConditioning(const std::vector<dataset::Conditioning>& sessions, ErrorBudget& budget) {
  for (BudgetLine& line : budget.lines) {
    if (line.name == kName) line.note = wordsOf(sessions) + line.note.substr(line.note.find(kThen));
  }
}

namespace {

constexpr std::size_t kSharesPerLine = kBudgetShares.size();
const double kNone = std::nan("");
const double kRectangular = std::sqrt(12.0);  // width of a uniform distribution by its standard deviation

// NaN stays NaN.
double notNegative(double value) {
  return value < 0 ? 0 : value;
}

double rootOf(double square) {
  return std::sqrt(notNegative(square));
}

// NaN where there is nothing to divide by.
double ratio(double sum, double number) {
  return number > 0 ? sum / number : kNone;
}

double orZero(double value) {
  return std::isnan(value) ? 0 : value;
}

bool anyKnown(const BudgetValues& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
}

template <typename Value>
BudgetValues atEach(Value value) {
  BudgetValues values;
  for (std::size_t p = 0; p < kSharesPerLine; ++p) values[p] = value(p);
  return values;
}

BudgetLine notAssessed(const std::string& name, const std::string& note) {
  BudgetLine line;
  line.name = name;
  line.note = note;
  return line;
}

// A line that the readings gave, or could have given.
BudgetLine measured(const std::string& name, BudgetPart part, const BudgetValues& standard,
                    const std::string& note, const std::string& missing) {
  if (!anyKnown(standard)) return notAssessed(name, missing);
  return {name, BudgetSource::kMeasured, part, standard, {}, note};
}

// Root mean square over the taxels of what `of` gives for the tables of a taxel; NaN there = no value.
template <typename Of>
double overTables(const Calibration& calibration, Of of) {
  double squares = 0, number = 0;
  const std::size_t classes = calibration.tables.classes.size();
  for (std::size_t taxel = 0; taxel < calibration.no_model.size(); ++taxel) {
    if (calibration.no_model[taxel] != 0) continue;
    for (std::size_t k = 0; k < classes; ++k) {
      const double value = of(taxel, k);
      if (std::isnan(value)) continue;
      squares += value * value;
      number += 1;
    }
  }
  return std::sqrt(ratio(squares, number));
}

class Lines {
 public:
  Lines(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options,
        const BudgetScale& scale, const BudgetSums& sums, const Calibration& calibration)
      : recordings_(recordings), options_(options), scale_(scale), sums_(sums), calibration_(calibration) {}

  std::vector<BudgetLine> all() const {
    return {reference(),
            resolution(),
            noise(),
            repeatability(),
            directions(),
            hold(),
            mount(),
            conditioningLine(sums_, dataset::findConditioning(recordings_)),
            rest(),
            temperature(),
            curvature(),
            newCurvature(),
            history(),
            notAssessed("another sheet", "the calibration is of one sheet"),
            notAssessed("age of the sheet", "drift and wear after training; check_calibration on new cycles"),
            notAssessed("in a socket", "shear, compliance, humidity")};
  }

 private:
  BudgetLine reference() const;
  BudgetLine resolution() const;
  BudgetLine noise() const;
  BudgetLine repeatability() const;
  BudgetLine directions() const;
  BudgetLine hold() const;
  BudgetLine mount() const;
  BudgetLine rest() const;
  BudgetLine temperature() const;
  BudgetLine curvature() const;
  BudgetLine newCurvature() const;
  BudgetLine history() const;

  double noiseVariance(std::size_t p) const { return ratio(sums_[p].noise, sums_[p].steps); }
  double repeatVariance(std::size_t p) const {
    const BudgetPoint& point = sums_[p];
    const double squares = point.repeat - point.repeat_noise * orZero(noiseVariance(p));
    return notNegative(ratio(squares, point.repeat_freedom));
  }
  double loopVariance(std::size_t p) const { return notNegative(ratio(sums_[p].loop, sums_[p].loops)); }
  double mountVariance(std::size_t p) const {
    return notNegative(ratio(sums_[p].mount, sums_[p].mount_freedom));
  }
  double mountShare(std::size_t p) const { return ratio(sums_[p].mount_shares, sums_[p].surfaces); }
  double slopeOfCurvature(std::size_t point) const;

  const std::vector<dataset::Recording>& recordings_;
  const CalibrationOptions& options_;
  const BudgetScale& scale_;
  const BudgetSums& sums_;
  const Calibration& calibration_;
};

BudgetLine Lines::reference() const {
  const std::string name = "transducer of the chamber";
  const double declared = options_.reference_deviation;
  if (std::isnan(declared)) {
    return notAssessed(name,
                       "its scatter is in the held-out error, its constant error in no reading; "
                       "train --transducer declares it");
  }
  const BudgetValues values = atEach([&](std::size_t) { return declared; });
  return {name,
          BudgetSource::kDeclared,
          BudgetPart::kAdded,
          values,
          values,
          "with its constant error; the part that scatters is in the held-out error as well"};
}

BudgetLine Lines::resolution() const {
  const BudgetValues values = atEach([&](std::size_t p) {
    return overTables(calibration_, [&](std::size_t taxel, std::size_t k) {
      const CodeSpan span(calibration_.tables.table(taxel, k), scale_, p);
      return span.step / kRectangular;
    });
  });
  return measured("resolution", BudgetPart::kHeldOut, values,
                  "step of one count / sqrt(12); part of the noise",
                  "no table rises through these pressures");
}

BudgetLine Lines::noise() const {
  const BudgetValues values = atEach([&](std::size_t p) { return rootOf(noiseVariance(p)); });
  return measured("noise of a reading", BudgetPart::kHeldOut, values, "from one reading to the next",
                  "too few readings near these pressures");
}

BudgetLine Lines::repeatability() const {
  const BudgetValues values = atEach([&](std::size_t p) { return rootOf(repeatVariance(p)); });
  return measured("repeatability", BudgetPart::kHeldOut, values,
                  "between cycles of one mount in one direction, beyond the noise",
                  "no surface has two cycles that reach these pressures");
}

BudgetLine Lines::directions() const {
  const BudgetValues values = atEach([&](std::size_t p) { return rootOf(loopVariance(p)); });
  return measured("loading and unloading", BudgetPart::kHeldOut, values, "half of their difference",
                  "the bags have no loading or no unloading");
}

BudgetLine Lines::hold() const {
  double dwells = 0, inside = 0;
  const BudgetValues values = atEach([&](std::size_t p) {
    dwells += sums_[p].dwells, inside += sums_[p].dwells_inside;
    return rootOf(ratio(sums_[p].dwell, sums_[p].dwell_freedom) -
                  ratio(sums_[p].dwell_noise, sums_[p].dwell_steps));
  });
  BudgetLine line = measured("holding a load", BudgetPart::kHeldOut, values,
                             "scatter of the counts within a dwell, beyond the noise",
                             "no dwell of 2 s or more near these pressures");
  if (inside < dwells) {
    line.part = BudgetPart::kPartly;
    line.note += "; added where the dwells are beside the pressure";
    line.added = atEach([&](std::size_t p) {
      const double share = ratio(sums_[p].dwells - sums_[p].dwells_inside, sums_[p].dwells);
      return orZero(values[p] * std::sqrt(share));
    });
  }
  return line;
}

// Of m mounts, the held-out error contains (m - 1) / m of the variance between mounts. A new mount differs
// from their mean by 1 + 1 / m of it. The difference, 2 / m, is added.
BudgetLine Lines::mount() const {
  const BudgetValues values = atEach([&](std::size_t p) { return rootOf(mountVariance(p)); });
  std::size_t mounts = 0, surfaces = 0;
  for (const dataset::ConditionCoverage& condition : calibration_.coverage.conditions) {
    mounts += condition.mounts.size() > 1 ? condition.mounts.size() : 0;
    surfaces += condition.mounts.size() > 1;
  }
  BudgetLine line = measured("mount", BudgetPart::kPartly, values,
                             "between " + std::to_string(mounts) + " mounts of " + std::to_string(surfaces) +
                                 (surfaces == 1 ? " surface" : " surfaces") +
                                 "; added: what another mount has beyond these",
                             "no surface was mounted more than once");
  if (line.source == BudgetSource::kMeasured) {
    line.added = atEach([&](std::size_t p) { return orZero(values[p] * std::sqrt(2 * mountShare(p))); });
  }
  return line;
}

BudgetLine Lines::rest() const {
  const BudgetValues values = atEach([&](std::size_t p) {
    const double named = orZero(noiseVariance(p)) + orZero(repeatVariance(p)) + orZero(loopVariance(p)) +
                         orZero(mountVariance(p) * (1 - mountShare(p)));
    return rootOf(ratio(sums_[p].held_out, sums_[p].cells) - named);
  });
  return measured("rest of the held-out error", BudgetPart::kHeldOut, values,
                  "curve of the model, holding a load, temperature, change over the session",
                  "no reading near these pressures");
}

BudgetLine Lines::temperature() const {
  const TemperatureModel& model = calibration_.temperature;
  const TrainedInterval& trained = calibration_.trained.temperature;
  if (model.present()) {
    const BudgetValues values = atEach(
        [&](std::size_t p) { return std::abs(model.sensitivity) * model.spread * scale_.pressure[p]; });
    return {"temperature of the sheet",
            BudgetSource::kMeasured,
            BudgetPart::kAside,
            values,
            {},
            "of training, corrected; added by the map while the temperature is not known"};
  }
  if (!trained.known()) return notAssessed("temperature of the sheet", "no thermometer in the bags");
  return notAssessed("temperature of the sheet",
                     "not separated; the held-out error contains that of training, " +
                         settings::fixedText(trained.low, 1) + " to " + settings::fixedText(trained.high, 1) +
                         " degrees Celsius");
}

// Root mean square of the change of the answer with the curvature, between the neighbours of each class
// [Pa m].
double Lines::slopeOfCurvature(std::size_t point) const {
  const compensation::CurvatureTables& tables = calibration_.tables;
  return overTables(calibration_, [&](std::size_t taxel, std::size_t k) {
    const std::size_t below = k == 0 ? 0 : k - 1, above = std::min(k + 1, tables.classes.size() - 1);
    const CodeSpan span(tables.table(taxel, k), scale_, point);
    const double distance = tables.classes[above].at(taxel) - tables.classes[below].at(taxel);
    if (std::isnan(span.step) || !(distance > 0)) return kNone;
    const std::size_t code = span.middle;
    const double rise =
        double(tables.table(taxel, above).pressure[code]) - double(tables.table(taxel, below).pressure[code]);
    return rise / distance;
  });
}

BudgetLine Lines::curvature() const {
  const std::string name = "curvature of the surface";
  const BudgetValues slope = atEach([&](std::size_t p) { return slopeOfCurvature(p); });
  if (!anyKnown(slope)) return notAssessed(name, "one table answers for all curvatures");
  std::string change = "1 1/m changes the answer by";
  for (const double value : slope) change += " " + settings::inShownUnit(value, 2);
  change += ' ' + settings::shownUnitName();
  double squares = 0, number = 0;
  bool each = true;
  for (const dataset::Recording& recording : recordings_) {
    for (const matrix::Surface& surface : recording.conditions) {
      each = each && !surface.deviation.empty();
      for (std::size_t taxel = 0; taxel < recording.layout.size.taxels(); ++taxel) {
        const double deviation = surface.deviationAt({taxel});
        squares += deviation * deviation;
        number += 1;
      }
    }
  }
  if (!each) return notAssessed(name, "the bags state no deviation of the curvature; " + change);
  const double deviation = std::sqrt(ratio(squares, number));
  const BudgetValues values = atEach([&](std::size_t p) { return slope[p] * deviation; });
  return {name,
          BudgetSource::kSession,
          BudgetPart::kAdded,
          values,
          atEach([&](std::size_t p) { return orZero(values[p]); }),
          "deviation of " + settings::roundedText(deviation, 3) + " 1/m; " + change};
}

BudgetLine Lines::newCurvature() const {
  const compensation::UnseenDeviation& unseen = calibration_.tables.rule.unseen;
  const BudgetValues values =
      atEach([&](std::size_t p) { return unseen.pressure.empty() ? kNone : unseen.at(scale_.pressure[p]); });
  return measured("between trained curvatures", BudgetPart::kAside, values,
                  "midway between two surfaces; the map adds it there",
                  "training has no surface between two others");
}

BudgetLine Lines::history() const {
  const HistoryModel& model = calibration_.history;
  const auto at = [&](const std::vector<double>& deviation, double pressure) {
    const compensation::UnseenDeviation course{model.deviation_knot, deviation};
    return course.at(pressure);
  };
  const BudgetValues values = atEach([&](std::size_t p) {
    if (!model.present() || model.deviation_knot.empty()) return kNone;
    const double up = at(model.loading_deviation, scale_.pressure[p]);
    const double down = at(model.unloading_deviation, scale_.pressure[p]);
    return std::sqrt((up * up + down * down) / 2);
  });
  return measured("with the history model", BudgetPart::kAside, values,
                  "of protocols that were left out; replaces the held-out error once settled",
                  "no history model");
}

}  // namespace

ErrorBudget errorBudget(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options,
                        const BudgetScale& scale, const BudgetSums& sums, const Calibration& calibration) {
  ErrorBudget budget;
  budget.pressure = scale.pressure;
  budget.held_out = atEach([&](std::size_t p) { return std::sqrt(ratio(sums[p].held_out, sums[p].cells)); });
  budget.lines = Lines(recordings, options, scale, sums, calibration).all();
  budget.combined = atEach([&](std::size_t p) {
    double square = budget.held_out[p] * budget.held_out[p];
    for (const BudgetLine& line : budget.lines) square += line.added[p] * line.added[p];
    return std::sqrt(square);
  });
  return budget;
}

std::string budgetSourceName(BudgetSource source) {
  return source == BudgetSource::kMeasured   ? "measured here"
         : source == BudgetSource::kSession  ? "from the session"
         : source == BudgetSource::kDeclared ? "declared"
                                             : "not assessed";
}

std::string budgetPartName(BudgetPart part) {
  return part == BudgetPart::kHeldOut  ? "inside"
         : part == BudgetPart::kPartly ? "partly"
         : part == BudgetPart::kAdded  ? "added"
                                       : "aside";
}

}  // namespace fsr::calibration
