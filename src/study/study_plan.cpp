#include "study/study_plan.h"

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::study {

namespace {

const std::vector<std::string> kDownSamplingNames = {"random", "every_nth", "contiguous"};
const settings::Range kSections{2, 20, ""};
const settings::Range kTrees{1, 100000, ""};
const settings::Range kLeaf{1, 100000, ""};
const settings::Range kLevel{1e-6, 0.5, ""};
const settings::Range kBandwidth{1e-6, 1e3, "standard deviations of the readings"};
const settings::Range kTaxels{1, 4096, ""};
const settings::Range kResamples{99, 1e6, ""};

template <typename Kind>
Kind choose(const settings::Settings& settings, const std::string& key, const std::vector<std::string>& names,
            Kind fallback) {
  const std::string chosen = settings.choice(key, names, names.at(static_cast<std::size_t>(fallback)));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == chosen) return static_cast<Kind>(i);
  }
  return fallback;
}

std::size_t whole(const settings::Settings& settings, const std::string& key, const settings::Range& range,
                  std::size_t fallback) {
  return static_cast<std::size_t>(settings.integer(key, range, static_cast<std::int64_t>(fallback)));
}

void readGrnn(const settings::Settings& settings, regression::GrnnOptions& grnn) {
  grnn.bandwidth = settings.number("bandwidth", kBandwidth, grnn.bandwidth);
  grnn.spread = choose(settings, "spread", {"sigma", "half"}, grnn.spread);
  grnn.distance = choose(settings, "distance", {"squared", "literal"}, grnn.distance);
}

void readTests(const settings::Settings& settings, statistics::PaperRuleOptions& tests) {
  tests.level = settings.number("level", kLevel, tests.level);
  tests.normality = choose(settings, "normality_of", {"treatments", "differences"}, tests.normality);
}

void require(bool holds, const std::string& origin, const std::string& field, double value,
             const settings::Range& range) {
  if (holds) return;
  std::string text = std::to_string(value);
  throw settings::InputError(origin + ": " + field + " is " + text + ", but must be " + range.text());
}

void require(const std::string& origin, const std::string& field, double value,
             const settings::Range& range) {
  require(range.contains(value), origin, field, value, range);
}

}  // namespace

std::string downSamplingName(DownSampling down_sampling) {
  return kDownSamplingNames.at(static_cast<std::size_t>(down_sampling));
}

void validate(const StudyPlan& plan, const std::string& origin) {
  require(origin, "sections", static_cast<double>(plan.sections), kSections);
  require(origin, "grnn.bandwidth", plan.grnn.bandwidth, kBandwidth);
  require(origin, "forest.trees", static_cast<double>(plan.forest.trees), kTrees);
  require(origin, "forest.minimum_leaf", static_cast<double>(plan.forest.minimum_leaf), kLeaf);
  require(origin, "tests.level", plan.tests.level, kLevel);
  require(origin, "bandwidth_taxels", static_cast<double>(plan.bandwidth_taxels), kTaxels);
  require(origin, "resamples", static_cast<double>(plan.resamples), kResamples);
  for (const double bandwidth : plan.bandwidths) require(origin, "bandwidths", bandwidth, kBandwidth);
  if (plan.bandwidths.empty())
    throw settings::InputError(origin + ": bandwidths is empty, but must have at least one value");
}

StudyPlan readStudyPlan(const settings::Settings& settings) {
  StudyPlan plan;
  plan.name = settings.text("study");
  plan.sections = whole(settings, "sections", kSections, plan.sections);
  plan.down_sampling = choose(settings, "down_sampling", kDownSamplingNames, plan.down_sampling);
  plan.binary_share = choose(settings, "method_4", {"full_flat", "half_and_half"}, plan.binary_share);
  plan.range = choose(settings, "range", {"held_out", "all"}, plan.range);
  if (settings.has("grnn")) readGrnn(settings.section("grnn"), plan.grnn);
  if (settings.has("forest")) {
    const settings::Settings forest = settings.section("forest");
    plan.forest.trees = whole(forest, "trees", kTrees, plan.forest.trees);
    plan.forest.minimum_leaf = whole(forest, "minimum_leaf", kLeaf, plan.forest.minimum_leaf);
  }
  if (settings.has("tests")) readTests(settings.section("tests"), plan.tests);
  if (settings.has("bandwidths")) plan.bandwidths = settings.numbers("bandwidths", kBandwidth);
  plan.bandwidth_taxels = whole(settings, "bandwidth_taxels", kTaxels, plan.bandwidth_taxels);
  plan.resamples = whole(settings, "resamples", kResamples, plan.resamples);
  plan.beyond_the_paper = settings.flag("beyond_the_paper", plan.beyond_the_paper);
  if (settings.has("figure_taxel")) plan.figure_taxel = whole(settings, "figure_taxel", {0, 4095, ""}, 0);
  plan.seed = static_cast<std::uint64_t>(settings.integer("seed", {0, 1e15, ""}, 1));
  settings.refuseUnknown();
  validate(plan, settings.origin());
  return plan;
}

StudyPlan readStudyPlanFile(const std::string& path) {
  return readStudyPlan(settings::Settings::fromFile(path));
}

}  // namespace fsr::study
