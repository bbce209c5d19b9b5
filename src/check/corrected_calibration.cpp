#include <algorithm>
#include <cmath>
#include <memory>

#include "check/correction.h"
#include "compensation/training_statistics.h"

namespace fsr::check {

namespace {

std::uint16_t movedCode(std::uint16_t code, const ReadingChange& change, std::uint16_t full_scale) {
  const double moved = std::round(change.offset + change.gain * code);
  return static_cast<std::uint16_t>(std::min(std::max(moved, 0.0), double(full_scale)));
}

void move(const ReadingChange& change, std::uint16_t full_scale, double larger,
          regression::CodeTable& table) {
  const auto column = [&](std::vector<float>& values, double factor) {
    if (values.size() < 2) return;
    const std::vector<float> before = values;
    for (std::size_t code = 0; code < values.size(); ++code)
      values[code] = static_cast<float>(factor * AnswerTable::at(before, change.before(double(code))));
  };
  column(table.pressure, 1);
  column(table.deviation, larger);
  column(table.support, 1);
  // The logarithm of no weight at all is infinite, so there is nothing between two codes.
  const std::vector<float> weights = table.log_weight;
  for (std::size_t code = 0; code < weights.size(); ++code) {
    const double before = std::round(change.before(double(code)));
    table.log_weight[code] =
        weights[static_cast<std::size_t>(std::min(std::max(before, 0.0), double(full_scale)))];
  }
  table.lowest = movedCode(table.lowest, change, full_scale);
  table.highest = movedCode(table.highest, change, full_scale);
}

// The readings at rest on each surface move with the tables.
void moveShape(const std::vector<ReadingChange>& changes, calibration::ShapeModel& shape) {
  if (!shape.present()) return;
  const std::size_t taxels = changes.size();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const ReadingChange& change = changes[taxel];
    shape.scale[taxel] /= change.gain;
    const double shift = shape.scale[taxel] * change.offset / double(shape.full_scale);
    for (std::size_t surface = 0; surface < shape.surfaces.size(); ++surface)
      shape.rest[surface * taxels + taxel] += shift;
  }
}

std::shared_ptr<const compensation::TrainingStatistics> withoutSums(const calibration::Calibration& parent) {
  compensation::TrainingStatistics statistics;
  statistics.full_scale = parent.tables.full_scale;
  statistics.taxels = parent.layout.size.taxels();
  for (const auto& coverage : parent.coverage.conditions) statistics.classes.push_back(coverage.condition);
  return std::make_shared<const compensation::TrainingStatistics>(std::move(statistics));
}

}  // namespace

calibration::Calibration movedCalibration(const calibration::Calibration& parent,
                                          const std::vector<ReadingChange>& changes, double larger) {
  calibration::Calibration child = parent;
  child.id.clear();
  const std::size_t classes = child.tables.classes.size();
  for (std::size_t i = 0; i < child.tables.tables.size(); ++i)
    move(changes[i / classes], child.tables.full_scale, larger, child.tables.tables[i]);
  moveShape(changes, child.shape);
  child.statistics = withoutSums(parent);
  return child;
}

}  // namespace fsr::check
