#pragma once

#include <rviz/selection/selection_handler.h>

#include "sheet_visual.h"

namespace fsr_rviz {

/// What the display shows at the moment, for a read-out of single taxels.
struct ShownMap {
  fsr::PressureMap map;
  const fsr::SheetMesh* mesh = nullptr;
  fsr::HeatMapStyle style;
  bool marks = true;
};

/// Reads taxels out in rviz's selection panel: row, column, pressure, deviation, flags in words.
class TaxelSelection : public rviz::SelectionHandler {
 public:
  /// Both must outlive it.
  TaxelSelection(rviz::DisplayContext* context, SheetVisual& visual, const ShownMap& shown);

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
  const ShownMap& shown_;
};

/// The flags of a taxel in words, e.g. "saturated, tared"; "none".
std::string flagsText(std::uint16_t flags);

}  // namespace fsr_rviz
