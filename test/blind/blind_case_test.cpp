#include "blind/blind_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "blind/hat_fit.h"
#include "blind/small_case.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {
namespace {

// By the pressure in the recordings.
HatFit hatFit(const BlindCase& made) {
  Trace pressure;
  for (const fsr::dataset::Recording& recording : made.recordings) {
    pressure.insert(pressure.end(), recording.pressure.begin(), recording.pressure.end());
  }
  return {made.campaign, pressure};
}

// The recorded reading of a taxel [share of full scale].
Trace measured(const BlindCase& made, std::size_t taxel) {
  Trace readings;
  for (const fsr::dataset::Recording& recording : made.recordings) {
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      readings.push_back(recording.scan(i)[taxel] / (1.0 * recording.full_scale));
    }
  }
  return readings;
}

// --- size of the effect ---------------------------------------------------------------------------

struct Claim {
  const char* id;
  const char* form;
  double snr;
};

void PrintTo(const Claim& claim, std::ostream* out) {
  *out << claim.id << ":" << claim.form << " at " << claim.snr;
}

class SizeOf : public testing::TestWithParam<Claim> {};

TEST_P(SizeOf, WhatIsHiddenIsTheOneClaimed) {
  CaseSpec spec = smallCase(GetParam().id, GetParam().form, GetParam().snr);
  spec.protocol = protocolFor(findForm(GetParam().id, GetParam().form));
  const BlindCase made = makeCase(spec);
  const HatFit fit = hatFit(made);
  double left = 0, noise = 0;
  for (std::size_t taxel = 0; taxel < made.campaign.taxels(); ++taxel) {
    left += meanSquare(fit.residual(made.clean[taxel])) - meanSquare(fit.residual(made.base[taxel]));
    noise += meanSquare(minus(measured(made, taxel), made.clean[taxel]));
  }
  ASSERT_EQ(made.hidden.size(), 1u);
  // Two different static fits agree within a few per cent.
  EXPECT_NEAR(std::sqrt(left / noise), GetParam().snr, 0.06 * GetParam().snr);
  EXPECT_NEAR(made.hidden[0].snr, GetParam().snr, 0.02 * GetParam().snr);
}

INSTANTIATE_TEST_SUITE_P(
    Blind, SizeOf,
    testing::Values(Claim{"hysteresis", "preisach", 4}, Claim{"hysteresis", "duhem", 0.25},
                    Claim{"creep", "power_law", 1}, Claim{"time_skew", "by_mount", 2},
                    Claim{"seal_leak", "orifice", 0.5}, Claim{"mains_pickup", "wandering_grid", 1},
                    Claim{"repositioning", "tilt", 1}, Claim{"dead_taxel", "open_spells", 0.5},
                    Claim{"temperature", "quadratic", 1}, Claim{"drift", "random_walk", 0.125}));

// --- place of the effect --------------------------------------------------------------------------

struct Shares {
  std::map<std::size_t, double> taxel, surface, bin;  // mean squares, then as share of the largest rms
};

void toShares(std::map<std::size_t, double>& squares, std::map<std::size_t, double>& numbers) {
  double largest = 0;
  for (auto& [member, square] : squares) {
    square = std::sqrt(square / numbers[member]);
    largest = std::max(largest, square);
  }
  for (auto& [member, square] : squares) square /= largest;
}

Shares sharesOf(const BlindCase& made, bool is_static) {
  const HatFit fit = hatFit(made);
  Shares shares, numbers;
  for (std::size_t taxel = 0; taxel < made.campaign.taxels(); ++taxel) {
    const Trace difference = minus(made.clean[taxel], made.base[taxel]);
    const Trace seen = is_static ? difference : fit.residual(difference);
    for (std::size_t scan = 0; scan < seen.size(); ++scan) {
      const std::size_t surface = made.campaign.visits[made.campaign.visit[scan]].surface;
      const auto bin = static_cast<std::size_t>(std::max(0.0, made.campaign.pressure[scan]) / 25e3);
      for (auto [table, number, member] : {std::tuple{&shares.taxel, &numbers.taxel, taxel},
                                           std::tuple{&shares.surface, &numbers.surface, surface},
                                           std::tuple{&shares.bin, &numbers.bin, bin}}) {
        (*table)[member] += seen[scan] * seen[scan];
        (*number)[member] += 1;
      }
    }
  }
  toShares(shares.taxel, numbers.taxel);
  toShares(shares.surface, numbers.surface);
  toShares(shares.bin, numbers.bin);
  return shares;
}

// `named` has a share of at least `least` and all others have less. Because the two fits differ, values
// within a tenth of the limit may fall on either side.
void expectExactly(const std::map<std::size_t, double>& shares, const std::vector<std::size_t>& named,
                   double least, const std::string& what) {
  for (const auto& [member, share] : shares) {
    if (std::find(named.begin(), named.end(), member) != named.end()) {
      EXPECT_GT(share, least - 0.1) << what << " " << member << " is named, but nothing shows there";
      EXPECT_GT(share, 0) << what << " " << member;
    } else {
      EXPECT_LT(share, least + 0.1) << what << " " << member << " is not named, but it shows there";
    }
  }
}

class EveryForm : public testing::TestWithParam<HiddenForm> {};

TEST_P(EveryForm, ShowsWhereTheKeySaysAndNowhereElse) {
  const HiddenForm& form = GetParam();
  for (const std::uint64_t seed : {3u, 4u}) {  // the effect is limited in one, where the form permits it
    CaseSpec spec = smallCase(form.id, form.form, 1, seed);
    spec.protocol = protocolFor(form);
    const BlindCase made = makeCase(spec);
    ASSERT_EQ(made.hidden.size(), 1u);
    const HiddenTruth& truth = made.hidden[0];
    const Shares shares = sharesOf(made, form.left_after == LeftAfter::kCurveShared);
    expectExactly(shares.taxel, truth.taxels, 0.1, "taxel");
    expectExactly(shares.surface, truth.surfaces, 0.1, "surface");
    for (const auto& [bin, share] : shares.bin) {
      const double middle = (static_cast<double>(bin) + 0.5) * 25e3;
      const bool inside = middle > truth.pressures.first && middle < truth.pressures.second;
      if (inside) continue;
      EXPECT_LT(share, 0.35) << form.form << " shows at " << middle << " Pa";
    }
    EXPECT_GT(truth.snr, 0.95) << form.form;
    EXPECT_LT(truth.snr, 1.05) << form.form;
    for (const Trace& clean : made.clean) {
      EXPECT_LT(*std::max_element(clean.begin(), clean.end()), 0.995) << form.form << " is clipped";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Blind, EveryForm, testing::ValuesIn(hiddenForms()),
                         [](const auto& test) { return test.param.id + "_" + test.param.form; });

TEST(BlindForms, OfNoStrengthChangeNothingBitForBit) {
  for (const HiddenForm& form : hiddenForms()) {
    CaseSpec spec = smallCase(form.id, form.form, 1);
    spec.protocol = protocolFor(form);
    spec.effects[0].strength = 0.0;
    spec.noise = 0.005;
    const BlindCase made = makeCase(spec);
    EXPECT_TRUE(made.clean == made.base) << form.id << ":" << form.form;
  }
}

TEST(BlindForms, ThatAreConfinedChangeNothingElsewhere) {
  int to_taxels = 0, to_surfaces = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const BlindCase made = makeCase(smallCase("hysteresis", "duhem", 1, seed));
    const HiddenTruth& truth = made.hidden[0];
    to_taxels += truth.taxels.size() < made.campaign.taxels();
    to_surfaces += truth.surfaces.size() < made.campaign.surfaces.size();
    for (std::size_t taxel = 0; taxel < made.campaign.taxels(); ++taxel) {
      const bool named = std::count(truth.taxels.begin(), truth.taxels.end(), taxel) > 0;
      for (const Visit& visit : made.campaign.visits) {
        const bool here =
            named && std::count(truth.surfaces.begin(), truth.surfaces.end(), visit.surface) > 0;
        const auto first = static_cast<std::ptrdiff_t>(visit.first),
                   last = static_cast<std::ptrdiff_t>(visit.last);
        const bool same = std::equal(made.clean[taxel].begin() + first, made.clean[taxel].begin() + last,
                                     made.base[taxel].begin() + first);
        EXPECT_NE(same, here) << "seed " << seed << ", taxel " << taxel;
      }
    }
  }
  EXPECT_GT(to_taxels, 0);
  EXPECT_GT(to_surfaces, 0);
}

TEST(BlindForms, AreConfinedNowhereWhereThatIsNotWanted) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CaseSpec spec = smallCase("hysteresis", "duhem", 1, seed);
    spec.local = false;
    EXPECT_EQ(makeCase(spec).hidden[0].taxels.size(), 12u);
    EXPECT_EQ(makeCase(spec).hidden[0].surfaces.size(), 2u);
  }
}

// --- nothing hidden -------------------------------------------------------------------------------

// Von Neumann's ratio of block means: 2 where the blocks are independent, near 0 where a slow change connects
// them.
double vonNeumann(const std::vector<double>& means) {
  double mean = 0, squares = 0, steps = 0;
  for (const double value : means) mean += value / static_cast<double>(means.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    squares += std::pow(means[i] - mean, 2);
    if (i > 0) steps += std::pow(means[i] - means[i - 1], 2);
  }
  return steps / squares;
}

// Mean over the taxels of this ratio, for the mean residual of each cycle after a static fit.
double slowness(const BlindCase& made) {
  const HatFit fit = hatFit(made);
  double ratio = 0;
  for (std::size_t taxel = 0; taxel < made.campaign.taxels(); ++taxel) {
    const Trace residual = fit.residual(measured(made, taxel));
    std::vector<double> means(made.campaign.cycle.back() + 1), scans(means.size());
    for (std::size_t scan = 0; scan < residual.size(); ++scan) {
      means[made.campaign.cycle[scan]] += residual[scan];
      scans[made.campaign.cycle[scan]] += 1;
    }
    for (std::size_t i = 0; i < means.size(); ++i) means[i] /= scans[i];
    ratio += vonNeumann(means) / static_cast<double>(made.campaign.taxels());
  }
  return ratio;
}

CaseSpec longCase(const std::string& id, const std::string& form, std::uint64_t seed) {
  CaseSpec spec = smallCase(id, form, 1, seed);
  spec.size = {2, 2};
  spec.protocol = "paper";
  return spec;
}

TEST(NothingHidden, LeavesWhiteCyclesWhateverTheColourOfTheNoise) {
  std::map<std::string, std::vector<double>> ratios;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const BlindCase made = makeCase(longCase("", "", seed));
    ratios[made.noise_colour].push_back(slowness(made));
  }
  EXPECT_EQ(ratios.size(), 3u);
  for (const auto& [colour, values] : ratios) {
    // 40 cycles with a gain that is common to all taxels: one ratio has a deviation of 2 / sqrt(40).
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    EXPECT_NEAR(mean, 2, 3 * 0.32 / std::sqrt(static_cast<double>(values.size()))) << colour;
  }
}

TEST(NothingHidden, IsToldFromDriftByTheSameTest) {
  EXPECT_LT(slowness(makeCase(longCase("drift", "random_walk", 1))), 0.8);
}

TEST(NothingHidden, IsWhatSnrZeroMeans) {
  const BlindCase with = makeCase(smallCase("creep", "log_time", 0));
  EXPECT_TRUE(with.hidden.empty());
  EXPECT_EQ(with.recordings[0].counts, makeCase(smallCase("", "")).recordings[0].counts);
}

// --- cases ----------------------------------------------------------------------------------------

TEST(BlindCases, OfOneSpecAreTheSameToTheLastCount) {
  const CaseSpec spec = smallCase("hysteresis", "", 0.5);
  const BlindCase a = makeCase(spec), b = makeCase(spec);
  for (std::size_t i = 0; i < a.recordings.size(); ++i) {
    EXPECT_EQ(a.recordings[i].counts, b.recordings[i].counts);
    EXPECT_EQ(a.recordings[i].pressure, b.recordings[i].pressure);
  }
  CaseSpec other = spec;
  other.seed = 12;
  EXPECT_NE(a.recordings[0].counts, makeCase(other).recordings[0].counts);
}

TEST(BlindCases, HideTwoEffectsAtTheSizeOfOne) {
  CaseSpec spec = smallCase("hysteresis", "duhem", 1);
  spec.effects.push_back({"drift", "exponential", {}});
  const BlindCase made = makeCase(spec);
  ASSERT_EQ(made.hidden.size(), 2u);
  for (const HiddenTruth& truth : made.hidden) EXPECT_NEAR(truth.snr, 1, 0.15) << truth.id;
}

TEST(BlindCases, KeepMountsTimesAndTemperatureAsARigWould) {
  CaseSpec spec = smallCase("", "");
  spec.protocol = "random_order";
  spec.thermometer = false;
  const BlindCase made = makeCase(spec);
  ASSERT_EQ(made.recordings.size(), 5u);  // two surfaces twice, and the flat one at the end
  EXPECT_EQ(made.recordings.back().conditions[0].name, "flat");
  for (std::size_t i = 0; i < made.recordings.size(); ++i) {
    EXPECT_EQ(made.recordings[i].conditions[0].mount, i + 1);
    EXPECT_TRUE(made.recordings[i].temperature.empty());
    EXPECT_GT(made.recordings[i].start_ns, i > 0 ? made.recordings[i - 1].start_ns : 0);
  }
}

TEST(BlindCases, ThatCannotShowAreRefused) {
  EXPECT_THROW(makeCase(smallCase("repositioning", "tilt")), fsr::settings::InputError);  // mounted once
  EXPECT_THROW(makeCase(smallCase("foreign", "valley_memory_bent")),
               fsr::settings::InputError);  // no inner loops
  EXPECT_THROW(makeCase(smallCase("hysteresys", "")), fsr::settings::InputError);
}

}  // namespace
}  // namespace blind
