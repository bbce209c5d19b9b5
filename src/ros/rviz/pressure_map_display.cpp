#ifndef Q_MOC_RUN
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/heat_map.h"
#include "ros/rviz/sheet_display.h"
#include "view/legend.h"
#endif

namespace fsr_rviz {

namespace {

constexpr float kMostKilopascal = 10000;
constexpr std::uint32_t kMapQueue = 1000;  // peaks are held through a second without a picture at 1 kHz
constexpr double kUsualRange = 600e3;      // until a calibration tells its own [Pa]
constexpr double kDeviationShare = 0.1;    // of the pressures' range: a good map has a few per cent

// The flags of a taxel in words, e.g. "saturated, tared"; "none" without flags.
std::string flagsText(std::uint16_t flags) {
  using namespace fsr::map::taxel_flag;
  static const std::pair<std::uint16_t, const char*> names[] = {
      {kSaturated, "saturated"},
      {kDead, "dead"},
      {kStuck, "stuck"},
      {kReadingExtrapolated, "reading beyond training"},
      {kCurvatureExtrapolated, "curvature beyond training"},
      {kBetweenClasses, "between curvature classes"},
      {kFilled, "filled from its neighbours"},
      {kMasked, "masked"},
      {kLineFault, "line fault"},
      {kTared, "tared"},
      {kBelowRange, "below range"},
      {kTemperatureExtrapolated, "temperature beyond training"},
      {kHistoryShort, "history not settled"},
  };
  std::string result;
  for (const auto& [flag, words] : names) {
    if ((flags & flag) != 0) result += (result.empty() ? "" : ", ") + std::string(words);
  }
  return result.empty() ? "none" : result;
}

}  // namespace

/// Shows a PressureMap on the bent sheet: gauge pressure or its standard deviation, in kPa or mmHg. The
/// bright end of the colours is, unless it is set, that of the training range in `calibration_info` in the
/// namespace of the maps; of several displays, the highest, so that they have one scale.
class PressureMapDisplay : public SheetDisplay {
  Q_OBJECT

 public:
  PressureMapDisplay() : SheetDisplay("map") {
    addSource(ros::message_traits::datatype<fsr_pressure_map::PressureMap>(), "Pressure maps to show.");
    layer_ = choice("Layer", {"Pressure", "Deviation"}, "Gauge pressure, or its standard deviation.", this,
                    SLOT(updateStyle()));
    unit_ = choice("Unit", fsr::view::pressureUnitNames(), "Unit in the legend and the selection panel.",
                   this, SLOT(updateStyle()));
    low_ = new rviz::FloatProperty("Low (kPa)", 0, "Pressure at the dark end of the colour scale.", this,
                                   SLOT(updateStyle()));
    high_ =
        new rviz::FloatProperty("High (kPa)", 0,
                                "Pressure at the bright end of the colour scale; 0 = the upper end of the "
                                "calibration's range.",
                                this, SLOT(updateStyle()));
    for (rviz::FloatProperty* end : {low_, high_}) {
      end->setMin(-kMostKilopascal);
      end->setMax(kMostKilopascal);
    }
    auto_range_ = new rviz::BoolProperty("Auto Range", false,
                                         "The bright end follows the peak pressure in round steps.", this,
                                         SLOT(updateStyle()));
    hold_ = new rviz::BoolProperty(
        "Peak Hold", false, "The highest pressure of each taxel since this was ticked, or since Reset.", this,
        SLOT(updateHold()));
    addLook();
  }

 protected:
  ros::Subscriber listen(const std::string& topic) override {
    trained_high_ = 0;
    infos_ =
        update_nh_.subscribe(besideTopic("calibration_info"), kQueueSize, &PressureMapDisplay::onInfo, this);
    return update_nh_.subscribe(topic, kMapQueue, &PressureMapDisplay::onMap, this);
  }

  void paint(SheetPicture& picture) override {
    fsr::map::PressureMap map = fsr_ros::toPressureMap(*last_);
    fsr::view::requireShowable(map);
    map_ = hold_->getBool() ? peaks_ : std::move(map);
    followPeaks();
    picture.layout = map_.layout;
    picture.values = fsr::view::layerOf(map_, layer());
    picture.looks.clear();
    for (std::size_t i = 0; i < map_.flags.size(); ++i) {
      picture.looks.push_back(fsr::view::lookOf(map_.pressure[i], map_.flags[i]));
    }
    picture.scale = scale();
  }

  fsr::view::Legend legend() const override {
    fsr::view::Legend legend;
    legend.scale = scale();
    legend.title = fsr::view::name(layer());
    legend.lines = {last_ ? "calibration " + (last_->scheme.empty() ? "none" : last_->scheme)
                          : "waiting for maps"};
    const std::string state = last_ ? stateHeadline(map_.state) : "";
    if (!state.empty()) legend.lines.push_back(state);
    if (hold_->getBool()) legend.lines.push_back("peak hold");
    const std::string settling = fsr::view::settlingWord(unsettledShare());
    if (!settling.empty()) legend.lines.push_back(settling);
    return legend;
  }

  ReadOut readOut(std::size_t taxel) const override {
    const fsr::view::PressureUnit unit = picture().scale.unit;
    return {{"Gauge pressure", fsr::view::limitText(double(map_.pressure[taxel]), unit,
                                                    fsr::map::isLowerLimit(map_.flags[taxel]))},
            {"Standard deviation", fsr::view::pressureText(double(map_.deviation[taxel]), unit)},
            {"Flags", flagsText(map_.flags[taxel])}};
  }

  void sayState() override {
    say("State", stateStatus(map_.state));
    say("Taxels", taxelStatus(picture().looks, map_.flags));
    // No warning: after each start it is so on all taxels.
    if (unsettledShare() > 0) {
      say("History", {rviz::StatusProperty::Ok, fsr::view::settlingText(unsettledShare())});
    } else {
      deleteStatus("History");
    }
  }

  void forget() override {
    last_.reset();
    peaks_ = {};
  }

 private Q_SLOTS:
  void updateHold() {
    peaks_ = {};
    hold();
    updateStyle();
  }

 private:
  void onInfo(const fsr_pressure_map::CalibrationInfoConstPtr& message) {
    if (message->pressure_high == trained_high_ || !std::isfinite(message->pressure_high)) return;
    trained_high_ = message->pressure_high;
    updateStyle();
  }

  double trainedHigh() const {
    double high = 0;
    const rviz::DisplayGroup* group = context_->getRootDisplayGroup();
    for (int i = 0; i < group->numDisplays(); ++i) {
      const auto* other = dynamic_cast<const PressureMapDisplay*>(group->getDisplayAt(i));
      if (other != nullptr && other->isEnabled()) high = std::max(high, other->trained_high_);
    }
    return high > 0 ? high : kUsualRange;
  }

  double highEnd() const {
    if (auto_range_->getBool() && auto_high_ > 0) return auto_high_;
    if (high_->getFloat() != 0) return 1000.0 * double(high_->getFloat());
    return trainedHigh() * (layer() == fsr::view::MapLayer::kDeviation ? kDeviationShare : 1);
  }

  void onMap(const fsr_pressure_map::PressureMapConstPtr& message) {
    last_ = message;
    received(message->header);
    hold();
  }

  fsr::view::MapLayer layer() const {
    return layer_->getOptionInt() == 0 ? fsr::view::MapLayer::kPressure : fsr::view::MapLayer::kDeviation;
  }

  fsr::view::PressureScale scale() const {
    fsr::view::PressureScale scale;
    scale.low = 1000.0 * double(low_->getFloat());
    scale.high = highEnd();
    if (!(scale.high > scale.low)) scale.high = scale.low + 1000;
    scale.unit = fsr::view::pressureUnitOf(unit_->getStdString());
    scale.colours = colours();
    return scale;
  }

  void followPeaks() {
    double highest = NAN;
    for (const float value : fsr::view::layerOf(map_, layer())) highest = std::fmax(highest, double(value));
    auto_high_ = range_.update(last_->header.stamp.toSec(), highest);
  }

  void hold() {
    try {
      if (hold_->getBool() && last_) fsr::map::holdPeaks(fsr_ros::toPressureMap(*last_), peaks_);
    } catch (const fsr::settings::InputError&) {  // paint() says it
    }
  }

  /// Part of the taxels of the last map whose history is not settled; 0 without a map.
  double unsettledShare() const { return last_ ? fsr::map::unsettledShare(map_.pressure, map_.flags) : 0; }

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

}  // namespace fsr_rviz

#include "pressure_map_display.moc"

PLUGINLIB_EXPORT_CLASS(fsr_rviz::PressureMapDisplay, rviz::Display)
