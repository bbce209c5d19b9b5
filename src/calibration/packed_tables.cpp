#include "calibration/packed_tables.h"

#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

void requireWhole(const compensation::CurvatureTables& tables) {
  const std::size_t expected = tables.size.taxels() * tables.classes.size();
  if (expected == 0 || tables.tables.size() != expected) {
    throw settings::InputError("calibration has " + std::to_string(tables.tables.size()) +
                               " tables, but must have one for each taxel and curvature class, " +
                               std::to_string(expected));
  }
}

// Larger than the pressure of any sensor, and far from an overflow of sums and differences of floats [Pa].
constexpr float kBeyondAnyPressure = 1e12f;

bool usable(float value) {
  return std::abs(value) < kBeyondAnyPressure;
}

// Throws unless the table has one usable value for each code or, without a model, NaN throughout.
void requireSound(const regression::CodeTable& table, std::size_t codes, std::size_t number) {
  const std::string which = "calibration: table " + std::to_string(number);
  if (table.pressure.size() != codes || table.deviation.size() != codes ||
      (!table.log_weight.empty() && table.log_weight.size() != codes)) {
    throw settings::InputError(which + " has " + std::to_string(table.pressure.size()) +
                               " codes, but must have full scale + 1, " + std::to_string(codes));
  }
  const bool model = !std::isnan(table.pressure.front());
  for (std::size_t code = 0; code < codes; ++code) {
    const bool finite = usable(table.pressure[code]) && usable(table.deviation[code]);
    const bool absent = std::isnan(table.pressure[code]) && std::isnan(table.deviation[code]);
    if (model ? !finite : !absent) {
      throw settings::InputError(which + " is not finite at code " + std::to_string(code) +
                                 ", but must be in Pa");
    }
  }
}

// The index of the table of each class, numbered in the order of the classes.
std::vector<std::size_t> slotsOf(const compensation::CurvatureTables& tables) {
  const std::vector<std::size_t>& model = tables.rule.model_of_class;
  if (!model.empty() && model.size() != tables.classes.size()) {
    throw settings::InputError("calibration has " + std::to_string(model.size()) +
                               " model numbers, but must have none, or one for each curvature class");
  }
  std::vector<std::size_t> slots;
  std::size_t used = 0;
  for (std::size_t k = 0; k < tables.classes.size(); ++k) {
    const auto twin =
        model.empty() ? model.end()
                      : std::find(model.begin(), model.begin() + static_cast<std::ptrdiff_t>(k), model[k]);
    const bool shared = !model.empty() && twin != model.begin() + static_cast<std::ptrdiff_t>(k);
    slots.push_back(shared ? slots[static_cast<std::size_t>(twin - model.begin())] : used++);
  }
  return slots;
}

}  // namespace

PackedTables::PackedTables(const compensation::CurvatureTables& tables, const DeviationScale& scale)
    : size_(tables.size), full_scale_(tables.full_scale), classes_(tables.classes.size()) {
  requireWhole(tables);
  slot_of_class_ = slotsOf(tables);
  slots_ = 1 + *std::max_element(slot_of_class_.begin(), slot_of_class_.end());
  const bool kernels = tables.rule.blend == compensation::BlendRule::kKernel;
  while ((std::size_t{full_scale_} >> shift_) >= kMostCodes) ++shift_;
  entries_.resize(size_.taxels() * stride());
  if (kernels) log_weight_.resize(size_.taxels() * classes_ * entries());
  for (std::size_t taxel = 0; taxel < size_.taxels(); ++taxel) {
    compensation::TaxelTables& own = of_taxel_.emplace_back();
    own.codes = entries();
    for (std::size_t k = 0; k < classes_; ++k) {
      const regression::CodeTable& packed = tables.table(taxel, k);
      requireSound(packed, full_scale_ + 1u, number(taxel, k));
      compensation::TableEntry* entry = entries_.data() + taxel * stride() + slot_of_class_[k] * entries();
      own.curvature.push_back(tables.classes[k].at(taxel));
      own.table.push_back(entry);
      own.highest.push_back(packed.highest >> shift_);
      for (std::size_t i = 0; i < entries(); ++i) {
        entry[i] = {packed.pressure[codeOf(i)], packed.deviation[codeOf(i)]};
      }
      if (scale.present()) {
        for (std::size_t i = 0; i < entries(); ++i)
          entry[i].deviation *= static_cast<float>(scale.at(double(entry[i].pressure)));
      }
      if (shift_ != 0) endAtFullScale(entry);
      trained_.push_back({packed.lowest, packed.highest, !std::isnan(packed.pressure.front())});
      if (kernels) own.log_weight.push_back(packLogWeight(packed, number(taxel, k)));
    }
  }
}

void PackedTables::endAtFullScale(compensation::TableEntry* table) const {
  const compensation::TableEntry& before = table[entries() - 2];
  compensation::TableEntry& last = table[entries() - 1];
  const std::size_t step = std::size_t{1} << shift_, left = full_scale_ & (step - 1);
  if (left == 0) return;  // the last entry is not used
  last.pressure = before.pressure +
                  (last.pressure - before.pressure) * static_cast<float>(step) / static_cast<float>(left);
}

const float* PackedTables::packLogWeight(const regression::CodeTable& table, std::size_t number) {
  if (table.log_weight.empty()) {
    throw settings::InputError("calibration: table " + std::to_string(number) +
                               " has no weights, but its scheme blends tables by weight");
  }
  float* const begin = log_weight_.data() + number * entries();
  for (std::size_t i = 0; i < entries(); ++i) begin[i] = table.log_weight[codeOf(i)];
  return begin;
}

ClassSwitch::ClassSwitch(const compensation::CurvatureTables& tables, double hysteresis)
    : classes_(tables.classes),
      low_(tables.curvature_low),
      high_(tables.curvature_high),
      tolerance_(tables.class_tolerance),
      hysteresis_(hysteresis),
      by_name_(tables.rule.blend == compensation::BlendRule::kByName),
      choices_(tables.size.taxels()) {
  fallBack();
}

void ClassSwitch::choose(const matrix::Surface& surface) {
  if (by_name_ && chooseByName(surface.name)) return;
  const bool same = last_.known() && last_.name == surface.name && last_.mount == surface.mount;
  for (std::size_t taxel = 0; taxel < choices_.size(); ++taxel) {
    const double curvature = matrix::principalCurvature(surface.at({taxel}));
    const std::size_t chosen = same ? keepOrLeave(taxel, curvature) : nearest(taxel, curvature);
    choices_[taxel] = {chosen, flags(taxel, chosen, curvature)};
    if (by_name_ && choices_[taxel].flags == 0) choices_[taxel].flags = map::taxel_flag::kBetweenClasses;
  }
  last_ = {surface.name, surface.mount, {matrix::Curvature{}}, {}};
}

bool ClassSwitch::chooseByName(const std::string& name) {
  const auto found = std::find_if(classes_.begin(), classes_.end(),
                                  [&](const dataset::CurvatureClass& one) { return one.surface == name; });
  if (found == classes_.end()) return false;
  choices_.assign(choices_.size(), {static_cast<std::size_t>(found - classes_.begin()), 0});
  last_ = {};
  return true;
}

void ClassSwitch::fallBack() {
  for (std::size_t taxel = 0; taxel < choices_.size(); ++taxel) choices_[taxel] = {nearest(taxel, 0.0), 0};
  last_ = {};
}

std::size_t ClassSwitch::nearest(std::size_t taxel, double curvature) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < classes_.size(); ++k) {
    if (distance(taxel, k, curvature) < distance(taxel, best, curvature)) best = k;
  }
  return best;
}

std::size_t ClassSwitch::keepOrLeave(std::size_t taxel, double curvature) const {
  const std::size_t now = choices_[taxel].curvature_class;
  const std::size_t best = nearest(taxel, curvature);
  const double gain = distance(taxel, now, curvature) - distance(taxel, best, curvature);
  return gain > hysteresis_ ? best : now;
}

double ClassSwitch::distance(std::size_t taxel, std::size_t curvature_class, double curvature) const {
  return std::abs(curvature - classes_[curvature_class].at(taxel));
}

// A curvature outside the range, but within the tolerance, counts as seen in training.
std::uint16_t ClassSwitch::flags(std::size_t taxel, std::size_t curvature_class, double curvature) const {
  if (curvature < low_ - tolerance_ || curvature > high_ + tolerance_) {
    return map::taxel_flag::kCurvatureExtrapolated;
  }
  const bool between = classes_.size() > 1 && distance(taxel, curvature_class, curvature) > tolerance_;
  return between ? map::taxel_flag::kBetweenClasses : std::uint16_t{0};
}

}  // namespace fsr::calibration
