#include "session/sheet_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace {

using fsr::session::LoadingSignature;
using fsr::session::MountReading;
using fsr::session::RestCounts;
using fsr::session::Signature;
using fsr::session::SurfaceWatch;

constexpr std::size_t kRows = 3, kColumns = 4, kTaxels = kRows * kColumns;

/// Mounts of a sheet whose taxels differ. A surface adds counts to each; each mount adds its own to all.
class Mounts {
 public:
  explicit Mounts(unsigned seed, double scatter) : random_(seed), scatter_(scatter) {}
  MountReading on(const std::string& surface, double counts) {
    const double mount = scatter_ * normal_(random_);
    MountReading reading{++number_, surface, kColumns, Signature(LoadingSignature::kLevels * kTaxels)};
    for (std::size_t i = 0; i < reading.signature.size(); ++i) {
      const double taxel = 10.0 * static_cast<double>((i % kTaxels) * (i % kTaxels));
      reading.signature[i] = 500 + taxel + counts + mount + 0.1 * scatter_ * normal_(random_);
    }
    return reading;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double scatter_;
  unsigned number_ = 0;
};

// The worst case of the statement on errors: all taxels of a mount differ by the same.
TEST(SurfaceWatch, SaysSomethingFalseInFewerSessionsThanItStates) {
  constexpr unsigned kSessions = 400;
  unsigned wrong = 0;
  for (unsigned session = 0; session < kSessions; ++session) {
    Mounts mounts(session, 20);
    SurfaceWatch watch(3);
    bool said = false;
    for (unsigned round = 0; round < 4; ++round) {
      for (const char* surface : {"flat", "bent"}) {
        const MountReading now = mounts.on(surface, 0);  // two surfaces that read the same
        said = said || watch.compare(now);
        watch.keep(now);
      }
    }
    wrong += said ? 1 : 0;
  }
  EXPECT_LE(wrong, 2 * SurfaceWatch::kFalse * kSessions);
}

TEST(SurfaceWatch, NamesNothingWhileASurfaceHasOneMount) {
  Mounts mounts(1, 0.1);
  SurfaceWatch watch(1);
  for (const double counts : {0., 300., 600.}) {
    const MountReading now = mounts.on("surface_" + std::to_string(counts), counts);
    EXPECT_FALSE(watch.compare(now));
    watch.keep(now);
  }
}

TEST(SurfaceWatch, NamesTheSurfaceThatTheSheetReadsLike) {
  Mounts mounts(1, 1);
  SurfaceWatch watch(3);
  for (unsigned round = 0; round < 3; ++round) {
    watch.keep(mounts.on("flat", 0));
    watch.keep(mounts.on("bent", 300));
  }
  EXPECT_FALSE(watch.compare(mounts.on("flat", 0)));
  const auto doubt = watch.compare(mounts.on("flat", 300));
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->mount, 8u);
  EXPECT_NE(doubt->sentence.find("mount 8 reads like bent"), std::string::npos) << doubt->sentence;
  EXPECT_EQ(doubt->against, (std::vector<unsigned>{1, 2, 3, 4, 5, 6}));
  EXPECT_LT(doubt->chance, SurfaceWatch::kFalse);
}

TEST(SurfaceWatch, NamesASheetThatIsTurned) {
  Mounts mounts(1, 1);
  SurfaceWatch watch(3);
  for (unsigned round = 0; round < 4; ++round) {
    watch.keep(mounts.on("flat", 0));
    watch.keep(mounts.on("bent", 300));
  }
  MountReading now = mounts.on("flat", 0);
  for (std::size_t i = 0; i < now.signature.size(); i += kTaxels) {
    const auto first = now.signature.begin() + static_cast<std::ptrdiff_t>(i);
    std::reverse(first, first + kTaxels);
  }
  const auto doubt = watch.compare(now);
  ASSERT_TRUE(doubt);
  EXPECT_NE(doubt->sentence.find("with the sheet turned by half a turn"), std::string::npos)
      << doubt->sentence;
}

TEST(LoadingSignature, DoesNotDependOnThePace) {
  const auto signatureAt = [](double step) {
    LoadingSignature signature;
    signature.begin(400e3);
    std::uint16_t counts[kTaxels];
    for (double pressure = 0; pressure <= 400e3; pressure += step) {
      for (std::size_t t = 0; t < kTaxels; ++t)
        counts[t] = static_cast<std::uint16_t>(pressure / 200 + static_cast<double>(t));
      signature.take(pressure, counts, kTaxels);
    }
    return signature.result();
  };
  const Signature slow = signatureAt(500), fast = signatureAt(7000);
  ASSERT_EQ(slow.size(), LoadingSignature::kLevels * kTaxels);
  EXPECT_NEAR(slow[0], 0.2 * 400e3 / 200, 1);
  for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(slow[i], fast[i], 1);
  EXPECT_TRUE(signatureAt(200e3).empty());
}

TEST(RestCounts, MeasuresTheNoiseThatABoardCutsOffAtZero) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 3);
  for (const double level : {0., 100.}) {
    RestCounts rest;
    EXPECT_EQ(rest.noise(), 0);
    std::uint16_t counts[kTaxels];
    for (int scan = 0; scan < 2000; ++scan) {
      for (std::uint16_t& one : counts)
        one = static_cast<std::uint16_t>(std::max(0.0, std::round(level + noise(random))));
      rest.take(counts, kTaxels);
    }
    EXPECT_GT(rest.noise(), 0.95 * 3);
    EXPECT_LT(rest.noise(), 1.05 * 3 / 0.58);
    EXPECT_EQ(rest.answering(counts, kTaxels), 0u);
    counts[2] = static_cast<std::uint16_t>(level + 40);
    EXPECT_EQ(rest.answering(counts, kTaxels), 1u);
  }
}

}  // namespace
