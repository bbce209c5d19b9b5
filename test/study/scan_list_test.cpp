#include "study/study_data.h"

#include <gtest/gtest.h>

#include <utility>

namespace fsr::study {
namespace {

using Scans = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // recording, number

Scans scansOf(const ScanList& list) {
  Scans scans;
  list.forEach([&](const ScanPlace& scan) { scans.emplace_back(scan.recording, scan.number); });
  return scans;
}

TEST(ScanList, KeepsNeighboursOfOneRecordingAsARun) {
  ScanList list;
  for (const std::uint32_t number : {4u, 5u, 6u, 9u, 10u}) list.add(ScanPlace{0, number});
  list.add(ScanPlace{1, 11});  // follows the last number, but in another recording
  EXPECT_EQ(list.runs().size(), 3u);
  EXPECT_EQ(list.size(), 6u);
  EXPECT_EQ(scansOf(list), (Scans{{0, 4}, {0, 5}, {0, 6}, {0, 9}, {0, 10}, {1, 11}}));
}

TEST(ScanList, PicksScansByTheirPlaceInTheList) {
  ScanList list;
  list.add(ScanRun{0, 4, 7});
  list.add(ScanRun{0, 9, 11});
  list.add(ScanRun{2, 0, 3});
  EXPECT_EQ(scansOf(list.picked({0, 2, 3, 5, 7})), (Scans{{0, 4}, {0, 6}, {0, 9}, {2, 0}, {2, 2}}));
  EXPECT_TRUE(list.picked({}).empty());
  EXPECT_EQ(list.picked({0, 1, 2, 3, 4, 5, 6, 7}), list);
}

}  // namespace
}  // namespace fsr::study
