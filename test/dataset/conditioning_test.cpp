#include "dataset/conditioning.h"

#include <gtest/gtest.h>

#include "support/holds.h"

namespace fsr::dataset {
namespace {

// A recording that begins `hours` after the first one, with one triangular cycle for each peak [kPa].
Recording bag(const std::string& name, double hours, const std::vector<double>& peaks) {
  Recording recording;
  recording.name = name;
  recording.start_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(hours * 3600e9);
  for (const double peak : peaks) {
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0, 0.75, 0.5, 0.25, 0.0}) {
      recording.time.push_back(static_cast<double>(recording.time.size()));
      recording.pressure.push_back(1e3 * peak * share);
    }
  }
  return recording;
}

Conditioning only(const std::vector<Recording>& recordings, const std::vector<bool>& said = {}) {
  const std::vector<Conditioning> all = findConditioning(recordings, said);
  EXPECT_EQ(all.size(), 1u);
  return all.at(0);
}

std::string sentence(const Conditioning& session) {
  return conditioningSentences({session}).at(0);
}

TEST(Conditioning, IsSeenBeforeTheCyclesOfTheSameRecording) {
  const Conditioning seen = only({bag("1_flat.bag", 0, {682, 680, 685, 682, 681, 620, 621, 620, 300})});
  EXPECT_EQ(seen.cycles, 5u);
  EXPECT_TRUE(seen.present());
  EXPECT_DOUBLE_EQ(seen.later, 621e3);
  EXPECT_EQ(sentence(seen), "conditioning: 5 cycles to 685 kPa seen");
}

TEST(Conditioning, IsSeenInARecordingOfItsOwnWhateverTheOrderOfTheBags) {
  EXPECT_EQ(
      only({bag("2_flat.bag", 0.5, {620, 620, 620}), bag("1_conditioning.bag", 0, {682, 682, 682, 682})})
          .cycles,
      4u);
}

TEST(Conditioning, IsNotSeenWhereTheFirstCyclesAreLikeTheOthers) {
  const Conditioning absent = only({bag("a.bag", 0, {620, 620, 620, 620, 620}), bag("b.bag", 1, {620, 620})});
  EXPECT_FALSE(absent.present());
  EXPECT_EQ(absent.cycles, 0u);
  EXPECT_TRUE(test_support::holds(sentence(absent), {"conditioning: not seen", "682 kPa"}));
}

// A program of full cycles and then partial ones looks alike, but its first peaks are far above 110 %.
TEST(Conditioning, IsNotAProgramThatGoesOnWithSmallerCycles) {
  EXPECT_FALSE(only({bag("a.bag", 0, {620, 620, 620, 620, 620, 400, 400, 310})}).present());
  EXPECT_FALSE(only({bag("a.bag", 0, {620, 620, 620, 620, 682, 620, 620})}).present()) << "only before";
}

TEST(Conditioning, SaysThatThreeCyclesAreTooFew) {
  const Conditioning few = only({bag("a.bag", 0, {682, 682, 682, 620, 620})});
  EXPECT_FALSE(few.present());
  EXPECT_TRUE(test_support::holds(sentence(few), {"conditioning: 3 cycles to 682 kPa", "fewer than four"}));
}

TEST(Conditioning, IsBelievedWhereTheOperatorSaysIt) {
  const Conditioning said = only({bag("a.bag", 0, {620, 620}), bag("b.bag", 1, {620, 620})}, {false, true});
  EXPECT_TRUE(said.present());
  EXPECT_EQ(sentence(said), "conditioning: marked by an event");
}

TEST(Conditioning, IsAskedOfEachSession) {
  const std::vector<Conditioning> days = findConditioning(
      {bag("monday.bag", 0, {682, 682, 682, 682, 682, 620, 620}), bag("tuesday.bag", 24, {620, 620, 620})});
  ASSERT_EQ(days.size(), 2u);
  EXPECT_TRUE(days[0].present());
  EXPECT_FALSE(days[1].present());
  const std::vector<std::string> sentences = conditioningSentences(days);
  EXPECT_EQ(sentences[0], "conditioning before monday.bag: 5 cycles to 682 kPa seen");
  EXPECT_EQ(sentences[1].find("conditioning before tuesday.bag: not seen"), 0u) << sentences[1];
}

TEST(Conditioning, IsNotKnownWithoutACycle) {
  const Conditioning unknown = only({bag("a.bag", 0, {})});
  EXPECT_FALSE(unknown.known);
  EXPECT_EQ(sentence(unknown).find("conditioning: not known"), 0u) << sentence(unknown);
  EXPECT_TRUE(findConditioning({}).empty());
}

}  // namespace
}  // namespace fsr::dataset
