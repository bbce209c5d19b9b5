#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "exports/scan_formats.h"
#include "ros/bags/bag_writer.h"
#include "ros/tools/tools.h"
#include "support/pty.h"

// Sanitizers keep memory that was freed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

namespace fsr_ros {
namespace {

constexpr std::size_t kScans = 30000;  // of the short bag; the long one has four times as many

// A line "VmHWM:  1234 kB" of /proc/self/status [bytes].
double statusBytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.compare(0, name.size() + 1, name + ":") == 0)
      return 1024 * std::stod(line.substr(name.size() + 1));
  }
  return NAN;
}

// How much the peak of the resident memory rises while `run` runs in a process of its own [bytes]; NaN = the
// system does not tell.
double peakOf(const std::function<int()>& run) {
  int ends[2];
  if (::pipe(ends) != 0) return NAN;
  const pid_t child = ::fork();
  if (child == 0) {
    ::malloc_trim(0);  // memory that was freed before would be taken without a rise
    std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the peak begins anew
    const double before = statusBytes("VmHWM");
    const double risen = run() == 0 ? statusBytes("VmHWM") - before : NAN;
    const bool told = ::write(ends[1], &risen, sizeof(risen)) == sizeof(risen);
    ::_exit(told ? 0 : 1);
  }
  double risen = NAN;
  if (::read(ends[0], &risen, sizeof(risen)) != sizeof(risen)) risen = NAN;
  ::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  ::close(ends[1]);
  return risen;
}

// Pressure cycles on 16 x 10 taxels at 100 Hz, with noise and a reference at 10 Hz.
void writeLongBag(const std::string& path, std::size_t scans) {
  constexpr std::int64_t kStart = 1700000000000000000, kStep = 10000000;  // [ns]
  const fsr::matrix::Surface flat{"flat", 1, {fsr::matrix::Curvature{}}, {}};
  BagWriter bag(path);
  std::vector<std::uint16_t> counts(160);
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < scans; ++i) {
    const std::int64_t stamp = kStart + static_cast<std::int64_t>(i) * kStep;
    const double pressure = 150e3 * (1 - std::cos(2 * M_PI * static_cast<double>(i) / 2000));
    for (std::size_t t = 0; t < counts.size(); ++t) {
      random = 1664525 * random + 1013904223;
      counts[t] =
          static_cast<std::uint16_t>(0.1 * pressure + static_cast<double>((random >> 8) % 512 + 3 * t));
    }
    bag.addScan(stamp, static_cast<std::uint32_t>(i), {{16, 10}, 65535, counts.data(), counts.size()});
    if (i % 10 == 0) bag.addChamberPressure(stamp, 101325 + pressure, 0);
    if (i % 100 == 0) bag.addSurface(stamp, flat);
  }
  bag.close();
}

using ToolOnBag = std::function<int(const std::string& bag, const std::string& folder)>;

int runTool(int (*tool)(int, const char* const*, std::ostream&), const std::vector<std::string>& words) {
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  std::ostringstream out;
  return tool(static_cast<int>(argv.size()), argv.data(), out);
}

ToolOnBag exportTo(const std::string& format) {
  return [format](const std::string& bag, const std::string& folder) {
    const auto tool = [](int argc, const char* const* argv, std::ostream& out) {
      return exportTool(argc, argv, out);
    };
    return runTool(tool, {"export", bag, "--to", format, "--output", folder + "/" + format});
  };
}

class ToolMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "under a sanitizer";
    for (const auto& [path, scans] : {std::pair{short_, kScans}, {long_, 4 * kScans}}) {
      const auto write = [path = path, scans = scans] {
        writeLongBag(path, scans);
        return 0;
      };
      ASSERT_FALSE(std::isnan(peakOf(write)));  // in a process of its own, which leaves no memory here
    }
    added_ = static_cast<double>(std::filesystem::file_size(long_) - std::filesystem::file_size(short_));
  }

  // By how much the peak rises for each byte that the bag is longer.
  double growth(const ToolOnBag& tool) const {
    const double small = peakOf([&] { return tool(short_, folder_.path()); });
    const double large = peakOf([&] { return tool(long_, folder_.path()); });
    EXPECT_FALSE(std::isnan(small) || std::isnan(large)) << "the tool failed, or /proc does not tell";
    return (large - small) / added_;
  }

  test_support::TemporaryFolder folder_;
  const std::string short_ = folder_.path("short.bag"), long_ = folder_.path("long.bag");
  double added_ = 0;  // [bytes]
};

// rosbag's index is 0.14 bytes for each byte of such a bag. The caches of HDF5 are not yet full here.
TEST_F(ToolMemory, OfScrubAndExportGrowsByRosbagsIndex) {
  const ToolOnBag scrub = [](const std::string& bag, const std::string& folder) {
    return runTool(scrubTool, {"scrub", bag, "--output", folder + "/out.bag"});
  };
  EXPECT_LT(growth(scrub), 0.25);
  EXPECT_LT(growth(exportTo("csv")), 0.25);
  EXPECT_LT(growth(exportTo("hdf5")), 0.4);
}

// The counts are 0.7 bytes for each byte of the bag; they lie in a file. Times, pressures and what is asked
// of each scan stay.
TEST_F(ToolMemory, OfCheckBagGrowsByAFewNumbersForAScan) {
  const ToolOnBag check = [](const std::string& bag, const std::string&) {
    return runTool(checkBagTool, {"check_bag", bag});
  };
  EXPECT_LT(growth(check), 0.25);
}

}  // namespace
}  // namespace fsr_ros
