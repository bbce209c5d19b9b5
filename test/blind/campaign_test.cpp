#include "blind/campaign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "blind/sheet.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {
namespace {

const fsr::matrix::Layout kLayout{{3, 4}, 0.010, 0.010};

class EveryProtocol : public testing::TestWithParam<std::string> {};

TEST_P(EveryProtocol, LoadsEverySurfaceOverTheWholeRangeInTime) {
  const Campaign campaign = runCampaign(kLayout, {GetParam()}, {3, 0.5}, 4);
  std::set<std::size_t> surfaces;
  for (const Visit& visit : campaign.visits) {
    surfaces.insert(visit.surface);
    const auto begin = campaign.pressure.begin();
    const auto first = begin + static_cast<std::ptrdiff_t>(visit.first);
    const auto last = begin + static_cast<std::ptrdiff_t>(visit.last);
    EXPECT_GT(*std::max_element(first, last), 0.97 * kPeak);
    EXPECT_LT(*std::min_element(first, last), 0.01 * kPeak);
  }
  EXPECT_EQ(surfaces.size(), GetParam() == "hours_apart" ? 1u : 3u);
  EXPECT_TRUE(std::is_sorted(campaign.time.begin(), campaign.time.end()));
  EXPECT_EQ(campaign.visits.size() > 3, remounts(GetParam()));
  for (const Trace* trace :
       {&campaign.pressure, &campaign.rate, &campaign.temperature, &campaign.thermometer}) {
    EXPECT_EQ(trace->size(), campaign.scans());
    EXPECT_TRUE(std::all_of(trace->begin(), trace->end(), [](double value) { return std::isfinite(value); }));
  }
}

INSTANTIATE_TEST_SUITE_P(Blind, EveryProtocol, testing::ValuesIn(protocolNames()));

TEST(BlindProtocol, OfThePaperIs45000ScansOnSixSurfaces) {
  const Campaign campaign = runCampaign({{7, 10}, 0.010, 0.010}, {"paper"}, {}, 1);
  EXPECT_NEAR(static_cast<double>(campaign.scans()), 45000, 100);
  EXPECT_EQ(campaign.visits.size(), 6u);
  EXPECT_EQ(campaign.cycle.back() + 1, 60u);
  EXPECT_EQ(campaign.surfaces.back().name, "cylinder_5cm");
  EXPECT_NEAR(*std::max_element(campaign.rate.begin(), campaign.rate.end()), 17e3, 200);
}

TEST(BlindProtocol, OfTwoSpeedsHasTwo) {
  const Campaign campaign = runCampaign(kLayout, {"two_speeds"}, {1, 1}, 1);
  const auto at = [&](double rate) {
    const auto near = [&](double value) { return std::abs(value - rate) < 300; };
    return std::count_if(campaign.rate.begin(), campaign.rate.end(), near);
  };
  EXPECT_GT(at(8e3), 1000);
  EXPECT_GT(at(40e3), 500);
  EXPECT_GT(at(0), 1000);
}

TEST(BlindProtocol, OfTwoAmbientsIsWarmerTheSecondTime) {
  const Campaign campaign = runCampaign(kLayout, {"two_ambients"}, {2, 0.5}, 1);
  EXPECT_GT(campaign.thermometer.back() - campaign.thermometer.front(), 5);
}

TEST(BlindProtocol, GoesOnWhereTheOneBeforeItEnded) {
  const Campaign first = runCampaign(kLayout, {"paper"}, {2, 0.5}, 1);
  const Campaign both = runCampaign(kLayout, {"paper", "rest"}, {2, 0.5}, 1);
  ASSERT_EQ(both.first_scans, first.scans());
  EXPECT_EQ(both.first_visits, first.visits.size());
  EXPECT_GT(both.scans(), first.scans());
  EXPECT_TRUE(std::equal(first.thermometer.begin(), first.thermometer.end(), both.thermometer.begin()));
  EXPECT_GT(both.time[both.first_scans], first.time.back() + 200);
}

TEST(BlindProtocol, OfAnUnknownNameIsRefused) {
  EXPECT_THROW(runCampaign(kLayout, {"papers"}, {}, 1), fsr::settings::InputError);
}

TEST(BlindSheet, RisesWithTheLoadUnderEveryLaw) {
  const Campaign campaign = runCampaign(kLayout, {"paper"}, {3, 0.2}, 1);
  std::set<std::string> laws;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Sheet sheet(campaign, seed);
    laws.insert(sheet.staticLaw());
    EXPECT_EQ(sheet.rise(0, 0), 0);
    for (double load = 1e3; load < 750e3; load += 1e3) {
      ASSERT_GT(sheet.rise(5, load), sheet.rise(5, load - 1e3)) << sheet.staticLaw() << " at " << load;
    }
    EXPECT_LT(sheet.rise(5, 700e3), 0.9);
    for (std::size_t taxel = 0; taxel < campaign.taxels(); ++taxel) {
      EXPECT_GT(sheet.preload(taxel, 2), 15e3);
      EXPECT_LT(sheet.gain(taxel, 2), 0.97);
    }
  }
  EXPECT_EQ(laws.size(), 3u);
}

}  // namespace
}  // namespace blind
