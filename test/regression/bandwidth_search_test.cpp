#include "regression/bandwidth_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {
namespace {

constexpr std::uint16_t kTenBits = 1023;

// Readings with scatter [counts] of a curve with waves a hundred codes long.
CodeSamples wavyCurve(std::size_t number, double scatter, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, scatter);
  CodeSamples samples;
  samples.full_scale = kTenBits;
  for (std::size_t i = 0; i < number; ++i) {
    const double place = 100 + static_cast<double>(random() % 800);
    const double reading = std::clamp(std::round(place + normal(random)), 0.0, 1023.0);
    samples.add(static_cast<std::uint16_t>(reading), toFixed(500 * place + 20e3 * std::sin(place / 16)));
  }
  return samples;
}

std::vector<CodeSamples> sectionsOf(double scatter) {
  std::vector<CodeSamples> sections;
  for (unsigned k = 0; k < 4; ++k) sections.push_back(wavyCurve(500, scatter, 10 + k));
  return sections;
}

std::vector<CodeStatistics> sumsOf(const std::vector<CodeSamples>& sections) {
  std::vector<CodeStatistics> sums;
  for (const CodeSamples& section : sections) sums.push_back(statisticsOf(section));
  return sums;
}

// Squared errors on section `tested` of a model trained without it and without `left_out`, reading by
// reading.
double plainSquares(const std::vector<CodeSamples>& sections, std::size_t tested, std::size_t left_out,
                    double bandwidth) {
  CodeSamples training;
  training.full_scale = kTenBits;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (k != tested && k != left_out) training.append(sections[k]);
  }
  const Fit fit = Grnn(bandwidth).fitSamples(training);
  double sum = 0;
  for (std::size_t i = 0; i < sections[tested].size(); ++i) {
    sum += std::pow(fit.pressure[sections[tested].code[i]] - fromFixed(sections[tested].pressure[i]), 2);
  }
  return sum;
}

TEST(BandwidthErrors, AreThoseOfModelsTrainedWithoutBothSections) {
  const auto sections = sectionsOf(3);
  const BandwidthErrors errors(sumsOf(sections), kTenBits, {}, {0.01, 0.1});
  for (const std::size_t g : {0, 1}) {
    double whole = 0, without_second = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      whole += plainSquares(sections, k, k, errors.grid()[g]);
      if (k != 1) without_second += plainSquares(sections, k, 1, errors.grid()[g]);
    }
    EXPECT_NEAR(errors.squares(g) / whole, 1.0, 1e-9);
    EXPECT_NEAR(errors.squares(g, 1) / without_second, 1.0, 1e-9);
  }
}

TEST(BandwidthErrors, ChooseAWiderBandwidthForMoreScatter) {
  const auto best = [](double scatter) {
    return BandwidthErrors(sumsOf(sectionsOf(scatter)), kTenBits, {}, bandwidthGrid()).best();
  };
  EXPECT_LT(best(0.5), best(12));
  EXPECT_GT(best(12), bandwidthGrid().front());
  EXPECT_LT(best(12), bandwidthGrid().back());
}

TEST(BandwidthErrors, TheChoiceForASectionDoesNotUseIt) {
  auto sections = sectionsOf(3);
  const BandwidthErrors before(sumsOf(sections), kTenBits, {}, bandwidthGrid());
  for (FixedPressure& pressure : sections[2].pressure) pressure = toFixed(1e6) - pressure;
  const BandwidthErrors after(sumsOf(sections), kTenBits, {}, bandwidthGrid());
  for (std::size_t g = 0; g < before.grid().size(); ++g) {
    EXPECT_EQ(before.squares(g, 2), after.squares(g, 2));
    EXPECT_NE(before.squares(g), after.squares(g));
  }
}

TEST(BandwidthErrors, OfTwoTaxelsAreAdded) {
  BandwidthErrors both(sumsOf(sectionsOf(3)), kTenBits, {}, {0.01, 0.1});
  const BandwidthErrors other(sumsOf(sectionsOf(9)), kTenBits, {}, {0.01, 0.1});
  const double before = both.squares(1, 0);
  both.add(other);
  EXPECT_EQ(both.squares(1, 0), before + other.squares(1, 0));
}

TEST(BandwidthErrors, ChooseThePapersBandwidthIfNothingCanBeHeldOut) {
  const auto sections = sumsOf({wavyCurve(50, 3, 1), wavyCurve(0, 3, 1)});
  const BandwidthErrors errors(sections, kTenBits, {}, bandwidthGrid());
  EXPECT_EQ(errors.best(), kPaperBandwidth);
}

TEST(BandwidthErrors, RefuseWeightsOfPressureBins) {
  GrnnOptions options;
  options.weighting = SampleWeighting::kEachPressureBin;
  EXPECT_THROW(BandwidthErrors(sumsOf(sectionsOf(3)), kTenBits, options, {0.1}), settings::InputError);
}

}  // namespace
}  // namespace fsr::regression
