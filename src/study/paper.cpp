#include "study/paper.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "settings/number_text.h"
#include "study/fold.h"

namespace fsr::study {

std::optional<PaperScore> paperScore(const std::string& method) {
  static const std::map<std::string, PaperScore> kScores = {
      {"flat_only", {{0.99, 0.0012}, {3.51, 0.19}}},      {"baseline", {{0.94, 0.013}, {6.93, 0.81}}},
      {"per_curvature", {{0.98, 0.0014}, {4.26, 0.18}}},  {"curvature_input", {{0.96, 0.0027}, {5.03, 0.20}}},
      {"flat_or_curved", {{0.97, 0.0055}, {4.66, 0.40}}}, {"binary_input", {{0.98, 0.0060}, {4.96, 0.64}}},
      {"one_hot", {{0.96, 0.003}, {5.05, 0.19}}},
  };
  const auto found = kScores.find(method);
  return found == kScores.end() ? std::nullopt : std::optional<PaperScore>(found->second);
}

PaperFriedman paperFriedman(const std::string& comparison) {
  if (comparison == "algorithms") return {107.31, 109.83};
  if (comparison == "methods") return {270.09, 246.83};
  return {NAN, NAN};
}

std::vector<std::string> paperStatements(const std::string& comparison) {
  static const std::map<std::string, std::vector<std::string>> kStatements = {
      {"algorithms",
       {"Friedman: chi2(2) = 107.31 (R2), 109.83 (RMSE%), p < 0.001.",
        "Linear regression is worse by both measures. GRNN and forest differ in R2, but not in RMSE%."}},
      {"flat_against_all", {"Student's paired t test: they differ by both measures."}},
      {"methods",
       {"Friedman: chi2(4) = 270.09 (R2), 246.83 (RMSE%), p < 0.001.",
        "All pairs differ by both measures. Method 1 is best. Method 3 is better than method 4 in RMSE% and "
        "worse in R2."}},
      {"one_hot", {"Student's paired t test: no significant difference by either measure."}},
  };
  const auto found = kStatements.find(comparison);
  return found == kStatements.end() ? std::vector<std::string>{} : found->second;
}

namespace {

std::string downSamplingText(const StudyPlan& plan) {
  const std::string rule = plan.down_sampling == DownSampling::kRandom
                               ? "drawn at random, seed " + std::to_string(plan.seed)
                           : plan.down_sampling == DownSampling::kEveryNth ? "every n-th scan"
                                                                           : "one contiguous run";
  const std::string binary = plan.binary_share == BinaryShare::kFullFlat
                                 ? "all of the flat condition and one in five scans of the curved ones"
                                 : "half of the shares of method 3";
  return "After the split, within each section, for training and test alike (" + rule +
         "). Baseline, method 2 and one-hot take one in six scans. Method 3 takes all of the flat condition "
         "and one in five scans of the curved ones. Method 4 takes " +
         binary + ". For another number of conditions the shares change accordingly.";
}

std::string kernelText(const StudyPlan& plan) {
  return plan.grnn.distance == regression::KernelDistance::kSquared
             ? "The squared distance, as in Specht's GRNN."
             : "The distance itself, as printed.";
}

// What follows where surfaces were mounted once; empty if each was mounted more often.
std::string mountedOnce(const StudyData& data) {
  const Grouping mounts = byMount(data);
  std::size_t number = 0;
  std::string names;
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    const auto used = [](const ScanList& scans) { return !scans.empty(); };
    if (std::count_if(mounts.scans[c].begin(), mounts.scans[c].end(), used) > 1) continue;
    ++number;
    names += (names.empty() ? "" : ", ") + data.classes[c].surface;
  }
  if (number == 0) return "";
  if (number == data.classes.size()) {
    return "Each surface was mounted once. A difference between curvatures is therefore a condition effect: "
           "the effects of curvature and of that mount together. It holds for this mount only.";
  }
  return std::to_string(number) + " of " + std::to_string(data.classes.size()) +
         " surfaces were mounted once (" + names +
         "). A difference between one of them and another surface is therefore a condition effect: the "
         "effects "
         "of curvature and of that mount together. Leaving mounts out needs two mounts of each surface.";
}

std::string rangeText(const StudyPlan& plan) {
  return plan.range == ScoreRange::kHeldOut ? "the held-out readings" : "all scans";
}

}  // namespace

std::vector<StudyDecision> studyDecisions(const StudyPlan& plan, const StudyData& data) {
  const std::string sections = std::to_string(plan.sections);
  return {
      {"Unit of curvature", "Curvatures \"0.20 ... 0.077 1/m\" belong to radii of 5 to 13 cm.",
       "The values are in 1/cm. The study computes in 1/m and prints both. The \"0.77\" of Fig. 9 is 0.077 "
       "1/cm."},
      {"Kernel of the GRNN", "\"D^2 is the Euclidean distance\".", kernelText(plan)},
      {"Spread", "sigma = 2^-7; the paper does not say how it was tuned.",
       "sigma = " + settings::roundedText(regression::sigmaOf(plan.grnn)) +
           " for the reproduction. A grid of bandwidths is shown beside it. All other results use the "
           "bandwidth chosen by nested cross-validation."},
      {"0 / 0", "Not mentioned. It occurs on held-out data at 2^-7.",
       "The smallest distance is subtracted in all exponents. The limit is then the nearest sample."},
      {"Cross-validation", "\"Leave-one-out\" in five repetitions.",
       sections + " sections of each condition, contiguous in time and divided between cycles. The same "
                  "section is held out in every condition. Readings are standardised by mean and deviation "
                  "of the training readings."},
      {"Down-sampling", "The paper does not say how, nor whether before or after the split.",
       downSamplingText(plan)},
      {"Score of several models", "The paper does not say.",
       "Methods 1 and 3: mean of the scores of their models. The other methods pool the readings of their "
       "one model. RMSE% refers to the range of " +
           rangeText(plan) + "; +- is the standard deviation over taxels."},
      {"Forest", "150 trees, MATLAB, \"one third of the variables\".",
       "With one input, a forest is bagging: " + std::to_string(plan.forest.trees) + " trees, minimum leaf " +
           std::to_string(plan.forest.minimum_leaf) +
           ", exact splits. The treatment of a drawn input that cannot split a node matters only for two "
           "inputs."},
      {"Tests",
       "Shapiro-Wilk's test chooses between parametric and rank tests, symmetry between signed rank and sign "
       "test; SPSS.",
       "The same rule. Symmetry is tested by the triples test. Bonferroni correction over all pairs; level " +
           settings::roundedText(plan.tests.level) + ". The " + std::to_string(data.taxels.size()) +
           " taxels of one sheet are not independent samples. Therefore a bootstrap is reported, too. It "
           "resamples the highest level with at least five units; cycles of all conditions are resampled "
           "together."},
      {"Mounting", "The matrix was never remounted.",
       "Mount and curvature form one condition effect if the recordings cannot separate them."},
      {"Bent axis", "The paper does not say which side of the matrix is bent round the cylinder.",
       "Taken from the surfaces of the recordings."},
      {"What is not reported",
       "Temperature, ramp rate, order of the conditions, synchronisation of the two records.",
       "No correction. Bags contain these values if the rig records them."},
      {"Transducer", "A digital transducer, read by an analogue input.",
       "Treated as analogue: the chamber pressure is used as recorded."},
      {"Seal", "The paper did not check whether the PDMS seal let air in.",
       "This study cannot detect a leak. The discrepancy tool tests for it."},
      {"Conditioning cycles", "Apparently kept.", "Kept. First and later cycles are reported separately."},
  };
}

bool fittedToThePaper(const std::string& simulation) {
  return simulation == "paper" || simulation == "paper_noisy";
}

std::vector<std::string> unmatchable() {
  return {
      "Method 4's R2 of 0.98 with an RMSE of 4.96 % and method 2's R2 of 0.96 with 5.03 % cannot both be "
      "right for one distribution of pressure: equal RMSE on equal data means equal R2. The study reports "
      "R2, but it was not fitted.",
      "\"Both measures were improved\" by the one-hot input, but 5.05 % is not below 5.03 %. At a bandwidth "
      "of 2^-7, training readings of other curvatures have no weight: after standardisation their curvature "
      "is 29 to 161 sigmas away. Method 2 is then method 1 on a sixth of the data, method 4 is method 3 "
      "scored on pooled readings, and one-hot is method 2. Curvature becomes a useful input with a length "
      "scale of its own.",
      "The paper explains method 2 by differences of curvature that the model takes for differences of "
      "response. That needs a larger bandwidth, at which curvature has an influence.",
      "Only the means of RMSE% were fitted. R2, deviations over taxels and test statistics were not. "
      "Friedman's chi2 reaches its maximum n (k - 1) if all taxels rank the methods alike, which simulated "
      "taxels do more than real ones.",
      "The tables can be matched without hysteresis, by noise of 3 to 3.5 % (most of the rig "
      "paper_noisy). With hysteresis and creep instead (rig paper), methods 1 and 2 have smaller errors than "
      "in the tables, because a loop in kPa does not grow on a bent surface, whose sensitivity is lower. The "
      "paper gives no time series, so both compositions are assumptions.",
  };
}

std::vector<std::string> limitations(const StudyData& data, const std::string& simulation) {
  std::vector<std::string> sentences;
  if (!simulation.empty()) {
    sentences.push_back(
        "The recordings come from the simulated rig \"" + simulation + "\", not from a sensor." +
        (fittedToThePaper(simulation) ? " That rig was FITTED to the paper's tables. The agreement "
                                        "therefore validates neither the simulation nor the paper."
                                      : ""));
  }
  const std::string once = mountedOnce(data);
  if (!once.empty()) sentences.push_back(once);
  sentences.push_back(
      "One sheet (n = 1): intervals and p values do not apply to another sheet. Units: taxel, n = " +
      std::to_string(data.taxels.size()) + "; cycle, n = " + std::to_string(data.cycles) +
      "; mount, n = " + std::to_string(data.mounts) + "; sheet, n = 1.");
  return sentences;
}

namespace {

// The shares for down-sampling: each model uses as many scans as one class has.
std::vector<std::size_t> sharesOf(compensation::Scheme scheme, const StudyData& data,
                                  BinaryShare binary_share) {
  const auto flats =
      static_cast<std::size_t>(std::count_if(data.classes.begin(), data.classes.end(), dataset::isFlat));
  const std::size_t bent = data.classes.size() - flats;
  const std::size_t half =
      scheme == compensation::Scheme::kBinaryInput && binary_share == BinaryShare::kHalfAndHalf ? 2 : 1;
  std::vector<std::size_t> one_of;
  for (const dataset::CurvatureClass& curvature_class : data.classes) {
    const bool flat = dataset::isFlat(curvature_class);
    switch (scheme) {
      case compensation::Scheme::kFlatOnly:
        one_of.push_back(flat ? 1 : 0);
        break;
      case compensation::Scheme::kPerCurvature:
        one_of.push_back(1);
        break;
      case compensation::Scheme::kFlatOrCurved:
      case compensation::Scheme::kBinaryInput:
        one_of.push_back(half * (flat ? flats : bent));
        break;
      default:
        one_of.push_back(data.classes.size());
    }
  }
  return one_of;
}

}  // namespace

std::size_t StudyMethod::models() const {
  return compensation::hasSecondInput(plan.scheme) ? 1 : plan.models.size();
}

std::size_t StudyMethod::modelOf(std::size_t curvature_class) const {
  return models() == 1 ? 0 : plan.model_of_class[curvature_class];
}

std::vector<StudyMethod> paperMethods(const StudyData& data, BinaryShare binary_share) {
  data.flatClass();
  const bool bent = !std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat);
  std::vector<StudyMethod> methods;
  const auto add = [&](compensation::Scheme scheme, const std::string& label) {
    methods.push_back({compensation::schemeName(scheme), label,
                       compensation::planScheme(scheme, data.classes), sharesOf(scheme, data, binary_share)});
  };
  add(compensation::Scheme::kFlatOnly, "Flat");
  add(compensation::Scheme::kBaseline, "Baseline");
  add(compensation::Scheme::kPerCurvature, "Method 1");
  add(compensation::Scheme::kCurvatureInput, "Method 2");
  if (bent) {
    add(compensation::Scheme::kFlatOrCurved, "Method 3");
    add(compensation::Scheme::kBinaryInput, "Method 4");
  }
  add(compensation::Scheme::kOneHot, "Method 2, one-hot");
  return methods;
}

std::vector<StudyMethod> furtherMethods(const StudyData& data) {
  std::vector<StudyMethod> methods;
  if (std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat)) return methods;
  const std::vector<std::size_t> all(data.classes.size(), 1);
  const auto add = [&](compensation::Scheme scheme, const std::string& label) {
    methods.push_back(
        {compensation::schemeName(scheme), label, compensation::planScheme(scheme, data.classes), all});
  };
  add(compensation::Scheme::kScaledCurvature, "Scaled curvature");
  add(compensation::Scheme::kCurvatureMap, "Curvature map");
  add(compensation::Scheme::kInterpolated, "Interpolated");
  add(compensation::Scheme::kCurvatureRanges, "Curvature ranges");
  return methods;
}

}  // namespace fsr::study
