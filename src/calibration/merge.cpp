#include "calibration/merge.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include "calibration/sources.h"
#include "calibration/stages/tables/taxel_training.h"
#include "compensation/training_statistics.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "regression/regressors.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr char kInstead[] = "; train on all bags instead";

// Options in RegressorOptions::more.
std::string optionsText(const regression::RegressorOptions& options) {
  std::ostringstream text;
  for (const auto& [name, value] : options.more)
    text << (text.tellp() > 0 ? ", " : "") << name << " = " << value;
  return text.str().empty() ? "none" : text.str();
}

std::string bandwidthText(const Calibration& calibration) {
  return calibration.bandwidth_chosen ? "auto" : settings::roundedText(calibration.regressor.grnn.bandwidth);
}

// Properties that must be equal in all parts: name and value.
std::vector<std::pair<std::string, std::string>> traitsOf(const Calibration& calibration) {
  const regression::RegressorOptions& model = calibration.regressor;
  const bool grnn = model.name == "grnn";
  return {{"the matrix", matrix::sizeText(calibration.layout.size)},
          {"full_scale", std::to_string(calibration.tables.full_scale)},
          {"the scheme", compensation::schemeName(calibration.tables.scheme)},
          {"the model", model.name},
          {"the bandwidth", grnn ? bandwidthText(calibration) : ""},
          {"the spread's meaning", grnn ? regression::spreadName(model.grnn.spread) : ""},
          {"the distance", grnn ? regression::distanceName(model.grnn.distance) : ""},
          {"the list of further options", optionsText(model)},
          {"the number of sections", std::to_string(calibration.folds)}};
}

void requireAlike(const MergePart& first, const MergePart& other) {
  const auto refuse = [&](const std::string& what, const std::string& own, const std::string& that) {
    throw settings::InputError(other.name + ": " + what + " is " + own + ", but that of " + first.name +
                               " is " + that + "; only calibrations that were trained alike can be merged");
  };
  const auto wanted = traitsOf(first.calibration), found = traitsOf(other.calibration);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (found[i].second != wanted[i].second) refuse(found[i].first, found[i].second, wanted[i].second);
  }
  const std::string &serial = first.calibration.sensor.serial, &own = other.calibration.sensor.serial;
  if (!serial.empty() && !own.empty() && own != serial) {
    refuse("the serial number", '"' + own + '"', '"' + serial + '"');
  }
}

void requireOtherBags(const MergePart& earlier, const MergePart& later) {
  for (const SourceBag& bag : later.calibration.provenance.bags) {
    for (const SourceBag& twin : earlier.calibration.provenance.bags) {
      if (bag.sha256.empty() || bag.sha256 != twin.sha256) continue;
      throw settings::InputError(later.name + ": was trained on " + bag.name + ", as was " + earlier.name +
                                 "; each bag may count once");
    }
  }
}

void requireMergeable(const MergePart& part) {
  const Calibration& calibration = part.calibration;
  if (!calibration.statistics || calibration.statistics->cells.empty()) {
    throw settings::InputError(part.name + ": holds no statistics to merge" + kInstead);
  }
  if (calibration.history.present()) {
    throw settings::InputError(part.name +
                               ": has a model of the sheet's memory, whose sums depend on the tables and "
                               "change with them" +
                               kInstead + ", or merge calibrations of --history none");
  }
  if (calibration.session_zero.tare == SessionTare::kTrained) {
    throw settings::InputError(part.name +
                               ": was trained with the zero of each session, which its sums contain" +
                               kInstead + ", or merge calibrations of --zero none");
  }
  if (calibration.temperature.present()) {
    throw settings::InputError(part.name +
                               ": has a model of the temperature, and its sums are those of its T_0" +
                               kInstead + ", or merge calibrations of --temperature none");
  }
  if (regression::makeRegressor(calibration.regressor)->mergeable()) return;
  const bool grnn = calibration.regressor.name == "grnn";
  throw settings::InputError(part.name + ": the model " + calibration.regressor.name +
                             (grnn ? " with equal pressure bins" : "") +
                             " needs the bags; the sums in a calibration file are not sufficient" + kInstead);
}

// Files of the first version do not contain the conditions; their classes are used instead.
std::vector<dataset::RecordedCondition> conditionsOf(const Calibration& calibration) {
  if (!calibration.statistics->conditions.empty()) return calibration.statistics->conditions;
  std::vector<dataset::RecordedCondition> conditions;
  for (const dataset::ConditionCoverage& coverage : calibration.coverage.conditions) {
    conditions.push_back({coverage.condition, coverage.scans});
  }
  return conditions;
}

std::vector<std::uint8_t> masked(const Calibration& calibration) {
  return calibration.masked.empty() ? calibration.no_model : calibration.masked;
}

class Merging {
 public:
  explicit Merging(const std::vector<MergePart>& parts)
      : parts_(parts), pooling_(compensation::poolingOf(parts.front().calibration.tables.scheme)) {
    for (const MergePart& part : parts) {
      const auto own = conditionsOf(part.calibration);
      conditions_.insert(conditions_.end(), own.begin(), own.end());
    }
    pooled_ = dataset::poolConditions(conditions_, pooling_);
    std::size_t first = 0;
    for (const MergePart& part : parts) {
      classes_.push_back(classesOf(part, first));
      first += conditionsOf(part.calibration).size();
    }
  }

  Calibration run(const MergeOptions& options);

 private:
  // The class of the merged calibration for each class of a part; `first` = index of the first condition of
  // the part.
  std::vector<std::size_t> classesOf(const MergePart& part, std::size_t first) const;
  void mergeFacts(const Calibration& part, Calibration& whole) const;
  compensation::TrainingStatistics mergeStatistics() const;

  const std::vector<MergePart>& parts_;
  dataset::PooledBy pooling_;
  std::vector<dataset::RecordedCondition> conditions_;
  dataset::PooledConditions pooled_;
  std::vector<std::vector<std::size_t>> classes_;  // [parts][classes of the part]
};

std::vector<std::size_t> Merging::classesOf(const MergePart& part, std::size_t first) const {
  const auto own = conditionsOf(part.calibration);
  const dataset::PooledConditions alone = dataset::poolConditions(own, pooling_);
  const auto& classes = part.calibration.statistics->classes;
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> becomes(classes.size(), kNone);
  bool same = alone.classes.size() == classes.size();
  for (std::size_t i = 0; same && i < own.size(); ++i) {
    std::size_t& whole = becomes[alone.class_of[i]];
    const std::size_t now = pooled_.class_of[first + i];
    same = whole == kNone || whole == now;
    whole = now;
  }
  for (std::size_t k = 0; same && k < classes.size(); ++k) {
    same = dataset::isFlat(classes[k]) == dataset::isFlat(pooled_.classes[becomes[k]]);
  }
  if (same) return becomes;
  throw settings::InputError(
      part.name + ": its curvatures would form other classes together with those of the others" + kInstead);
}

void Merging::mergeFacts(const Calibration& part, Calibration& whole) const {
  const auto fill = [](std::string& field, const std::string& value) {
    if (field.empty()) field = value;
  };
  fill(whole.sensor.sensor_id, part.sensor.sensor_id);
  fill(whole.sensor.serial, part.sensor.serial);
  fill(whole.sensor.firmware, part.sensor.firmware);
  fill(whole.sensor.model, part.sensor.model);
  fill(whole.sensor.sealing, part.sensor.sealing);
  fill(whole.sensor.transducer, part.sensor.transducer);
  const std::vector<std::uint8_t> mask = masked(part);
  for (std::size_t taxel = 0; taxel < mask.size(); ++taxel) whole.masked[taxel] |= mask[taxel];
  const auto include = [](const TrainedInterval& from, TrainedInterval& to) {
    to.include(from.low);
    to.include(from.high);
  };
  include(part.trained.pressure, whole.trained.pressure);
  include(part.trained.pressure_rate, whole.trained.pressure_rate);
  include(part.trained.temperature, whole.trained.temperature);
  const auto& bags = part.provenance.bags;
  whole.provenance.bags.insert(whole.provenance.bags.end(), bags.begin(), bags.end());
  for (const std::string& sentence : part.provenance.conditioning) {
    std::vector<std::string>& all = whole.provenance.conditioning;
    if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
  }
  std::remove_copy_if(part.warnings.begin(), part.warnings.end(), std::back_inserter(whole.warnings),
                      isConstantTaxelWarning);
}

compensation::TrainingStatistics Merging::mergeStatistics() const {
  const compensation::TrainingStatistics& first = *parts_.front().calibration.statistics;
  const std::size_t taxels = first.taxels, sections = first.sections, classes = pooled_.classes.size();
  compensation::TrainingStatistics whole{first.full_scale,
                                         taxels,
                                         sections,
                                         pooled_.classes,
                                         std::vector<regression::CodeStatistics>(taxels * classes * sections),
                                         conditions_};
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const compensation::TrainingStatistics& part = *parts_[p].calibration.statistics;
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      for (std::size_t k = 0; k < part.classes.size(); ++k) {
        for (std::size_t s = 0; s < sections; ++s) {
          whole.cells[(taxel * classes + classes_[p][k]) * sections + s].merge(part.cell(taxel, k, s));
        }
      }
    }
  }
  return whole;
}

Calibration Merging::run(const MergeOptions& options) {
  const Calibration& first = parts_.front().calibration;
  const CalibrationOptions training{first.tables.scheme, first.regressor, first.bandwidth_chosen,
                                    first.folds,         false,           first.provenance.seed,
                                    options.threads,     options.date};
  Calibration whole;
  whole.bandwidth_chosen = first.bandwidth_chosen;
  whole.folds = first.folds;
  whole.layout = first.layout;
  whole.masked.assign(first.layout.size.taxels(), 0);
  whole.provenance = provenanceOf({}, training);
  for (const dataset::CurvatureClass& curvature_class : pooled_.classes) {
    whole.coverage.conditions.emplace_back();
    whole.coverage.conditions.back().condition = curvature_class;
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Calibration& part = parts_[p].calibration;
    mergeFacts(part, whole);
    for (std::size_t k = 0; k < classes_[p].size(); ++k) {
      dataset::addCoverage(part.coverage.conditions[k], whole.coverage.conditions[classes_[p][k]]);
    }
  }
  whole.coverage.thin = dataset::thinPlaces(whole.coverage.conditions, whole.folds);
  whole.statistics = std::make_shared<const compensation::TrainingStatistics>(mergeStatistics());
  whole.shape.missing =
      "a merged calibration has no model of the shape, because that needs the bags; train on all of them";
  trainOnStatistics(training, parts_.front().name, whole);
  return whole;
}

}  // namespace

Calibration mergeCalibrations(const std::vector<MergePart>& parts, const MergeOptions& options) {
  if (parts.size() < 2) throw settings::InputError("merging needs two calibration files or more");
  for (const MergePart& part : parts) requireMergeable(part);
  for (auto later = parts.begin() + 1; later != parts.end(); ++later) {
    requireAlike(parts.front(), *later);
    for (auto earlier = parts.begin(); earlier != later; ++earlier) requireOtherBags(*earlier, *later);
  }
  return Merging(parts).run(options);
}

}  // namespace fsr::calibration
