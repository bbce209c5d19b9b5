#pragma once

#include <QRect>
#include <optional>
#include <vector>

#include "view/fit_view.h"

namespace rviz {
class DisplayContext;
}

namespace fsr_rviz {

/// Moves the orbiting view of rviz so that points of the fixed frame fill the window beside or below a
/// legend, until the user moves the view.
class ViewFitter {
 public:
  /// `legend`: its place in the scene [pixels], empty = none. False where the user has moved the view.
  bool fit(rviz::DisplayContext& context, const std::vector<fsr::view::Vector3>& points, const QRect& legend);

 private:
  std::optional<fsr::view::OrbitCamera> last_;  // the view as it was set
};

}  // namespace fsr_rviz
