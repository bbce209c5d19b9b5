#include "pressure_map_display.h"

#include <OgreManualObject.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <pluginlib/class_list_macros.hpp>

#include <cmath>

#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/ros/surface_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/legend.h"

namespace fsr_rviz {

namespace {

constexpr float kMostKilopascal = 10000;
constexpr std::uint32_t kQueueSize = 10;  // [messages]

rviz::EnumProperty* choice(const char* name, const std::vector<std::string>& options, const char* help,
                           rviz::Property* parent, const char* slot) {
  auto* property = new rviz::EnumProperty(name, QString::fromStdString(options.front()), help, parent, slot);
  for (std::size_t i = 0; i < options.size(); ++i) {
    property->addOption(QString::fromStdString(options[i]), static_cast<int>(i));
  }
  return property;
}

}  // namespace

PressureMapDisplay::PressureMapDisplay() {
  makeProperties();
}

void PressureMapDisplay::makeProperties() {
  topic_ = new rviz::RosTopicProperty(
      "Topic", "", QString::fromStdString(ros::message_traits::datatype<fsr_pressure_map::PressureMap>()),
      "Pressure maps to show.", this, SLOT(updateTopic()));
  curvature_topic_ = new rviz::RosTopicProperty(
      "Curvature Topic", "",
      QString::fromStdString(ros::message_traits::datatype<fsr_pressure_map::SurfaceCurvature>()),
      "Shape of the surface under the matrix; empty = `curvature` beside the map's topic.", this,
      SLOT(updateTopic()));
  shape_ = choice("Style", {"Smooth", "Cells"}, "Colours run over between taxels, or a square each.", this,
                  SLOT(updateStyle()));
  layer_ = choice("Layer", {"Pressure", "Deviation"}, "Gauge pressure, or one standard deviation of it.",
                  this, SLOT(updateStyle()));
  unit_ =
      choice("Unit", fsr::pressureUnitNames(), "Of the legend and the read-out.", this, SLOT(updateStyle()));
  colours_ =
      choice("Colour Map", fsr::colourMapNames(), "Dark = low, bright = high.", this, SLOT(updateStyle()));
  low_ = new rviz::FloatProperty("Low (kPa)", 0, "Pressure at the dark end.", this, SLOT(updateStyle()));
  high_ =
      new rviz::FloatProperty("High (kPa)", 600, "Pressure at the bright end.", this, SLOT(updateStyle()));
  low_->setMin(-kMostKilopascal);
  low_->setMax(kMostKilopascal);
  high_->setMin(-kMostKilopascal);
  high_->setMax(kMostKilopascal);
  auto_range_ = new rviz::BoolProperty("Auto Range", false,
                                       "The bright end follows the peaks, on round values, without flicker.",
                                       this, SLOT(updateStyle()));
  fineness_ = new rviz::IntProperty("Fineness", 4, "Squares of the mesh along each side of a taxel.", this,
                                    SLOT(updateStyle()));
  fineness_->setMin(1);
  fineness_->setMax(16);
  marks_ = new rviz::BoolProperty("Marks", true, "On taxels that are not to be believed as they stand.", this,
                                  SLOT(updateStyle()));
  legend_ = new rviz::BoolProperty("Legend", true, "Colour bar with unit and range, over the scene.", this,
                                   SLOT(updateLegend()));
  left_ = new rviz::IntProperty("Left", 10, "Of the legend [pixels].", legend_, SLOT(updateLegend()), this);
  top_ = new rviz::IntProperty("Top", 10, "Of the legend [pixels].", legend_, SLOT(updateLegend()), this);
}

PressureMapDisplay::~PressureMapDisplay() {
  unsubscribe();
  selection_.reset();  // before what it points to
}

void PressureMapDisplay::onInitialize() {
  visual_ = std::make_unique<SheetVisual>(context_->getSceneManager(), scene_node_);
  overlay_ = std::make_unique<LegendOverlay>();
  overlay_->hide();
}

void PressureMapDisplay::onEnable() {
  subscribe();
  updateLegend();
}

void PressureMapDisplay::onDisable() {
  unsubscribe();
  reset();
  overlay_->hide();
}

void PressureMapDisplay::reset() {
  Display::reset();
  last_.reset();
  mesh_.reset();
  selection_.reset();
  shown_ = ShownMap();
  if (visual_) visual_->setVisible(false);
}

void PressureMapDisplay::setTopic(const QString& topic, const QString& /*datatype*/) {
  topic_->setString(topic);
}

void PressureMapDisplay::updateTopic() {
  unsubscribe();
  reset();
  subscribe();
  context_->queueRender();
}

std::string PressureMapDisplay::curvatureTopic() const {
  const std::string own = curvature_topic_->getTopicStd();
  if (!own.empty()) return own;
  const std::string map = topic_->getTopicStd();
  return map.substr(0, map.rfind('/') + 1) + "curvature";
}

void PressureMapDisplay::subscribe() {
  if (!isEnabled() || topic_->getTopicStd().empty()) return;
  surface_ = fsr::Surface();
  surface_error_.clear();
  try {
    maps_ = update_nh_.subscribe(topic_->getTopicStd(), kQueueSize, &PressureMapDisplay::onMap, this);
    curvature_ = update_nh_.subscribe(curvatureTopic(), kQueueSize, &PressureMapDisplay::onCurvature, this);
    deleteStatus("Topic");
  } catch (const ros::Exception& error) {
    setStatus(rviz::StatusProperty::Error, "Topic", error.what());
  }
}

void PressureMapDisplay::unsubscribe() {
  maps_.shutdown();
  curvature_.shutdown();
}

void PressureMapDisplay::onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) {
  surface_error_.clear();
  try {
    fsr::Surface surface = fsr_ros::toSurface(*message);
    if (fsr::sameCondition(surface, surface_)) return;
    surface_ = std::move(surface);
    mesh_.reset();
    if (last_) redraw();
  } catch (const fsr::InputError& error) {
    surface_error_ = error.what();
  }
}

void PressureMapDisplay::onMap(const fsr_pressure_map::PressureMapConstPtr& message) {
  last_ = message;
  last_time_ = ros::WallTime::now();
  redraw();
}

fsr::HeatMapStyle PressureMapDisplay::style() const {
  fsr::HeatMapStyle style;
  style.scale.low = 1000.0 * double(low_->getFloat());
  style.scale.high =
      auto_range_->getBool() && auto_high_ > 0 ? auto_high_ : 1000.0 * double(high_->getFloat());
  if (!(style.scale.high > style.scale.low)) style.scale.high = style.scale.low + 1000;
  style.scale.unit = fsr::pressureUnitOf(unit_->getStdString());
  style.scale.colours = fsr::colourMapOf(colours_->getStdString());
  style.layer = layer_->getOptionInt() == 0 ? fsr::MapLayer::kPressure : fsr::MapLayer::kDeviation;
  style.smooth = shape_->getOptionInt() == 0;
  return style;
}

// A surface that does not fit the matrix is said in the status, and the sheet drawn flat.
void PressureMapDisplay::makeMesh() {
  selection_.reset();
  try {
    mesh_.emplace(shown_.map.layout, surface_, fineness_->getInt());
  } catch (const fsr::InputError& error) {
    surface_error_ = error.what();
    mesh_.emplace(shown_.map.layout, fsr::Surface(), fineness_->getInt());
  }
  shown_.mesh = &*mesh_;
}

void PressureMapDisplay::redraw() {
  try {
    fsr::PressureMap map = fsr_ros::toPressureMap(*last_);
    fsr::requireShowable(map);
    const fsr::Layout& layout = map.layout;
    const fsr::Layout& old = shown_.map.layout;
    if (layout.size != old.size || layout.pitch_x != old.pitch_x || layout.pitch_y != old.pitch_y)
      mesh_.reset();
    shown_.map = std::move(map);
  } catch (const fsr::InputError& error) {
    setStatus(rviz::StatusProperty::Error, "State", error.what());
    return;
  }
  if (!mesh_) makeMesh();
  double highest = NAN;
  for (const float value : fsr::layerOf(shown_.map, style().layer))
    highest = std::fmax(highest, double(value));
  auto_high_ = range_.update(last_->header.stamp.toSec(), highest);
  shown_.style = style();
  shown_.marks = marks_->getBool();
  visual_->show(shown_.map, *mesh_, shown_.style, shown_.marks);
  if (!selection_) {
    selection_ = std::make_unique<TaxelSelection>(context_, *visual_, shown_);
    selection_->addTrackedObject(visual_->sheet());
  }
  placeSheet();
  say("State", stateStatus(shown_.map.state));
  say("Taxels", taxelStatus(shown_.map));
  updateLegend();
}

void PressureMapDisplay::placeSheet() {
  const std::string& frame = last_->header.frame_id;
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const bool known = context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
  visual_->setVisible(known);
  if (!known) {
    setStatus(rviz::StatusProperty::Error, "Transform",
              QString("no transform from the map's frame [%1] to the fixed frame [%2]")
                  .arg(QString::fromStdString(frame), fixed_frame_));
    return;
  }
  setStatus(rviz::StatusProperty::Ok, "Transform", QString::fromStdString(frame));
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
}

void PressureMapDisplay::updateStyle() {
  if (!last_) return updateLegend();
  mesh_.reset();  // fineness may be another
  redraw();
  context_->queueRender();
}

void PressureMapDisplay::updateLegend() {
  if (!overlay_) return;
  if (!isEnabled() || !legend_->getBool()) return overlay_->hide();
  fsr::Legend legend;
  const fsr::HeatMapStyle now = style();
  legend.scale = now.scale;
  legend.layer = now.layer;
  legend.marks = marks_->getBool();
  legend.lines = {last_ ? "calibration " + (last_->scheme.empty() ? "none" : last_->scheme) : "no map yet",
                  surface_.name.empty() ? "surface not named" : "surface " + surface_.name};
  overlay_->moveTo(left_->getInt(), top_->getInt());
  overlay_->show(fsr::drawLegend(legend));
}

void PressureMapDisplay::say(const char* name, const StatusLine& line) {
  setStatus(line.level, name, QString::fromStdString(line.text));
}

void PressureMapDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  const double age = last_ ? (ros::WallTime::now() - last_time_).toSec() : -1;
  say("Map", mapStatus(age, topic_->getTopicStd()));
  say("Curvature", curvatureStatus(surface_, surface_error_, curvatureTopic()));
  if (last_) placeSheet();
}

}  // namespace fsr_rviz

PLUGINLIB_EXPORT_CLASS(fsr_rviz::PressureMapDisplay, rviz::Display)
