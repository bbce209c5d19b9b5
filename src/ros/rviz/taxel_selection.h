#pragma once

#include <rviz/selection/selection_handler.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ros/rviz/sheet_visual.h"

namespace fsr_rviz {

/// The picture and mesh that a display shows.
struct ShownSheet {
  SheetPicture picture;
  std::optional<fsr::view::SheetMesh> mesh;
};

/// Data of one taxel, as pairs of name and value.
using ReadOut = std::vector<std::pair<std::string, std::string>>;

/// Shows row, column and data of the selected taxels in rviz's selection panel.
class TaxelSelection : public rviz::SelectionHandler {
 public:
  /// All arguments must outlive the object.
  TaxelSelection(rviz::DisplayContext* context, SheetVisual& visual, const ShownSheet& shown,
                 std::function<ReadOut(std::size_t taxel)> read_out);

  /// The taxels that were picked, as row-major indices.
  std::vector<std::size_t> taxelsOf(const rviz::Picked& picked) const;

  void createProperties(const rviz::Picked& picked, rviz::Property* parent) override;
  bool needsAdditionalRenderPass(uint32_t pass) override { return pass == 1; }
  void preRenderPass(uint32_t pass) override;
  void postRenderPass(uint32_t pass) override;
  void getAABBs(const rviz::Picked& picked, rviz::V_AABB& boxes) override;
  void onSelect(const rviz::Picked& picked) override;
  void onDeselect(const rviz::Picked& picked) override;

 private:
  bool taxelOf(uint64_t extra_handle, std::size_t& taxel) const;

  SheetVisual& visual_;
  const ShownSheet& shown_;
  std::function<ReadOut(std::size_t taxel)> read_out_;
};

}  // namespace fsr_rviz
