#ifndef Q_MOC_RUN
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <rviz/properties/float_property.h>
#include <pluginlib/class_list_macros.hpp>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/messages/driver_messages.h"
#include "ros/rviz/sheet_display.h"
#endif

namespace fsr_rviz {

namespace {

constexpr double kUsualFullScale = 4095;  // until the first scan

}  // namespace

/// Shows the counts of a scan on the bent sheet, without calibration, on a scale of counts. The pitch is that
/// of `matrix_info` in the namespace of the scans, or 10 mm until it has come.
class RawCountsDisplay : public SheetDisplay {
  Q_OBJECT

 public:
  RawCountsDisplay() : SheetDisplay("scan") {
    addSource(ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>(), "Raw scans to show.");
    high_ = new rviz::FloatProperty("High (counts)", 0,
                                    "Counts at the bright end; 0 = full scale of the converter.", this,
                                    SLOT(updateStyle()));
    high_->setMin(0);
    addLook();
  }

 protected:
  ros::Subscriber listen(const std::string& topic) override {
    infos_ = update_nh_.subscribe(besideTopic("matrix_info"), kQueueSize, &RawCountsDisplay::onInfo, this);
    return update_nh_.subscribe(topic, kQueueSize, &RawCountsDisplay::onScan, this);
  }

  void paint(SheetPicture& picture) override {
    const fsr::matrix::Layout layout = fsr_ros::layoutOf({last_->rows, last_->columns}, info_);
    const std::size_t taxels = layout.size.taxels();
    if (taxels == 0 || last_->counts.size() != taxels) {
      throw fsr::settings::InputError("a scan of " + fsr::matrix::sizeText(layout.size) + " taxels has " +
                                      std::to_string(last_->counts.size()) +
                                      " counts, but must have one for each taxel");
    }
    full_scale_ = last_->full_scale;
    picture.layout = layout;
    picture.values.assign(last_->counts.begin(), last_->counts.end());
    picture.looks.clear();
    for (const std::uint16_t count : last_->counts) {
      picture.looks.push_back(count >= last_->full_scale ? fsr::view::TaxelLook::kSaturated
                                                         : fsr::view::TaxelLook::kGood);
    }
    picture.scale = scale();
  }

  fsr::view::Legend legend() const override {
    fsr::view::Legend legend;
    legend.scale = scale();
    legend.title = "raw reading";
    legend.lines = {last_ ? "not calibrated" : "waiting for scans"};
    return legend;
  }

  ReadOut readOut(std::size_t taxel) const override {
    // The reading that is drawn: a later scan may have come, or may be invalid.
    return {{"Raw reading", std::to_string(std::lround(picture().values[taxel])) + " of " +
                                std::to_string(full_scale_) + " counts"}};
  }

  void sayState() override {
    say("State", {rviz::StatusProperty::Ok, "raw counts of the converter, not pressure"});
    say("Taxels", taxelStatus(picture().looks));
  }

  void forget() override { last_.reset(); }

 private:
  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& message) {
    last_ = message;
    received(message->header);
  }

  void onInfo(const fsr_pressure_map::MatrixInfoConstPtr& message) { info_ = *message; }

  fsr::view::PressureScale scale() const {
    const double full_scale = last_ && last_->full_scale > 0 ? last_->full_scale : kUsualFullScale;
    fsr::view::PressureScale scale;
    scale.high = high_->getFloat() > 0 ? double(high_->getFloat()) : full_scale;
    scale.unit = fsr::view::PressureUnit::kCount;
    scale.colours = colours();
    return scale;
  }

  rviz::FloatProperty* high_;
  ros::Subscriber infos_;
  fsr_pressure_map::MatrixInfo info_;
  fsr_pressure_map::MatrixFrameConstPtr last_;
  int full_scale_ = 0;  // full scale of the scan that is drawn [counts]
};

}  // namespace fsr_rviz

#include "raw_counts_display.moc"

PLUGINLIB_EXPORT_CLASS(fsr_rviz::RawCountsDisplay, rviz::Display)
