#include "ros/rviz/view_fitter.h"

#include <OgreCamera.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/vector_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <cmath>

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
  focus->setVector(Ogre::Vector3(static_cast<float>(last_->focus.x), static_cast<float>(last_->focus.y),
                                 static_cast<float>(last_->focus.z)) -
                   *origin);
  return true;
}

}  // namespace fsr_rviz
