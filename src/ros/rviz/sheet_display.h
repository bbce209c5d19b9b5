#pragma once

#ifndef Q_MOC_RUN
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/time.h>
#include <rviz/display.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/rviz/display_status.h"
#include "ros/rviz/legend_overlay.h"
#include "ros/rviz/sheet_title.h"
#include "ros/rviz/sheet_visual.h"
#include "ros/rviz/taxel_selection.h"
#include "view/legend.h"
#endif

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
class StringProperty;
class VectorProperty;
}  // namespace rviz

namespace fsr_rviz {

/// A property with a choice of names; its index is the choice.
rviz::EnumProperty* choice(const char* name, const std::vector<std::string>& options, const char* help,
                           rviz::Property* parent, const char* slot);

/// What pictures on a bent sheet have in common: curvature, mesh, marks, legend, title, place, selection, and
/// a status that says why nothing is shown. A kind of display adds what it listens to and what that means.
///
/// No message filter: that would keep messages back where their frame is unknown, and the status could not
/// tell a wrong frame from a missing map. The sheet stands where the newest transform puts it.
class SheetDisplay : public rviz::Display {
  Q_OBJECT

 public:
  ~SheetDisplay() override;

 protected:
  /// `noun` of what it listens to, e.g. "map".
  explicit SheetDisplay(const char* noun) : noun_(noun) {}

  /// Both once, from the constructor, the own properties between them.
  void addSource(const std::string& message_type, const char* help);
  void addLook();

  virtual ros::Subscriber listen(const std::string& topic) = 0;
  /// Values, looks and scale of what came last. Throws fsr::InputError where it cannot be shown.
  virtual void paint(SheetPicture& picture) = 0;
  /// Title, scale and lines; the base adds the name of the surface, and whether there are marks.
  virtual fsr::view::Legend legend() const = 0;
  virtual ReadOut readOut(std::size_t taxel) const = 0;
  virtual void sayState() = 0;
  virtual void forget() = 0;

  /// To be called with each message. Drawn once a frame, however many come.
  void received(const std_msgs::Header& header);
  void say(const char* name, const StatusLine& line);
  std::string besideTopic(const std::string& name) const;
  fsr::view::ColourMap colours() const;
  const SheetPicture& picture() const { return shown_.picture; }

  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void reset() override;
  void update(float wall_dt, float ros_dt) override;
  void setTopic(const QString& topic, const QString& datatype) override;

 protected Q_SLOTS:
  void updateStyle();

 private Q_SLOTS:
  void updateTopic();
  void updateLegend();
  void updatePlace();

 private:
  void subscribe();
  void unsubscribe();
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  std::string curvatureTopic() const;
  bool repaint();
  void redraw();
  void makeMesh();
  void placeSheet();
  void openStatus();
  double age() const;  // of what came last [s]; below 0 = nothing came

  const char* noun_;
  rviz::RosTopicProperty* topic_ = nullptr;
  rviz::RosTopicProperty* curvature_topic_ = nullptr;
  rviz::EnumProperty* shape_ = nullptr;
  rviz::EnumProperty* colours_ = nullptr;
  rviz::IntProperty* fineness_ = nullptr;
  rviz::BoolProperty* marks_ = nullptr;
  rviz::StringProperty* title_ = nullptr;
  rviz::VectorProperty* offset_ = nullptr;
  rviz::BoolProperty* legend_ = nullptr;
  rviz::IntProperty* left_ = nullptr;
  rviz::IntProperty* top_ = nullptr;

  ros::Subscriber data_;
  ros::Subscriber curvature_;
  fsr::matrix::Surface surface_;
  std::string surface_error_;
  std::optional<std_msgs::Header> last_;  // of what came last; none = nothing came
  ros::WallTime last_time_;
  bool fresh_ = false;  // something changed since it was drawn
  bool status_opened_ = false;
  ShownSheet shown_;

  std::unique_ptr<SheetVisual> visual_;
  std::unique_ptr<SheetTitle> title_text_;
  std::unique_ptr<LegendOverlay> overlay_;
  std::unique_ptr<TaxelSelection> selection_;
};

}  // namespace fsr_rviz
