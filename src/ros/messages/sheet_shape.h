#pragma once

#include <optional>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "view/sheet_mesh.h"

namespace fsr_ros {

/// The shape of the bent sheet for the last layout and surface. It is computed on request, and again only
/// after the layout or the surface has changed.
class SheetShape {
 public:
  explicit SheetShape(int fineness) : fineness_(fineness) {}

  void setSurface(fsr::matrix::Surface surface);
  /// If the surface does not fit the layout, the next of the calls below throws fsr::InputError.
  void setLayout(const fsr::matrix::Layout& layout);

  const std::vector<fsr::view::TaxelPose>& poses();
  const fsr::view::SheetMesh& mesh();
  const std::vector<double>& areas();  ///< area of each taxel on the bent sheet, row-major [m^2]

 private:
  void forget();

  int fineness_;
  fsr::matrix::Surface surface_;
  fsr::matrix::Layout layout_;
  std::optional<std::vector<fsr::view::TaxelPose>> poses_;
  std::optional<fsr::view::SheetMesh> mesh_;
  std::optional<std::vector<double>> areas_;
};

}  // namespace fsr_ros
