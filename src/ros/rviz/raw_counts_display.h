#pragma once

#ifndef Q_MOC_RUN
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>

#include "ros/rviz/sheet_display.h"
#endif

namespace fsr_rviz {

/// Shows the counts of a scan on the bent sheet, without calibration, on a scale of counts. The pitch is that
/// of `matrix_info` in the namespace of the scans, or 10 mm until it has come.
class RawCountsDisplay : public SheetDisplay {
  Q_OBJECT

 public:
  RawCountsDisplay();

 protected:
  ros::Subscriber listen(const std::string& topic) override;
  void paint(SheetPicture& picture) override;
  fsr::view::Legend legend() const override;
  ReadOut readOut(std::size_t taxel) const override;
  void sayState() override;
  void forget() override { last_.reset(); }

 private:
  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& message);
  void onInfo(const fsr_pressure_map::MatrixInfoConstPtr& message) { info_ = message; }
  fsr::view::PressureScale scale() const;

  rviz::FloatProperty* high_;
  ros::Subscriber infos_;
  fsr_pressure_map::MatrixInfoConstPtr info_;
  fsr_pressure_map::MatrixFrameConstPtr last_;
  int full_scale_ = 0;  // full scale of the scan that is drawn [counts]
};

}  // namespace fsr_rviz
