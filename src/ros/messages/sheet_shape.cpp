#include "ros/messages/sheet_shape.h"

namespace fsr_ros {

void SheetShape::setSurface(fsr::matrix::Surface surface) {
  if (fsr::matrix::sameCondition(surface, surface_)) return;
  surface_ = std::move(surface);
  forget();
}

void SheetShape::setLayout(const fsr::matrix::Layout& layout) {
  if (layout.size == layout_.size && layout.pitch_x == layout_.pitch_x && layout.pitch_y == layout_.pitch_y) {
    return;
  }
  layout_ = layout;
  forget();
}

void SheetShape::forget() {
  poses_.reset();
  mesh_.reset();
  areas_.reset();
}

const std::vector<fsr::view::TaxelPose>& SheetShape::poses() {
  if (!poses_) poses_ = fsr::view::bendSheet(layout_, surface_);
  return *poses_;
}

const fsr::view::SheetMesh& SheetShape::mesh() {
  if (!mesh_) mesh_.emplace(layout_, surface_, fineness_);
  return *mesh_;
}

const std::vector<double>& SheetShape::areas() {
  if (!areas_) areas_ = fsr::view::taxelAreas(layout_, surface_);
  return *areas_;
}

}  // namespace fsr_ros
