#pragma once

#ifndef Q_MOC_RUN
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/time.h>
#include <rviz/display.h>

#include <QRect>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/rviz/display_status.h"
#include "ros/rviz/legend_overlay.h"
#include "ros/rviz/sheet_letters.h"
#include "ros/rviz/sheet_visual.h"
#include "ros/rviz/taxel_selection.h"
#include "view/fit_view.h"
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

constexpr std::uint32_t kQueueSize = 10;  ///< of the topics of a display [messages]

/// A property with a choice of names. Its option value is the index in `options`.
rviz::EnumProperty* choice(const char* name, const std::vector<std::string>& options, const char* help,
                           rviz::Property* parent, const char* slot);

/// Moves the orbiting view of rviz so that points of the fixed frame fill the window beside or below a
/// legend, until the user moves the view.
class ViewFitter {
 public:
  /// `legend`: its place in the scene [pixels], empty = none. False where the user has moved the view.
  bool fit(rviz::DisplayContext& context, const std::vector<fsr::view::Vector3>& points, const QRect& legend);

 private:
  std::optional<fsr::view::OrbitCamera> last_;  // the view as it was set
};

/// Base class of displays that draw values on a bent sheet. It handles curvature, mesh, marks, legend, title,
/// position, selection, and a status that says why nothing is shown. A derived class subscribes to its data
/// and interprets them.
///
/// There is no tf message filter: it would hold back messages whose frame is unknown, and the status could
/// not distinguish a wrong frame from a missing message. The newest transform determines the position of the
/// sheet.
class SheetDisplay : public rviz::Display {
  Q_OBJECT

 public:
  ~SheetDisplay() override;

 protected:
  /// `noun`: name of the data, e.g. "map".
  explicit SheetDisplay(const char* noun) : noun_(noun) {}

  /// The constructor of a derived class calls both, and adds its own properties between the two calls.
  void addSource(const std::string& message_type, const char* help);
  void addLook();

  virtual ros::Subscriber listen(const std::string& topic) = 0;
  /// Fills in values, looks and scale from the last message. Throws fsr::InputError if it cannot be shown.
  virtual void paint(SheetPicture& picture) = 0;
  /// Title, scale and lines. The base class adds the name of the surface and the key of the marks.
  virtual fsr::view::Legend legend() const = 0;
  virtual ReadOut readOut(std::size_t taxel) const = 0;
  virtual void sayState() = 0;
  virtual void forget() = 0;

  /// To be called for each message. The picture is drawn at most once in each frame of rviz.
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
  void updateFit();

 private:
  void subscribe();
  void unsubscribe();
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  std::string curvatureTopic() const;
  bool repaint();
  void redraw();
  void makeMesh();
  void placeSheet();
  Ogre::Vector3 offset() const;
  void fitView();
  std::vector<fsr::view::Vector3> outline() const;
  void openStatus();
  double age() const;  // time since the last message [s]; below 0 = no message has come
  Flow flow() const;

  const char* noun_;
  rviz::RosTopicProperty* topic_ = nullptr;
  rviz::RosTopicProperty* curvature_topic_ = nullptr;
  rviz::EnumProperty* shape_ = nullptr;
  rviz::EnumProperty* colours_ = nullptr;
  rviz::IntProperty* fineness_ = nullptr;
  rviz::BoolProperty* marks_ = nullptr;
  rviz::StringProperty* title_ = nullptr;
  rviz::VectorProperty* offset_ = nullptr;
  rviz::VectorProperty* place_ = nullptr;
  rviz::BoolProperty* letters_ = nullptr;
  rviz::BoolProperty* fit_ = nullptr;
  rviz::BoolProperty* legend_ = nullptr;
  rviz::IntProperty* left_ = nullptr;
  rviz::IntProperty* top_ = nullptr;

  ros::Subscriber data_;
  ros::Subscriber curvature_;
  fsr::matrix::Surface surface_;
  std::string surface_error_;
  std::optional<std_msgs::Header> last_;  // header of the last message; none = no message has come
  ros::WallTime last_time_;
  ros::Time last_ros_time_;  // stands still in a paused replay
  bool fresh_ = false;       // something has changed since the last drawing
  bool status_opened_ = false;
  ShownSheet shown_;

  std::unique_ptr<SheetVisual> visual_;
  std::unique_ptr<SheetTitle> title_text_;
  std::unique_ptr<SheetLetters> letter_text_;
  std::unique_ptr<LegendOverlay> overlay_;
  ViewFitter fitter_;
  std::unique_ptr<TaxelSelection> selection_;
};

}  // namespace fsr_rviz
