// A hash is not a signature: a file with a correct hash may contain anything. Content that does not fit is
// refused with a sentence; content that fits gives no pressure without meaning.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_complaint.h"
#include "support/holds.h"
#include "support/small_calibration.h"

namespace fsr::calibration {
namespace {

constexpr matrix::MatrixSize kFourTaxels{2, 2};

class HostileFile : public testing::Test {
 protected:
  ~HostileFile() override { std::remove(path_.c_str()); }

  std::string complaint() const { return test_support::fileComplaint(path_); }
  std::string complaintAbout(const std::function<void(Calibration&)>& spoil) const {
    return test_support::fileComplaint(sound(), path_, spoil);
  }
  static Calibration sound() {
    Calibration calibration = test_support::smallCalibration(kFourTaxels, {0.0, 10.0}, "A", 1023);
    calibration.tables.scheme = compensation::Scheme::kCurvatureMap;
    calibration.tables.rule.blend = compensation::BlendRule::kInterpolate;
    return calibration;
  }

  // Changes `f`, the file, with Python and corrects the hash; false if h5py is not installed.
  bool change(const std::string& statements) const {
    saveCalibration(sound(), path_);
    std::ofstream(path_ + ".py") << "import h5py, hashlib, numpy, sys\n"
                                 << "with h5py.File(sys.argv[1], 'r+') as f:\n    " << statements
                                 << "\ncontent = open(sys.argv[1], 'rb').read()\n"
                                 << "digest = hashlib.sha256(content[512:]).hexdigest().encode()\n"
                                 << "open(sys.argv[1], 'wb').write(content[:45] + digest + content[109:])\n";
    const int status = std::system(("/usr/bin/python3 " + path_ + ".py " + path_).c_str());
    std::remove((path_ + ".py").c_str());
    return status == 0;
  }

  const std::string path_ = testing::TempDir() + "hostile_" + std::to_string(::getpid()) + ".h5";
};

TEST_F(HostileFile, ContentThatDoesNotFitIsRefused) {
  EXPECT_EQ(complaintAbout([](Calibration&) {}), "accepted");
  EXPECT_EQ(complaintAbout([](Calibration& c) {
              c.tables.classes[1].curvature = {1, 2, 3};
            }),
            "its /tables/curvature does not fit its surfaces and the matrix");
  EXPECT_EQ(complaintAbout([](Calibration& c) { c.tables.classes[1].curvature = {NAN}; }),
            "its /tables/curvature is not finite");
  EXPECT_TRUE(test_support::holds(complaintAbout([](Calibration& c) {
                                    c.masked = {1, 0, 0};
                                  }),
                                  {"/layout/masked", "3 values", "4 taxels"}));
  EXPECT_EQ(complaintAbout([](Calibration& c) {
              c.tables.rule.law = {{0, 9, 5}, {1, 1, 1}, {0, 0, 0}};
            }),
            "its /rule/law has knots that do not ascend");
  EXPECT_EQ(complaintAbout([](Calibration& c) {
              c.tables.rule.unseen = {{0, NAN}, {1, 1}};
            }),
            "its /rule/unseen has knots that do not ascend");
  EXPECT_EQ(complaintAbout([](Calibration& c) {
              compensation::TrainingStatistics statistics;
              statistics.classes = c.tables.classes;
              statistics.taxels = ~std::size_t{0};
              statistics.sections = 1;
              c.statistics = std::make_shared<const compensation::TrainingStatistics>(statistics);
            }),
            "its /statistics/taxels or sections do not fit the matrix");
}

TEST_F(HostileFile, AnOversizedShapeAllocatesNothing) {
  if (!change(
          "del f['layout/masked']; f.create_dataset('layout/masked', (2**40, 2**20), 'u1', chunks=(1, 1))"))
    GTEST_SKIP() << "python3-h5py is not installed";
  EXPECT_EQ(complaint(), "its /layout/masked claims more values than the file has bytes");
}

TEST_F(HostileFile, AListInsteadOfATextIsRefused) {
  if (!change("f.attrs['model'] = numpy.array([b'grnn'] * 1000)"))
    GTEST_SKIP() << "python3-h5py is not installed";
  EXPECT_TRUE(test_support::holds(complaint(), {"HDF5", "its HDF5 part holds / model"}));
}

// Flags of taxel 0 between the classes if its pressure is NaN; 0 if it is a number.
std::uint16_t flagsOf(const Calibration& calibration) {
  Calibrator calibrator(calibration.tables, calibration.layout);
  calibrator.setSurface({"between", 1, {{5, 0, 0}}, {}}, 0);
  const std::vector<std::uint16_t> counts(kFourTaxels.taxels(), 500);
  map::PressureMap map;
  calibrator.calibrate({kFourTaxels, 1023, counts.data(), counts.size()}, 0, map);
  EXPECT_FALSE(std::isinf(map.pressure[0]));
  return std::isnan(map.pressure[0]) ? map.flags[0] : std::uint16_t{0};
}

TEST_F(HostileFile, ATableThatIsNotAPressureIsMasked) {
  EXPECT_EQ(flagsOf(sound()), 0);
  Calibration steep = sound();
  steep.tables.rule.law = {{0, 5, 10}, {1, 1e300, 1}, {0, 0, 0}};
  EXPECT_TRUE(flagsOf(steep) & map::taxel_flag::kMasked);
  Calibration halved = sound();
  for (std::vector<float>* column : {&halved.tables.tables[1].pressure, &halved.tables.tables[1].deviation}) {
    column->assign(column->size(), NAN);  // of taxel 0, bent
  }
  EXPECT_TRUE(flagsOf(halved) & map::taxel_flag::kMasked);
}

TEST_F(HostileFile, PressuresOutOfRangeAreRefused) {
  Calibration huge = sound();
  huge.tables.tables[2].pressure[7] = 3e38F;
  EXPECT_THROW(Calibrator(huge.tables, huge.layout), settings::InputError);
}

}  // namespace
}  // namespace fsr::calibration
