#include "study/hold_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/study_readings.h"
#include "support/synthetic_recording.h"

namespace fsr::study {

namespace {

using test_support::readingsOf;
using test_support::ScanReading;

// Live tables are floats.
constexpr double kFloats = 1e-5;

// Bending shifts and scales the readings much more than the noise does.
StudyProblem bentProblem() {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_13cm", 7.7}, {"cylinder_5cm", 20.0}};
  rig.scans_per_cycle = 60;
  rig.noise = 30;
  StudyProblem problem{{test_support::syntheticRecording(rig)}, {}, ""};
  problem.plan.forest.trees = 2;
  problem.plan.resamples = 99;
  problem.plan.bandwidths = {1.0 / 64, 1.0 / 16};
  problem.plan.bandwidth_taxels = 2;
  problem.plan.date = "2024-01-01T00:00:00Z";
  return problem;
}

const StudyResult& bentStudy() {
  static const StudyResult result = study(bentProblem());
  return result;
}

template <typename Scored>
const Scored& named(const std::vector<Scored>& list, const std::string& id) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Scored& one) { return one.id == id; });
  if (found == list.end()) throw std::runtime_error("no " + id);
  return *found;
}

const CurvatureErrorScore& at(const CurvatureErrorCurve& curve, double relative, double absolute = 0) {
  for (const CurvatureErrorScore& score : curve.scores)
    if (score.error.relative == relative && score.error.absolute == absolute) return score;
  throw std::runtime_error("no such error");
}

// A GRNN on the readings of one class without section `left_out`, computed from its definition.
double grnn(const StudyData& data, std::size_t c, std::uint32_t left_out, std::size_t taxel, double bandwidth,
            std::uint16_t asked) {
  std::vector<ScanReading> train;
  for (const ScanReading& one : readingsOf(data, data.scans[c], taxel))
    if (one.section != left_out) train.push_back(one);
  double mean = 0, variance = 0;
  for (const ScanReading& one : train) mean += one.count / static_cast<double>(train.size());
  for (const ScanReading& one : train) variance += std::pow(one.count - mean, 2);
  const double sigma = bandwidth * std::sqrt(variance / static_cast<double>(train.size() - 1));
  const auto exponent = [&](const ScanReading& one) {
    return 0.5 * std::pow((asked - one.count) / sigma, 2);
  };
  double nearest = INFINITY, weight = 0, weighted = 0;
  for (const ScanReading& one : train) nearest = std::min(nearest, exponent(one));
  for (const ScanReading& one : train) {
    const double share = std::exp(nearest - exponent(one));
    weight += share;
    weighted += share * one.pressure;
  }
  return weighted / weight;
}

// RMSE of linear interpolation between the classes at a share more than the true curvature, constant beyond
// the classes [Pa].
double plainRmse(const StudyData& data, double bandwidth, double relative) {
  double squares = 0, number = 0;
  for (const std::size_t taxel : data.taxels) {
    for (std::size_t c = 0; c < data.classes.size(); ++c) {
      const double told = data.classes[c].at(taxel) * (1 + relative);
      std::size_t low = 0;
      while (low + 2 < data.classes.size() && data.classes[low + 1].at(taxel) <= told) ++low;
      const double from = data.classes[low].at(taxel), to = data.classes[low + 1].at(taxel);
      const double share = std::clamp((told - from) / (to - from), 0.0, 1.0);
      for (const ScanReading& one : readingsOf(data, data.scans[c], taxel)) {
        const auto pressure = [&](std::size_t k) {
          return grnn(data, k, one.section, taxel, bandwidth, one.count);
        };
        const double answer = (1 - share) * pressure(low) + share * pressure(low + 1);
        squares += std::pow(answer - one.pressure, 2);
        number += 1;
      }
    }
  }
  return std::sqrt(squares / number);
}

}  // namespace

TEST(CurvatureErrors, GiveTheStudysOwnNumbersWhereTheCurvatureIsRight) {
  const StudyResult& result = bentStudy();
  const SplitResult& split = result.splits.front();
  ASSERT_EQ(split.id, "five_sections");
  ASSERT_EQ(result.curvature_errors.size(), split.scores.size());
  for (const CurvatureErrorCurve& curve : result.curvature_errors) {
    const CurvatureErrorScore& right = at(curve, 0);
    const StudyScore& own = named(split.scores, curve.id);
    const double rmse = own.errors.whole.all.rmse;
    EXPECT_NEAR(right.rmse, rmse, kFloats * rmse) << curve.id;
    EXPECT_NEAR(right.rmse_percent, own.rmse_percent_spread.mean, kFloats * own.rmse_percent_spread.mean)
        << curve.id;
    EXPECT_NEAR(right.rmse_interval.low, own.rmse_interval.low, kFloats * rmse) << curve.id;
    EXPECT_NEAR(right.rmse_interval.high, own.rmse_interval.high, kFloats * rmse) << curve.id;
    EXPECT_EQ(right.moved, 0) << curve.id;
    EXPECT_EQ(right.stated, 0) << curve.id;
  }
}

TEST(CurvatureErrors, AgreeWithTheDefinition) {
  const StudyProblem problem = bentProblem();
  const StudyData data = gatherStudyData(problem.recordings, 5);
  const Split split = leaveSectionOut(data);
  const std::vector<StudyMethod> methods = furtherMethods(data);
  const StudyMethod& method = named(methods, "interpolated");
  const std::vector<FoldModel> models(5, plainModel(method, grnnOf({}, 1.0 / 16)));
  const StudyProgress silent;
  const StudyContext context{problem.plan, data, methods, silent};
  const CurvatureErrorCurve curve =
      curvatureErrorsOf(context, method, {split.grouping, split.folds, Scoring::kPooled}, models);
  for (const double share : {0.0, -0.2, 0.2}) {
    const double rmse = plainRmse(data, 1.0 / 16, share);
    EXPECT_NEAR(at(curve, share).rmse, rmse, kFloats * rmse) << share;
  }
}

TEST(CurvatureErrors, GrowForSchemesThatFollowTheCurvatureAndStayForThoseThatTakeNone) {
  for (const std::string id : {"interpolated", "curvature_map"}) {
    const CurvatureErrorCurve& curve = named(bentStudy().curvature_errors, id);
    for (const double sign : {-1.0, 1.0}) {
      double before = at(curve, 0).rmse;
      for (const double share : {0.05, 0.1, 0.2, 0.4}) {
        EXPECT_GT(at(curve, sign * share).rmse, before) << id << ' ' << sign * share;
        before = at(curve, sign * share).rmse;
      }
      EXPECT_GT(at(curve, 0, 2 * sign).rmse, at(curve, 0, sign).rmse) << id;
    }
    EXPECT_GT(at(curve, -0.4).rmse, 2 * at(curve, 0).rmse) << id;
    EXPECT_GT(at(curve, -0.4).rmse_percent, 2 * at(curve, 0).rmse_percent) << id;
  }
  for (const std::string id : {"baseline", "flat_only"}) {
    const CurvatureErrorCurve& curve = named(bentStudy().curvature_errors, id);
    for (const CurvatureErrorScore& score : curve.scores) {
      EXPECT_EQ(score.rmse, at(curve, 0).rmse) << id;
      EXPECT_EQ(score.stated, 0) << id;
    }
  }
}

// 12 1/m, which is 20 1/m less 40 %, is nearer to 7.7 1/m. No smaller share leads to another surface.
TEST(CurvatureErrors, ChangeMethod1OnlyWhereAnotherSurfaceIsNearer) {
  const CurvatureErrorCurve& curve = named(bentStudy().curvature_errors, "per_curvature");
  for (const double share : {-0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.4}) EXPECT_EQ(at(curve, share).moved, 0);
  EXPECT_GT(at(curve, -0.4).moved, 0);
  EXPECT_EQ(at(curve, -0.4).rmse_of_class[1], at(curve, 0).rmse_of_class[1]);
  EXPECT_GT(at(curve, -0.4).rmse_of_class[2], 2 * at(curve, 0).rmse_of_class[2]);
}

TEST(CurvatureErrors, LeaveTheFlatSurfaceAsItIsWhereTheyAreShares) {
  for (const CurvatureErrorCurve& curve : bentStudy().curvature_errors) {
    EXPECT_EQ(at(curve, 0.4).rmse_of_class[0], at(curve, 0).rmse_of_class[0]) << curve.id;
  }
  const CurvatureErrorCurve& curve = named(bentStudy().curvature_errors, "interpolated");
  EXPECT_GT(at(curve, 0, 2).rmse_of_class[0], at(curve, 0).rmse_of_class[0]);
}

TEST(CurvatureErrors, AreNotComputedForThePaperAlone) {
  StudyProblem problem = bentProblem();
  problem.plan.beyond_the_paper = false;
  EXPECT_TRUE(study(problem).curvature_errors.empty());
}

// Between two surfaces the pressure is linear in the curvature, so that half the difference at either side of
// it is the change by one deviation.
TEST(AnswersAtCurvature, StateTheChangeOfThePressureBetweenSurfaces) {
  const StudyProblem problem = bentProblem();
  const StudyData data = gatherStudyData(problem.recordings, 5);
  const Split split = leaveSectionOut(data);
  const std::vector<StudyMethod> methods = furtherMethods(data);
  const FoldModel model = plainModel(named(methods, "interpolated"), grnnOf({}, 1.0 / 16));
  const TaxelReadings readings(data, split.grouping, 0);
  const AnswersAtCurvature answers(model, 0, readings.training(split.folds[0].train, false));
  std::vector<compensation::TableEntry> here, rounder;
  answers.compute(10.0, 1.5, here);
  answers.compute(11.5, 0.0, rounder);
  for (std::size_t code = 1500; code < 2500; code += 100) {
    const double change = std::abs(rounder[code].pressure - here[code].pressure);
    EXPECT_GT(change, 1e3);  // [Pa]
    EXPECT_NEAR(here[code].deviation, change, 1.0) << code;
    EXPECT_EQ(rounder[code].deviation, 0) << code;
  }
}

}  // namespace fsr::study
