#include "dataset/mounts.h"

#include <gtest/gtest.h>

namespace fsr::dataset {
namespace {

// A recording of an hour that begins `hours` after the first one.
Recording bag(const std::string& name, double hours, const std::string& surface, std::uint32_t mount) {
  Recording recording;
  recording.name = name;
  recording.start_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(hours * 3600e9);
  recording.time = {0, 3600};
  recording.conditions = {{surface, mount, {{}}, {}}};
  return recording;
}

TEST(MountRemarks, NameAMountNumberThatWasKeptOverNight) {
  const auto remarks = remarksOnMounts({bag("tuesday.bag", 24, "flat", 1), bag("monday.bag", 0, "flat", 1),
                                        bag("wednesday.bag", 48, "flat", 1)});
  ASSERT_EQ(remarks.size(), 1u) << "one for each surface and mount";
  EXPECT_EQ(remarks[0].recording, 0u);
  EXPECT_EQ(remarks[0].sentence.find("flat, mount 1: tuesday.bag begins 23 h after the end of monday.bag; "),
            0u)
      << remarks[0].sentence;
}

TEST(MountRemarks, AreNotMadeOfOneSessionOrOfOtherMounts) {
  EXPECT_TRUE(remarksOnMounts({bag("a", 0, "flat", 1), bag("b", 3, "flat", 1), bag("c", 24, "flat", 2),
                               bag("d", 48, "cylinder_5cm", 1), bag("e", 72, "", 1), bag("f", 96, "", 1)})
                  .empty());
  EXPECT_TRUE(remarksOnMounts({bag("a", 0, "flat", 0), bag("b", 24, "flat", 0)}).empty()) << "0: not given";
}

}  // namespace
}  // namespace fsr::dataset
