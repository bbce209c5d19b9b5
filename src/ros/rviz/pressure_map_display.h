#pragma once

#ifndef Q_MOC_RUN
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/time.h>
#include <rviz/display.h>

#include <memory>
#include <optional>

#include "display_status.h"
#include "fsr_pressure_map/view/auto_range.h"
#include "legend_overlay.h"
#include "sheet_visual.h"
#include "taxel_selection.h"
#endif

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
}  // namespace rviz

namespace fsr_rviz {

/// Shows a PressureMap on its bent sheet with a legend of its own. Its status says why nothing is shown.
///
/// No message filter: that would keep maps back where their frame is unknown, and the status could not tell
/// a wrong frame from a missing map. The sheet stands where the newest transform puts it.
class PressureMapDisplay : public rviz::Display {
  Q_OBJECT

 public:
  PressureMapDisplay();
  ~PressureMapDisplay() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void reset() override;
  void update(float wall_dt, float ros_dt) override;
  void setTopic(const QString& topic, const QString& datatype) override;

 private Q_SLOTS:
  void updateTopic();
  void updateStyle();
  void updateLegend();

 private:
  void subscribe();
  void unsubscribe();
  void onMap(const fsr_pressure_map::PressureMapConstPtr& message);
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void makeProperties();
  fsr::HeatMapStyle style() const;
  std::string curvatureTopic() const;
  void redraw();
  void makeMesh();
  void placeSheet();
  void say(const char* name, const StatusLine& line);

  rviz::RosTopicProperty* topic_;
  rviz::RosTopicProperty* curvature_topic_;
  rviz::EnumProperty* shape_;
  rviz::EnumProperty* layer_;
  rviz::EnumProperty* unit_;
  rviz::EnumProperty* colours_;
  rviz::FloatProperty* low_;
  rviz::FloatProperty* high_;
  rviz::BoolProperty* auto_range_;
  rviz::IntProperty* fineness_;
  rviz::BoolProperty* marks_;
  rviz::BoolProperty* legend_;
  rviz::IntProperty* left_;
  rviz::IntProperty* top_;

  ros::Subscriber maps_;
  ros::Subscriber curvature_;
  fsr::Surface surface_;
  std::string surface_error_;
  std::optional<fsr::SheetMesh> mesh_;
  fsr_pressure_map::PressureMapConstPtr last_;
  ros::WallTime last_time_;
  ShownMap shown_;
  fsr::AutoRange range_;
  double auto_high_ = 0;  // [Pa]

  std::unique_ptr<SheetVisual> visual_;
  std::unique_ptr<LegendOverlay> overlay_;
  std::unique_ptr<TaxelSelection> selection_;
};

}  // namespace fsr_rviz
