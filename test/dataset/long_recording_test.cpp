// Recordings whose counts are in a file.

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "dataset/count_readers.h"
#include "dataset/recording_builder.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::dataset {
namespace {

constexpr matrix::MatrixSize kSize{3, 5};
constexpr std::size_t kTaxels = 15;
constexpr std::size_t kScans = 2 * CountFile::kBlock + 700;

std::uint16_t countOf(std::size_t scan, std::size_t taxel) {
  return static_cast<std::uint16_t>((scan * 31 + taxel * 7) % 4000);
}

std::vector<std::uint16_t> scanOf(std::size_t number) {
  std::vector<std::uint16_t> counts;
  for (std::size_t t = 0; t < kTaxels; ++t) counts.push_back(countOf(number, t));
  return counts;
}

// The scans come in `order`, and the last one twice. `most`: bytes in memory.
Recording recorded(const std::vector<std::size_t>& order, std::size_t most) {
  RecordingBuilder builder(most);
  builder.expectScans(order.size(), 1u << 20);
  const auto add = [&](std::size_t number, std::uint32_t sequence) {
    builder.addScan(static_cast<std::int64_t>(number) * 10'000'000, sequence,
                    matrix::view(matrix::Scan{kSize, 4095, scanOf(number)}));
  };
  for (const std::size_t number : order) add(number, static_cast<std::uint32_t>(number));
  add(order.back(), static_cast<std::uint32_t>(order.back()));
  for (std::size_t i = 0; i <= order.size() / 50 + 1; ++i)
    builder.addChamberPressure(static_cast<std::int64_t>(i) * 500'000'000, 101325.0 + 1e3 * double(i % 60));
  return builder.take({});
}

std::vector<std::size_t> inOrder() {
  std::vector<std::size_t> order(kScans);
  for (std::size_t i = 0; i < kScans; ++i) order[i] = i;
  return order;
}

TEST(LongRecording, HasTheScansOfOneInMemory) {
  std::vector<std::size_t> shuffled = inOrder();
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  for (const std::vector<std::size_t>& order : {inOrder(), shuffled}) {
    const Recording memory = recorded(order, 1u << 30), file = recorded(order, 20000);
    ASSERT_EQ(memory.count_file, nullptr);
    ASSERT_NE(file.count_file, nullptr);
    EXPECT_TRUE(file.counts.empty());
    EXPECT_TRUE(countsAreWhole(memory));
    EXPECT_TRUE(countsAreWhole(file));
    EXPECT_EQ(file.time, memory.time);
    EXPECT_EQ(file.pressure, memory.pressure);
    EXPECT_EQ(file.losses.duplicates, 1u);
    EXPECT_TRUE(sameCounts(memory, file));
  }
}

TEST(LongRecording, GivesTheCountsOfATaxelInAnyOrder) {
  const Recording file = recorded(inOrder(), 20000);
  ASSERT_EQ(file.scans(), kScans);
  for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
    TaxelCounts counts(file, taxel);
    for (std::size_t i = 0; i < kScans; ++i) ASSERT_EQ(counts[i], countOf(i, taxel)) << i;
    for (const std::size_t i : {kScans - 1, std::size_t{0}, CountFile::kBlock, CountFile::kBlock - 1})
      EXPECT_EQ(counts[i], countOf(i, taxel));
  }
  ScanCounts scans(file);
  for (const std::size_t i : {kScans - 1, std::size_t{0}, CountFile::kBlock, CountFile::kBlock - 1})
    EXPECT_EQ(std::vector<std::uint16_t>(scans[i], scans[i] + kTaxels), scanOf(i));
}

TEST(LongRecording, IsSharedByItsCopies) {
  const Recording file = recorded(inOrder(), 20000);
  const Recording copy = file;
  EXPECT_EQ(copy.count_file, file.count_file);
  EXPECT_TRUE(sameCounts(copy, file));
}

TEST(LongRecording, NeedsAFolderThatCanBeWritten) {
  const char* const before = std::getenv("TMPDIR");
  const std::string old = before == nullptr ? "" : before;
  setenv("TMPDIR", "/nowhere", 1);
  try {
    recorded(inOrder(), 20000);
    ADD_FAILURE() << "accepted";
  } catch (const settings::InputError& error) {
    EXPECT_TRUE(test_support::holds(std::string(error.what()), {"/nowhere", "TMPDIR"}));
  }
  old.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", old.c_str(), 1);
}

}  // namespace
}  // namespace fsr::dataset
