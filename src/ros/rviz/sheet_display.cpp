#include "ros/rviz/sheet_display.h"

#include <OgreCamera.h>
#include <OgreManualObject.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/properties/vector_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/messages/surface_message.h"

namespace fsr_rviz {

namespace {

using fsr::view::OrbitCamera;
using fsr::view::Vector3;

constexpr int kMargin = 15;     // between the sheet and what is beside it [pixels]
constexpr double kSame = 1e-4;  // relative to the distance: properties keep single precision

bool same(const OrbitCamera& a, const OrbitCamera& b) {
  const double way = std::hypot(a.focus.x - b.focus.x, a.focus.y - b.focus.y, a.focus.z - b.focus.z);
  return way + std::abs(a.distance - b.distance) <= kSame * a.distance && std::abs(a.yaw - b.yaw) <= kSame &&
         std::abs(a.pitch - b.pitch) <= kSame;
}

// The view that is nearest to the points, beside or below the legend.
std::optional<OrbitCamera> nearest(const OrbitCamera& camera, const std::vector<Vector3>& points,
                                   const fsr::view::Lens& lens, const QSize& size, const QRect& legend) {
  const QRect whole = QRect(QPoint(0, 0), size).adjusted(kMargin, kMargin, -kMargin, -kMargin);
  QRect beside = whole, below = whole;
  if (!legend.isEmpty()) {
    beside.setLeft(legend.right() + kMargin);
    below.setTop(legend.bottom() + kMargin);
  }
  std::optional<OrbitCamera> best;
  for (const QRect& part : {beside, below}) {
    const fsr::view::Window window{
        2.0 * part.left() / size.width() - 1, 2.0 * (part.left() + part.width()) / size.width() - 1,
        1 - 2.0 * (part.top() + part.height()) / size.height(), 1 - 2.0 * part.top() / size.height()};
    const auto view = fitView(camera, points, lens, window);
    if (view && (!best || view->distance < best->distance)) best = view;
  }
  return best;
}

// Where the frame of the view's focus is in the fixed frame.
std::optional<Ogre::Vector3> originOf(rviz::DisplayContext& context, rviz::ViewController& view) {
  const std::string frame = view.subProp("Target Frame")->getValue().toString().toStdString();
  Ogre::Vector3 origin = Ogre::Vector3::ZERO;
  Ogre::Quaternion turn;
  if (frame == "<Fixed Frame>" || context.getFrameManager()->getTransform(frame, ros::Time(), origin, turn)) {
    return origin;
  }
  return std::nullopt;
}

}  // namespace

bool ViewFitter::fit(rviz::DisplayContext& context, const std::vector<Vector3>& points, const QRect& legend) {
  rviz::ViewController* view = context.getViewManager()->getCurrent();
  const rviz::RenderPanel* panel = context.getViewManager()->getRenderPanel();
  if (view == nullptr || panel == nullptr || panel->width() <= 0 || panel->height() <= 0) return true;
  auto* focus = dynamic_cast<rviz::VectorProperty*>(view->subProp("Focal Point"));
  const auto origin = originOf(context, *view);
  if (focus == nullptr || view->getClassId() != "rviz/Orbit" || !origin) return true;
  const Ogre::Vector3 at = focus->getVector() + *origin;
  const OrbitCamera now{{double(at.x), double(at.y), double(at.z)},
                        view->subProp("Distance")->getValue().toDouble(),
                        view->subProp("Yaw")->getValue().toDouble(),
                        view->subProp("Pitch")->getValue().toDouble()};
  if (last_ && !same(now, *last_)) return false;
  const double high = std::tan(0.5 * double(view->getCamera()->getFOVy().valueRadians()));
  last_ = nearest(now, points, {high * panel->width() / panel->height(), high}, panel->size(), legend);
  if (!last_ || same(now, *last_)) return true;
  view->subProp("Distance")->setValue(last_->distance);
  focus->setVector(toOgre(last_->focus) - *origin);
  return true;
}

namespace {

// A title with the mean of all taxels that have a value, e.g. "flat only: mean 329 kPa"; empty without one.
std::string titleLine(const std::string& title, const SheetPicture& picture) {
  if (title.empty()) return title;
  if (picture.stopped) return title + ": stopped";
  double sum = 0, count = 0;
  for (const float value : picture.values) {
    if (std::isnan(value)) continue;
    sum += double(value);
    ++count;
  }
  return title + ": mean " + fsr::view::pressureText(sum / count, picture.scale.unit);
}

}  // namespace

rviz::EnumProperty* choice(const char* name, const std::vector<std::string>& options, const char* help,
                           rviz::Property* parent, const char* slot) {
  auto* property = new rviz::EnumProperty(name, QString::fromStdString(options.front()), help, parent, slot);
  for (std::size_t i = 0; i < options.size(); ++i) {
    property->addOption(QString::fromStdString(options[i]), static_cast<int>(i));
  }
  return property;
}

void SheetDisplay::addSource(const std::string& message_type, const char* help) {
  topic_ = new rviz::RosTopicProperty("Topic", "", QString::fromStdString(message_type), help, this,
                                      SLOT(updateTopic()));
  curvature_topic_ = new rviz::RosTopicProperty(
      "Curvature Topic", "",
      QString::fromStdString(ros::message_traits::datatype<fsr_pressure_map::SurfaceCurvature>()),
      "Shape of the surface under the matrix; empty = `curvature` in the namespace of the other topic.", this,
      SLOT(updateTopic()));
}

void SheetDisplay::addLook() {
  shape_ = choice("Style", {"Smooth", "Cells"},
                  "Smooth: colours are interpolated between taxels. Cells: one square for each taxel.", this,
                  SLOT(updateStyle()));
  colours_ = choice("Colour Map", fsr::view::colourMapNames(), "Dark = low, bright = high.", this,
                    SLOT(updateStyle()));
  fineness_ = new rviz::IntProperty("Fineness", 4, "Squares of the mesh along each side of a taxel.", this,
                                    SLOT(updateStyle()));
  fineness_->setMin(1);
  fineness_->setMax(16);
  marks_ = new rviz::BoolProperty("Marks", true, "Marks on taxels with an unreliable reading.", this,
                                  SLOT(updateStyle()));
  title_ =
      new rviz::StringProperty("Title", "", "Text beside the first row, followed by the mean of all taxels.",
                               this, SLOT(updateStyle()));
  offset_ = new rviz::VectorProperty("Offset", Ogre::Vector3::ZERO,
                                     "Moves the picture in its own frame [m], to show several side by side.",
                                     this, SLOT(updatePlace()));
  place_ = new rviz::VectorProperty("Place", Ogre::Vector3::ZERO,
                                    "The same in widths and heights of the sheet, whatever its size.", this,
                                    SLOT(updatePlace()));
  letters_ = new rviz::BoolProperty("Letters", true,
                                    "The letters of the axes, \"row 0\" and \"column 0\" beside the sheet.",
                                    this, SLOT(updatePlace()));
  fit_ =
      new rviz::BoolProperty("Fit View", false,
                             "Moves an orbiting view so that it shows all sheets beside or below the legend, "
                             "until you move the view.",
                             this, SLOT(updateFit()));
  legend_ = new rviz::BoolProperty("Legend", true, "Colour bar with unit and range, over the scene.", this,
                                   SLOT(updateLegend()));
  left_ = new rviz::IntProperty("Left", 10, "Position of the legend [pixels].", legend_, SLOT(updateLegend()),
                                this);
  top_ = new rviz::IntProperty("Top", 10, "Position of the legend [pixels].", legend_, SLOT(updateLegend()),
                               this);
}

SheetDisplay::~SheetDisplay() {
  unsubscribe();
  selection_.reset();  // before the objects that it points to
}

void SheetDisplay::onInitialize() {
  visual_ = std::make_unique<SheetVisual>(context_->getSceneManager(), scene_node_);
  title_text_ = std::make_unique<SheetTitle>(context_->getSceneManager(), scene_node_);
  letter_text_ = std::make_unique<SheetLetters>(context_->getSceneManager(), scene_node_);
  overlay_ = std::make_unique<LegendOverlay>();
  overlay_->hide();
}

void SheetDisplay::onEnable() {
  subscribe();
  updateLegend();
}

void SheetDisplay::onDisable() {
  unsubscribe();
  reset();
  overlay_->hide();
}

void SheetDisplay::reset() {
  Display::reset();
  last_.reset();
  fresh_ = false;
  forget();
  selection_.reset();
  shown_ = ShownSheet();
  if (visual_) visual_->setVisible(false);
  if (title_text_) title_text_->hide();
  if (letter_text_) letter_text_->hide();
}

void SheetDisplay::setTopic(const QString& topic, const QString& /*datatype*/) {
  topic_->setString(topic);
}

void SheetDisplay::updateTopic() {
  unsubscribe();
  reset();
  subscribe();
  context_->queueRender();
}

std::string SheetDisplay::besideTopic(const std::string& name) const {
  const std::string topic = topic_->getTopicStd();
  return topic.substr(0, topic.rfind('/') + 1) + name;
}

std::string SheetDisplay::curvatureTopic() const {
  const std::string own = curvature_topic_->getTopicStd();
  return own.empty() ? besideTopic("curvature") : own;
}

void SheetDisplay::subscribe() {
  if (!isEnabled() || topic_->getTopicStd().empty()) return;
  surface_ = fsr::matrix::Surface();
  surface_error_.clear();
  try {
    data_ = listen(topic_->getTopicStd());
    curvature_ = update_nh_.subscribe(curvatureTopic(), kQueueSize, &SheetDisplay::onCurvature, this);
    deleteStatus("Topic");
  } catch (const ros::Exception& error) {
    setStatus(rviz::StatusProperty::Error, "Topic", error.what());
  }
}

void SheetDisplay::unsubscribe() {
  data_.shutdown();
  curvature_.shutdown();
}

void SheetDisplay::onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) {
  surface_error_.clear();
  try {
    fsr::matrix::Surface surface = fsr_ros::toSurface(*message);
    if (fsr::matrix::sameCondition(surface, surface_)) return;
    surface_ = std::move(surface);
    shown_.mesh.reset();
    fresh_ = last_.has_value();
  } catch (const fsr::settings::InputError& error) {
    surface_error_ = error.what();
  }
}

void SheetDisplay::received(const std_msgs::Header& header) {
  last_ = header;
  last_time_ = ros::WallTime::now();
  last_ros_time_ = ros::Time::now();
  fresh_ = true;
}

fsr::view::ColourMap SheetDisplay::colours() const {
  return fsr::view::colourMapOf(colours_->getStdString());
}

// If the surface does not fit the matrix, the status reports it and the sheet is drawn flat.
void SheetDisplay::makeMesh() {
  selection_.reset();
  const fsr::matrix::Layout& layout = shown_.picture.layout;
  try {
    shown_.mesh.emplace(layout, surface_, fineness_->getInt());
  } catch (const fsr::settings::InputError& error) {
    surface_error_ = error.what();
    shown_.mesh.emplace(layout, fsr::matrix::Surface(), fineness_->getInt());
  }
}

bool SheetDisplay::repaint() {
  const fsr::matrix::Layout old = shown_.picture.layout;
  try {
    paint(shown_.picture);
  } catch (const fsr::settings::InputError& error) {
    setStatus(rviz::StatusProperty::Error, "State", error.what());
    return false;
  }
  const fsr::matrix::Layout& now = shown_.picture.layout;
  if (now.size != old.size || now.pitch_x != old.pitch_x || now.pitch_y != old.pitch_y) shown_.mesh.reset();
  shown_.picture.smooth = shape_->getOptionInt() == 0;
  shown_.picture.marks = marks_->getBool();
  return true;
}

void SheetDisplay::redraw() {
  fresh_ = false;
  shown_.picture.stopped = flow() == Flow::kStopped;
  const bool painted = repaint();
  if (!painted && !shown_.mesh) return;
  if (!shown_.mesh) makeMesh();
  visual_->show(shown_.picture, *shown_.mesh);
  if (!selection_) {
    selection_ = std::make_unique<TaxelSelection>(context_, *visual_, shown_, [this](std::size_t taxel) {
      ReadOut values = readOut(taxel);
      if (shown_.picture.stopped) values.insert(values.begin(), {"STOPPED", "the last values"});
      return values;
    });
    selection_->addTrackedObject(visual_->sheet());
  }
  if (painted) sayState();
}

Ogre::Vector3 SheetDisplay::offset() const {
  const fsr::matrix::Layout& layout = shown_.picture.layout;
  const Ogre::Vector3 sheet(static_cast<float>(layout.pitch_x * layout.size.columns),
                            static_cast<float>(layout.pitch_y * layout.size.rows), 0);
  return offset_->getVector() + place_->getVector() * sheet;
}

void SheetDisplay::placeSheet() {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const bool known =
      context_->getFrameManager()->getTransform(last_->frame_id, ros::Time(), position, orientation);
  const bool shown = known && shown_.mesh;
  visual_->setVisible(shown);
  if (!shown) title_text_->hide();
  if (!shown || !letters_->getBool()) letter_text_->hide();
  if (!known) {
    setStatus(rviz::StatusProperty::Error, "Transform",
              QString("no transform from the %1's frame [%2] to the fixed frame [%3]")
                  .arg(noun_, QString::fromStdString(last_->frame_id), fixed_frame_));
    return;
  }
  setStatus(rviz::StatusProperty::Ok, "Transform", QString::fromStdString(last_->frame_id));
  if (shown) title_text_->show(titleLine(title_->getStdString(), shown_.picture), shown_.picture.layout);
  if (shown && letters_->getBool()) letter_text_->show(*shown_.mesh);
  scene_node_->setPosition(position + orientation * offset());
  scene_node_->setOrientation(orientation);
}

void SheetDisplay::updateStyle() {
  if (!last_) return updateLegend();
  shown_.mesh.reset();  // the fineness may have changed
  fresh_ = true;
}

void SheetDisplay::updatePlace() {
  if (last_) placeSheet();
  context_->queueRender();
}

void SheetDisplay::updateFit() {
  fitter_ = ViewFitter();  // forgets where the view was
}

// Points of the sheet and of what is written beside it, in the fixed frame.
std::vector<fsr::view::Vector3> SheetDisplay::outline() const {
  if (!isEnabled() || !last_ || !shown_.mesh) return {};
  std::vector<fsr::view::Vector3> points = letter_text_->outline(*shown_.mesh);
  if (!title_->getStdString().empty()) points.push_back({0, -SheetTitle::reach(shown_.picture.layout), 0});
  for (fsr::view::Vector3& point : points) {
    const Ogre::Vector3 at = scene_node_->getPosition() + scene_node_->getOrientation() * toOgre(point);
    point = {double(at.x), double(at.y), double(at.z)};
  }
  return points;
}

// Once the user has moved the view, it is his: a configuration that he saves keeps it.
void SheetDisplay::fitView() {
  std::vector<fsr::view::Vector3> points;
  QRect legends;
  const rviz::DisplayGroup* group = context_->getRootDisplayGroup();
  for (int i = 0; i < group->numDisplays(); ++i) {
    const auto* sheet = dynamic_cast<const SheetDisplay*>(group->getDisplayAt(i));
    if (sheet == nullptr) continue;
    const auto more = sheet->outline();
    points.insert(points.end(), more.begin(), more.end());
    if (sheet->overlay_) legends |= sheet->overlay_->place();
  }
  if (!fitter_.fit(*context_, points, legends)) fit_->setBool(false);
}

void SheetDisplay::updateLegend() {
  if (!overlay_) return;
  if (!isEnabled() || !legend_->getBool()) return overlay_->hide();
  fsr::view::Legend now = legend();
  now.marks = marks_->getBool();
  const std::string headline = flowHeadline(flow(), noun_);
  if (!headline.empty()) now.lines.push_back(headline);
  now.lines.push_back(surface_.name.empty() ? "surface not named" : "surface " + surface_.name);
  overlay_->moveTo(left_->getInt(), top_->getInt());
  overlay_->show(now);
}

void SheetDisplay::say(const char* name, const StatusLine& line) {
  setStatus(line.level, name, QString::fromStdString(line.text));
}

double SheetDisplay::age() const {
  return last_ ? (ros::WallTime::now() - last_time_).toSec() : -1;
}

Flow SheetDisplay::flow() const {
  return flowOf(age(), last_ ? (ros::Time::now() - last_ros_time_).toSec() : -1);
}

// Expands the status once; afterwards the user decides.
void SheetDisplay::openStatus() {
  for (int i = 0; i < numChildren() && !status_opened_; ++i) {
    if (!childAt(i)->getName().startsWith("Status")) continue;
    childAt(i)->expand();
    status_opened_ = true;
  }
}

void SheetDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  const std::string topic = topic_->getTopicStd();  // shown with the remappings of the launch file
  say("Messages", messageStatus(flow(), age(), noun_, topic.empty() ? topic : update_nh_.resolveName(topic)));
  openStatus();
  if (last_ && shown_.picture.stopped != (flow() == Flow::kStopped)) fresh_ = true;
  if (fresh_) redraw();
  updateLegend();
  say("Curvature", curvatureStatus(surface_, surface_error_, update_nh_.resolveName(curvatureTopic())));
  if (last_) placeSheet();
  if (last_ && fit_->getBool()) fitView();
}

}  // namespace fsr_rviz
