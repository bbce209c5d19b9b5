// The group /shape of the calibration file: everything comes back, earlier files say that they have none, and
// values from which no covariance can be made are refused.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_complaint.h"
#include "support/holds.h"
#include "support/planted_shape.h"
#include "support/small_calibration.h"
#include "support/source_dir.h"

namespace fsr::calibration {
namespace {

class ShapeFile : public testing::Test {
 protected:
  ~ShapeFile() override { std::remove(path_.c_str()); }

  static Calibration calibration() {
    static const ShapeModel model = test_support::learnPlanted({});
    Calibration result = test_support::smallCalibration({4, 5}, {0.0, 20.0}, "A", 4095);
    result.shape = model;
    result.shape.layout = result.layout;
    result.shape.scatter.history = 300;
    return result;
  }
  Calibration reloaded(const Calibration& saved) const {
    saveCalibration(saved, path_);
    return loadCalibration(path_);
  }
  std::string complaintAbout(const std::function<void(ShapeModel&)>& spoil) const {
    return test_support::fileComplaint(calibration(), path_, [&](Calibration& c) { spoil(c.shape); });
  }

  const std::string path_ = testing::TempDir() + "shape_" + std::to_string(::getpid()) + ".h5";
};

TEST_F(ShapeFile, KeepsTheWholeModel) {
  Calibration saved = calibration();
  ShapeModel& model = saved.shape;
  model.used[3] = 0;
  model.direction = {0.5, 0.25, -0.1};
  model.one_direction = false;
  model.gain = {1, 0.9, 0.8, 0.7, 0.6};
  model.zero_share = {0.5, 0.25, 0, 0, 0};
  model.history[7] = 1.5;
  model.mounts = {1, 2, 3, 4, 5};
  model.error_between = {0.5, 1.5, 2.5, std::numeric_limits<double>::quiet_NaN()};
  const ShapeModel read = reloaded(saved).shape;
  EXPECT_TRUE(read.present());
  EXPECT_EQ(read.layout.size, model.layout.size);
  EXPECT_EQ(read.layout.pitch_y, model.layout.pitch_y);
  EXPECT_EQ(read.full_scale, model.full_scale);
  EXPECT_EQ(read.used, model.used);
  EXPECT_EQ(read.scale, model.scale);
  EXPECT_EQ(read.surfaces, model.surfaces);
  EXPECT_EQ(read.curvature, model.curvature);
  EXPECT_EQ(read.mounts, model.mounts);
  EXPECT_EQ(read.gain, model.gain);
  EXPECT_EQ(read.zero_share, model.zero_share);
  EXPECT_EQ(read.rest, model.rest);
  EXPECT_EQ(read.history, model.history);
  EXPECT_EQ(read.direction, model.direction);
  EXPECT_FALSE(read.one_direction);
  ASSERT_EQ(read.error_between.size(), 4u);
  EXPECT_EQ(read.error_between[1], 1.5);
  EXPECT_TRUE(std::isnan(read.error_between[3]));
}

TEST_F(ShapeFile, KeepsScatterAndLawOfBothFamilies) {
  for (const auto family : {FieldFamily::kMatern, FieldFamily::kGaussian}) {
    Calibration saved = calibration();
    saved.shape.scatter.family = family;
    const ShapeModel read = reloaded(saved).shape;
    const MountScatter &own = saved.shape.scatter, &kept = read.scatter;
    EXPECT_EQ(kept.family, own.family);
    EXPECT_EQ(kept.deviation, own.deviation);
    EXPECT_EQ(kept.length, own.length);
    EXPECT_EQ(kept.common, own.common);
    EXPECT_EQ(kept.white, own.white);
    EXPECT_EQ(kept.history, own.history);
    EXPECT_EQ(kept.contrasts, own.contrasts);
    const ShapeLaw &law = saved.shape.law, &kept_law = read.law;
    EXPECT_EQ(kept_law.common, law.common);
    EXPECT_EQ(kept_law.common_length, law.common_length);
    EXPECT_EQ(kept_law.own_offset, law.own_offset);
    EXPECT_EQ(kept_law.own_share, law.own_share);
    EXPECT_EQ(kept_law.own, law.own);
    EXPECT_EQ(kept_law.own_length, law.own_length);
    EXPECT_EQ(kept_law.own_white, law.own_white);
  }
}

TEST_F(ShapeFile, KeepsWhyThereIsNoModel) {
  Calibration saved = calibration();
  saved.shape = {};
  saved.shape.missing = "too few mounts";
  EXPECT_EQ(reloaded(saved).shape.missing, "too few mounts");
  saved.shape = {};
  EXPECT_FALSE(saved.shape.present()) << "a calibration that no training has made";
  EXPECT_EQ(reloaded(saved).shape.missing, "none was learnt");
}

TEST_F(ShapeFile, OfAnEarlierVersionSaysThatItHasNone) {
  for (const char* const name : {"schema_1.h5", "schema_2.h5"}) {
    const std::string path = test_support::sourceDir() + "/test/data/calibrations/" + name;
    EXPECT_TRUE(test_support::holds(loadCalibration(path).shape.missing,
                                    {"the calibration file is of an earlier version"}));
  }
}

TEST_F(ShapeFile, IsRefusedWhereItsModelCannotBeUsed) {
  EXPECT_EQ(complaintAbout([](ShapeModel&) {}), "accepted");
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.scatter.deviation = -3; }),
                                  {"/shape/scatter", "-3", "1e-09 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.scatter.length = 0; }),
                                  {"/shape/scatter", "1e-09 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.scatter.white = 1e200; }),
                                  {"/shape/scatter", "1e+200", "1e-09 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.scatter.contrasts = 0; }),
                                  {"/shape/contrasts", "its /shape/contrasts is 0"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.law.own_length = NAN; }),
                                  {"/shape/law", "1e-09 to 1e+12"}));
  EXPECT_EQ(complaintAbout([](ShapeModel& m) { m.curvature[2] = m.curvature[1]; }),
            "its /shape/curvature does not ascend");
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.curvature[4] = INFINITY; }),
                                  {"/shape/curvature", "-1e+12 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.rest[7] = NAN; }),
                                  {"/shape/rest", "-1e+12 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.history[0] = NAN; }),
                                  {"/shape/history", "-1e+12 to 1e+12"}));
  EXPECT_EQ(complaintAbout([](ShapeModel& m) { m.mounts[0] = 0; }),
            "its /shape/mounts has a surface without a mount");
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.gain[1] = 0; }),
                                  {"/shape/gain", "1e-09 to 1e+12"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.zero_share[1] = -0.5; }),
                                  {"/shape/zero_share", "-0.5", "0 to 1"}));
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.scale[1] = 0; }),
                                  {"/shape/scale", "1e-09 to 1e+12"}));
  EXPECT_EQ(complaintAbout([](ShapeModel& m) { m.used.assign(20, 0); }),
            "its /shape/used has no taxel that takes part");
  EXPECT_TRUE(test_support::holds(complaintAbout([](ShapeModel& m) { m.direction.x = NAN; }),
                                  {"/shape/direction", "-1e+12 to 1e+12"}));
}

TEST_F(ShapeFile, OfOneSurfaceIsRefused) {
  EXPECT_EQ(complaintAbout([](ShapeModel& m) {
              m.surfaces.resize(1);
              m.curvature.resize(1);
              m.mounts.resize(1);
              m.gain.resize(1);
              m.zero_share.resize(1);
              m.error_between.clear();
              m.rest.resize(20);
            }),
            "its /shape/surfaces has fewer than two surfaces");
}

}  // namespace
}  // namespace fsr::calibration
