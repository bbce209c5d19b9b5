#include "study/decisions.h"

#include "settings/number_text.h"
#include "study/fold.h"

namespace fsr::study {

namespace {

std::string downSamplingText(const StudyPlan& plan) {
  const std::string rule = plan.down_sampling == DownSampling::kRandom
                               ? "drawn at random, seed " + std::to_string(plan.seed)
                           : plan.down_sampling == DownSampling::kEveryNth ? "every n-th scan"
                                                                           : "one contiguous run";
  const std::string binary = plan.binary_share == BinaryShare::kFullFlat
                                 ? "the flat condition whole and one in five of the curved"
                                 : "half of each of these";
  return "After the split, within each section, training and test alike (" + rule +
         "): baseline, method 2 and one-hot one in six; method 3 flat whole, curved one in five; method 4 " +
         binary + ". With another number of conditions the shares follow.";
}

std::string kernelText(const StudyPlan& plan) {
  return plan.grnn.distance == regression::KernelDistance::kSquared
             ? "The squared distance, as in Specht's GRNN."
             : "Literally: the distance.";
}

std::string rangeText(const StudyPlan& plan) {
  return plan.range == ScoreRange::kHeldOut ? "the readings that are scored" : "all scans";
}

}  // namespace

std::vector<StudyDecision> studyDecisions(const StudyPlan& plan, const StudyData& data) {
  const std::string sections = std::to_string(plan.sections);
  return {
      {"Unit of curvature", "Curvatures \"0.20 ... 0.077 1/m\" belong to radii of 5 to 13 cm.",
       "They are 1/cm; computed in 1/m, printed in both. The \"0.77\" of Fig. 9 is 0.077 1/cm."},
      {"Kernel of the GRNN", "\"D^2 is the Euclidean distance\".", kernelText(plan)},
      {"Spread", "sigma = 2^-7; how it was tuned is not said.",
       "sigma = " + settings::roundedText(regression::sigmaOf(plan.grnn)) +
           " to reproduce; beside it the grid, and for use the choice by nested cross-validation."},
      {"0 / 0", "Not mentioned; it happens on held-out data at 2^-7.",
       "The smallest distance is taken out of all exponents, so that the limit is the nearest sample."},
      {"Cross-validation", "\"Leave-one-out\" in five repetitions.",
       sections +
           " sections of each condition, contiguous in time, cut between cycles, the same one held out in "
           "every condition. Standardised by mean and deviation of the training readings."},
      {"Down-sampling", "How, and whether before or after the split, is not said.", downSamplingText(plan)},
      {"Score of several models", "Not said.",
       "Methods 1 and 3: mean of their models' scores; the others pool the readings of their one model. "
       "RMSE% "
       "refers to the range of " +
           rangeText(plan) + "; +- is the deviation over taxels."},
      {"Forest", "150 trees, MATLAB, \"one third of the variables\".",
       "One input makes it bagging: " + std::to_string(plan.forest.trees) + " trees, minimum leaf " +
           std::to_string(plan.forest.minimum_leaf) +
           ", exact splits. What a drawn input that cannot split does to its node, which moves the error of "
           "a "
           "forest on two inputs, plays no part here."},
      {"Tests", "Shapiro-Wilk decides; symmetry decides between signed rank and sign test; SPSS.",
       "The same rule; symmetry by the triples test; Bonferroni over all pairs; level " +
           settings::roundedText(plan.tests.level) + ". " + std::to_string(data.taxels.size()) +
           " taxels of one sheet are no independent samples: a bootstrap over the highest level that has "
           "five units "
           "stands beside; cycles of all conditions are drawn together."},
      {"Mounting", "The matrix was never remounted.",
       "Mount and curvature are taken as one condition effect where the recordings cannot tell them apart."},
      {"Bent axis", "Not said which side of the matrix goes round the cylinder.",
       "Taken from the surfaces of the recordings."},
      {"What is not reported",
       "Temperature, ramp rate, the order of the conditions, how well both records were synchronised.",
       "Nothing is corrected for them; bags carry them where a rig records them."},
      {"Transducer", "A digital one, read by an analogue input.",
       "Taken as analogue: the chamber's readings are used as they were recorded."},
      {"Seal", "Whether the PDMS seal let air in was not checked.",
       "A leak is a candidate that discrepancy tries, not one that this study could tell."},
      {"Conditioning cycles", "Kept, as it seems.", "Kept; first and later cycles are reported apart."},
  };
}

std::vector<std::string> unmatchable() {
  return {
      "Method 4's R2 of 0.98 with RMSE of 4.96 % and method 2's 0.96 with 5.03 % cannot both hold on one "
      "distribution "
      "of pressure: equal RMSE on equal data means equal R2. R2 is reported, not chased.",
      "\"Both measures were improved\" by the one-hot input: 5.05 % is not below 5.03 %. At a bandwidth of "
      "2^-7 no "
      "training reading of another curvature has any weight after standardisation (its curvature is 29 to "
      "161 sigmas "
      "away), so method 2 is method 1 on a sixth of the data, method 4 is method 3 scored on pooled "
      "readings, and "
      "one-hot is method 2. What would make curvature a useful input is a length scale of its own.",
      "The paper's explanation of method 2, that the model reads differences of curvature as differences of "
      "response, "
      "needs a bandwidth at which it does read them.",
      "Fitted were the means of RMSE% alone. R2, deviations over taxels and test statistics come out as they "
      "do: "
      "Friedman's chi2 is at its largest (n (k - 1)) where all taxels rank alike, as simulated taxels do "
      "more than "
      "real ones.",
      "The tables can be matched without hysteresis, by noise of 3 to 3.5 %: they do not show whether there "
      "is any.",
  };
}

std::vector<std::string> whatItHoldsFor(const StudyData& data, const std::string& simulation) {
  std::vector<std::string> sentences;
  if (!simulation.empty()) {
    sentences.push_back(
        "The recordings come from the simulated rig \"" + simulation + "\", not from a sensor." +
        (simulation == "paper" ? " That rig was FITTED to the paper's tables: that it matches them "
                                 "validates neither the simulation nor the paper."
                               : ""));
  }
  const bool remounted = !leaveMountOut(data).folds.empty();
  if (!remounted) {
    sentences.push_back(
        "Each surface was mounted once: what is found of a curvature is a condition effect, of curvature "
        "and of that mount together, and holds for this mount only.");
  }
  sentences.push_back(
      "One sheet (n = 1): intervals and p values say nothing about another sheet. Units: taxel, n = " +
      std::to_string(data.taxels.size()) + "; cycle, n = " + std::to_string(data.cycles) +
      "; mount, n = " + std::to_string(data.mounts) + "; sheet, n = 1.");
  return sentences;
}

}  // namespace fsr::study
