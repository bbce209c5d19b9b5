#include "protocol/board_reader.h"

#include <gtest/gtest.h>

namespace {

using fsr::protocol::BoardGate;
using Verdict = fsr::protocol::BoardGate::Verdict;

constexpr std::int64_t kPatience = 1000, kSettling = 100;

class Gate : public testing::Test {
 protected:
  BoardGate gate_{kPatience, kSettling};
};

TEST_F(Gate, NeverHoldsScansOfABoardThatNeverSentAnIdentity) {
  gate_.doubt();
  EXPECT_EQ(gate_.scan(1), Verdict::kPass);
  EXPECT_FALSE(gate_.gaveUp());
}

TEST_F(Gate, PassesScansOfTheFirstBoardBeforeAndAfterItsIdentity) {
  EXPECT_EQ(gate_.scan(1), Verdict::kPass);
  EXPECT_EQ(gate_.identity("A", 2), BoardGate::Board::kSame);
  EXPECT_EQ(gate_.scan(3), Verdict::kPass);
}

TEST_F(Gate, HoldsScansAfterAReplugUntilTheIdentityOfTheSameBoard) {
  gate_.identity("A", 1);
  gate_.doubt();
  EXPECT_EQ(gate_.scan(2), Verdict::kHold);
  EXPECT_EQ(gate_.scan(500), Verdict::kHold);
  EXPECT_EQ(gate_.identity("A", 600), BoardGate::Board::kSame);
  EXPECT_EQ(gate_.scan(601), Verdict::kPass);
}

TEST_F(Gate, HoldsScansOfAnotherBoardForTheSettlingTime) {
  gate_.identity("A", 1);
  gate_.doubt();
  EXPECT_EQ(gate_.scan(2), Verdict::kHold);
  EXPECT_EQ(gate_.identity("B", 600), BoardGate::Board::kAnother);
  EXPECT_EQ(gate_.scan(699), Verdict::kHold);
  EXPECT_EQ(gate_.scan(700), Verdict::kPass);
  EXPECT_EQ(gate_.identity("B", 800), BoardGate::Board::kSame);
}

TEST_F(Gate, GivesUpOnABoardThatSendsNoIdentityAnyMore) {
  gate_.identity("A", 1);
  gate_.doubt();
  EXPECT_EQ(gate_.scan(10), Verdict::kHold);
  EXPECT_EQ(gate_.scan(10 + kPatience), Verdict::kPass);
  EXPECT_TRUE(gate_.gaveUp());
  EXPECT_FALSE(gate_.gaveUp()) << "reported once";
  EXPECT_EQ(gate_.scan(2000), Verdict::kPass);
}

TEST_F(Gate, EndsTheWaitWhereTimeGoesBackwards) {
  gate_.identity("A", 1);
  gate_.doubt();
  EXPECT_EQ(gate_.scan(5000), Verdict::kHold);
  EXPECT_EQ(gate_.scan(10), Verdict::kPass);
  gate_.identity("B", 9000);
  gate_.identity("C", 9000);
  EXPECT_EQ(gate_.scan(20), Verdict::kPass);
}

}  // namespace
