#include "compensation/fit_scheme.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "compensation/blend_table.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::compensation {

namespace {

std::vector<double> columnsOf(Scheme scheme, std::size_t curvature_class,
                              const std::vector<double>& curvature, const std::vector<bool>& bent) {
  if (scheme == Scheme::kCurvatureInput || scheme == Scheme::kScaledCurvature) {
    return {curvature[curvature_class]};
  }
  if (scheme == Scheme::kBinaryInput) return {bent[curvature_class] ? 1.0 : 0.0};
  std::vector<double> one_hot(curvature.size(), 0.0);
  one_hot[curvature_class] = 1.0;
  return one_hot;
}

// 1 / sample standard deviation of a column; 0 for a constant column.
double scaleOf(const std::vector<std::vector<double>>& columns, std::size_t column,
               const std::vector<std::uint64_t>& readings) {
  double number = 0, mean = 0, squares = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    number += static_cast<double>(readings[k]);
    mean += static_cast<double>(readings[k]) * columns[k][column];
  }
  mean /= number;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double from_mean = columns[k][column] - mean;
    squares += static_cast<double>(readings[k]) * from_mean * from_mean;
  }
  const double deviation = std::sqrt(squares / (number - 1));
  constexpr double kRounding = 1e-12;  // relative difference between equal values and their mean
  return deviation > kRounding * (1.0 + std::abs(mean)) ? 1.0 / deviation : 0.0;
}

}  // namespace

regression::ClassInputs classInputs(Scheme scheme, const std::vector<double>& curvature,
                                    const std::vector<bool>& bent,
                                    const std::vector<std::uint64_t>& readings) {
  regression::ClassInputs inputs;
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    inputs.columns.push_back(columnsOf(scheme, k, curvature, bent));
  }
  for (std::size_t i = 0; i < inputs.columns.front().size(); ++i) {
    inputs.scale.push_back(scaleOf(inputs.columns, i, readings));
  }
  return inputs;
}

namespace {

regression::Fit fitClasses(const std::vector<std::size_t>& trained_on,
                           const regression::ClassReadings& readings,
                           const regression::Regressor& regressor) {
  if (regressor.mergeable()) {
    if (trained_on.size() == 1) {
      const regression::CodeHistogram& only = readings.sums[trained_on.front()];
      return only.samples() > 0 ? regressor.fit(only) : regression::Fit{};
    }
    regression::CodeHistogram pooled(readings.full_scale);
    for (const std::size_t k : trained_on) pooled.add(readings.sums[k]);
    return pooled.samples() > 0 ? regressor.fit(pooled) : regression::Fit{};
  }
  regression::CodeSamples pooled;
  pooled.full_scale = readings.full_scale;
  for (const std::size_t k : trained_on) pooled.append(readings.samples[k]);
  return pooled.size() > 0 ? regressor.fitSamples(pooled) : regression::Fit{};
}

// Whether a regressor with this second input can be combined with the scheme.
bool canTake(Scheme scheme, const std::optional<regression::SecondInput>& input) {
  if (!input) return false;
  if (scheme == Scheme::kOneHot) return input->several_columns;
  if (scheme == Scheme::kScaledCurvature) return input->between == regression::BetweenInputs::kKernel;
  return true;
}

std::string inputText(Scheme scheme) {
  if (scheme == Scheme::kOneHot) return "a second input of several columns";
  if (scheme == Scheme::kScaledCurvature) return "a second input with a length scale of its own";
  return "a second input";
}

BlendRule blendOf(const regression::RegressorEntry& entry) {
  if (!entry.second_input) return BlendRule::kNearest;
  switch (entry.second_input->between) {
    case regression::BetweenInputs::kKernel:
      return BlendRule::kKernel;
    case regression::BetweenInputs::kStraight:
      return BlendRule::kInterpolate;
    case regression::BetweenInputs::kSteps:
      break;
  }
  return BlendRule::kNearest;
}

std::string namesThatTake(Scheme scheme, const regression::RegressorTable& table) {
  std::string names;
  for (const regression::RegressorEntry& entry : table.entries) {
    if (canTake(scheme, entry.second_input)) names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return names.empty() ? "none" : names;
}

// Readings of all sections but `left_out`.
class Without {
 public:
  Without(const SectionedReadings& readings, bool by_samples)
      : readings_(readings),
        by_samples_(by_samples),
        all_(by_samples ? regression::ClassReadings{} : allSections(readings)) {}

  template <typename Use>
  void operator()(std::size_t left_out, Use use) {
    if (by_samples_) {
      use(samplesWithout(left_out));
      return;
    }
    const bool any = left_out < readings_.sums.front().size();
    for (std::size_t k = 0; any && k < all_.sums.size(); ++k)
      all_.sums[k].subtract(readings_.sums[k][left_out]);
    use(all_);
    for (std::size_t k = 0; any && k < all_.sums.size(); ++k) all_.sums[k].add(readings_.sums[k][left_out]);
  }

 private:
  regression::ClassReadings samplesWithout(std::size_t left_out) const {
    regression::ClassReadings rest;
    rest.full_scale = readings_.full_scale;
    for (const std::vector<regression::CodeSamples>& sections : readings_.samples) {
      rest.samples.emplace_back();
      rest.samples.back().full_scale = readings_.full_scale;
      for (std::size_t s = 0; s < sections.size(); ++s) {
        if (s != left_out) rest.samples.back().append(sections[s]);
      }
    }
    return rest;
  }

  const SectionedReadings& readings_;
  bool by_samples_;
  regression::ClassReadings all_;
};

// The readings that a model is tested on, by section.
std::vector<regression::CodeStatistics> testedSections(const std::vector<std::size_t>& classes,
                                                       const SectionedReadings& readings) {
  std::vector<regression::CodeStatistics> sections(readings.sums.front().size());
  for (const std::size_t k : classes) {
    for (std::size_t s = 0; s < sections.size(); ++s) sections[s].merge(readings.sums[k][s]);
  }
  return sections;
}

}  // namespace

regression::ClassReadings allSections(const SectionedReadings& readings) {
  regression::ClassReadings all;
  all.full_scale = readings.full_scale;
  for (const std::vector<regression::CodeStatistics>& sections : readings.sums) {
    all.sums.emplace_back(readings.full_scale);
    for (const regression::CodeStatistics& section : sections) all.sums.back().add(section);
  }
  return all;
}

regression::ClassInputs inputsOf(const SchemePlan& plan, std::size_t taxel,
                                 const regression::ClassReadings& readings,
                                 const regression::RegressorOptions& regressor) {
  std::vector<double> curvature;
  std::vector<bool> bent;
  std::vector<std::uint64_t> number;
  for (std::size_t k = 0; k < plan.classes.size(); ++k) {
    curvature.push_back(plan.classes[k].at(taxel));
    bent.push_back(!dataset::isFlat(plan.classes[k]));
    number.push_back(readings.readings(k));
  }
  regression::ClassInputs inputs = classInputs(plan.scheme, curvature, bent, number);
  // gives exponents D^2 / 2 curvature_scale^2
  if (plan.curvature_scale > 0)
    inputs.scale.front() =
        regression::entryOf(regressor).second_input->sigma(regressor) / plan.curvature_scale;
  return inputs;
}

BlendRule blendOf(Scheme scheme, const regression::RegressorOptions& regressor) {
  switch (scheme) {
    case Scheme::kInterpolated:
    case Scheme::kCurvatureMap:
      return BlendRule::kInterpolate;
    case Scheme::kPerSurface:
      return BlendRule::kByName;
    case Scheme::kCurvatureInput:
    case Scheme::kScaledCurvature:
      return blendOf(regression::entryOf(regressor));
    default:
      return BlendRule::kNearest;
  }
}

std::vector<double> answerOn(const SchemePlan& plan, std::size_t taxel,
                             const regression::ClassReadings& readings,
                             const std::vector<regression::Fit>& fits, std::size_t k, const EffectLaw& law) {
  const std::vector<double>& own = fits[plan.model_of_class[k]].pressure;
  if (!usesCurvature(plan.scheme) || hasSecondInput(plan.scheme) || readings.readings(k) > 0) return own;
  std::vector<double> curvature;
  bool any = false;
  for (std::size_t c = 0; c < plan.classes.size(); ++c) {
    any = any || readings.readings(c) > 0;
    curvature.push_back(readings.readings(c) > 0 ? plan.classes[c].at(taxel) : std::nan(""));
  }
  if (!any) return {};
  const double at = plan.classes[k].at(taxel);
  const CurvaturePlace place = placeOf(at, curvature);
  const std::vector<double>& below = fits[plan.model_of_class[place.below]].pressure;
  const std::vector<double>& above = fits[plan.model_of_class[place.above]].pressure;
  const bool interpolate = plan.scheme == Scheme::kInterpolated || plan.scheme == Scheme::kCurvatureMap;
  if (!interpolate) return place.share > 0.5 ? above : below;
  const EffectLaw::Effect bend =
      straightening(law, curvature[place.below], curvature[place.above], place.share, at);
  std::vector<double> answer(below.size());
  for (std::size_t code = 0; code < answer.size(); ++code) {
    answer[code] = bend.gain * (below[code] + place.share * (above[code] - below[code])) + bend.offset;
  }
  return answer;
}

void requireSchemeFor(Scheme scheme, const regression::RegressorOptions& regressor) {
  regression::makeRegressor(regressor);
  if (!hasSecondInput(scheme)) return;
  const regression::RegressorEntry& entry = regression::entryOf(regressor);
  const std::string needs = "scheme " + schemeName(scheme) + " needs a model that takes " +
                            inputText(scheme) + ", and " + regressor.name;
  if (!canTake(scheme, entry.second_input)) {
    throw settings::InputError(
        needs + " does not; models that do: " + namesThatTake(scheme, regression::tableOf(regressor)));
  }
  const regression::SecondInput& input = *entry.second_input;
  if (input.permitted != nullptr && !input.permitted(regressor)) {
    throw settings::InputError(needs + " does so only with " + input.condition);
  }
}

std::vector<regression::Fit> fitScheme(const SchemePlan& plan, std::size_t taxel,
                                       const regression::ClassReadings& readings,
                                       const regression::RegressorOptions& regressor) {
  std::vector<regression::Fit> fits;
  if (!hasSecondInput(plan.scheme)) {
    const std::unique_ptr<regression::Regressor> model = regression::makeRegressor(regressor);
    for (const SchemePlan::Model& planned : plan.models) {
      fits.push_back(fitClasses(planned.trained_on, readings, *model));
    }
    return fits;
  }
  requireSchemeFor(plan.scheme, regressor);
  std::uint64_t number = 0;
  for (std::size_t k = 0; k < readings.classes(); ++k) number += readings.readings(k);
  if (number == 0) return std::vector<regression::Fit>(plan.models.size());
  const std::vector<regression::Fit> on_class = regression::entryOf(regressor).second_input->fit(
      readings, inputsOf(plan, taxel, readings, regressor), regressor);
  for (std::size_t m = 0; m < plan.models.size(); ++m) fits.push_back(on_class[plan.testedOn(m).front()]);
  return fits;
}

std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const FoldRegressors& regressors, regression::HeldOutDeviation held_out_deviation) {
  const std::size_t sections = readings.sums.front().size();
  Without without(readings, !regression::makeRegressor(regressors.whole)->mergeable());
  std::vector<regression::Fit> whole;
  without(sections, [&](const regression::ClassReadings& all) {
    whole = fitScheme(plan, taxel, all, regressors.whole);
  });
  std::vector<std::vector<std::vector<double>>> held_out(plan.models.size());  // [models][sections]
  for (std::size_t s = 0; s < sections; ++s) {
    without(s, [&](const regression::ClassReadings& rest) {
      std::vector<regression::Fit> fits = fitScheme(plan, taxel, rest, regressors.at(s));
      for (std::size_t m = 0; m < fits.size(); ++m) held_out[m].push_back(std::move(fits[m].pressure));
    });
  }
  std::vector<regression::CrossValidatedModel> models;
  for (std::size_t m = 0; m < plan.models.size(); ++m) {
    models.push_back(regression::assembleModel(testedSections(plan.testedOn(m), readings),
                                               readings.full_scale, whole[m], std::move(held_out[m]),
                                               held_out_deviation));
  }
  return models;
}

std::vector<regression::CrossValidatedModel> crossValidateScheme(
    const SchemePlan& plan, std::size_t taxel, const SectionedReadings& readings,
    const regression::RegressorOptions& regressor, regression::HeldOutDeviation held_out_deviation) {
  return crossValidateScheme(plan, taxel, readings, FoldRegressors{regressor, {}}, held_out_deviation);
}

}  // namespace fsr::compensation
