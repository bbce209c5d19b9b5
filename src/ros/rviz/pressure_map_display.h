#pragma once

#ifndef Q_MOC_RUN
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/PressureMap.h>

#include "fsr_pressure_map/view/heat_map.h"
#include "ros/rviz/sheet_display.h"
#include "view/legend.h"
#endif

namespace fsr_rviz {

/// Shows a PressureMap on the bent sheet: gauge pressure or its standard deviation, in kPa or mmHg. The
/// bright end of the colours is, unless it is set, that of the training range in `calibration_info` in the
/// namespace of the maps; of several displays, the highest, so that they have one scale.
class PressureMapDisplay : public SheetDisplay {
  Q_OBJECT

 public:
  PressureMapDisplay();

 protected:
  ros::Subscriber listen(const std::string& topic) override;
  void paint(SheetPicture& picture) override;
  fsr::view::Legend legend() const override;
  ReadOut readOut(std::size_t taxel) const override;
  void sayState() override;
  void forget() override {
    last_.reset();
    peaks_ = {};
  }

 private Q_SLOTS:
  void updateHold();

 private:
  void onInfo(const fsr_pressure_map::CalibrationInfoConstPtr& message);
  double trainedHigh() const;
  double highEnd() const;
  void onMap(const fsr_pressure_map::PressureMapConstPtr& message);
  fsr::view::MapLayer layer() const;
  fsr::view::PressureScale scale() const;
  void followPeaks();
  void hold();
  /// Part of the taxels of the last map whose history is not settled; 0 without a map.
  double unsettledShare() const;

  rviz::EnumProperty* layer_;
  rviz::EnumProperty* unit_;
  rviz::FloatProperty* low_;
  rviz::FloatProperty* high_;
  rviz::BoolProperty *auto_range_, *hold_;

  ros::Subscriber infos_;
  double trained_high_ = 0;  // of the calibration in use [Pa]; 0 = not known
  fsr_pressure_map::PressureMapConstPtr last_;
  fsr::map::PressureMap map_;    // what is shown
  fsr::map::PressureMap peaks_;  // of each taxel, while they are held
  fsr::view::AutoRange range_;
  double auto_high_ = 0;  // [Pa]
};

/// The flags of a taxel in words, e.g. "saturated, tared"; "none" without flags.
std::string flagsText(std::uint16_t flags);

}  // namespace fsr_rviz
