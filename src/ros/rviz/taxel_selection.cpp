#include "taxel_selection.h"

#include <OgreManualObject.h>
#include <OgreSceneNode.h>
#include <rviz/properties/property.h>

#include <utility>

namespace fsr_rviz {

namespace {

QString text(const std::string& words) {
  return QString::fromStdString(words);
}

}  // namespace

std::string flagsText(std::uint16_t flags) {
  using namespace fsr::taxel_flag;
  static const std::pair<std::uint16_t, const char*> names[] = {
      {kSaturated, "saturated"},
      {kDead, "dead"},
      {kStuck, "stuck"},
      {kReadingExtrapolated, "reading beyond training"},
      {kCurvatureExtrapolated, "curvature beyond training"},
      {kBetweenClasses, "between curvature classes"},
      {kFilled, "filled from its neighbours"},
      {kMasked, "masked"},
      {kLineFault, "line fault"},
      {kTared, "tared"},
      {kBelowRange, "below range"},
      {kTemperatureExtrapolated, "temperature beyond training"},
  };
  std::string result;
  for (const auto& [flag, words] : names) {
    if ((flags & flag) != 0) result += (result.empty() ? "" : ", ") + std::string(words);
  }
  return result.empty() ? "none" : result;
}

TaxelSelection::TaxelSelection(rviz::DisplayContext* context, SheetVisual& visual, const ShownMap& shown)
    : SelectionHandler(context), visual_(visual), shown_(shown) {}

bool TaxelSelection::taxelOf(uint64_t extra_handle, std::size_t& taxel) const {
  taxel = static_cast<std::size_t>(extra_handle & 0xffffffff) - 1;  // 0 = none becomes far too large
  return shown_.mesh != nullptr && taxel < shown_.map.pressure.size();
}

void TaxelSelection::preRenderPass(uint32_t pass) {
  SelectionHandler::preRenderPass(pass);
  if (pass == 1 && shown_.mesh != nullptr) visual_.showIndices(*shown_.mesh);
}

void TaxelSelection::postRenderPass(uint32_t pass) {
  SelectionHandler::postRenderPass(pass);
  if (pass == 1 && shown_.mesh != nullptr) visual_.show(shown_.map, *shown_.mesh, shown_.style, shown_.marks);
}

void TaxelSelection::createProperties(const rviz::Picked& picked, rviz::Property* parent) {
  const fsr::PressureUnit unit = shown_.style.scale.unit;
  for (const uint64_t handle : picked.extra_handles) {
    std::size_t taxel = 0;
    if (!taxelOf(handle, taxel)) continue;
    const fsr::Layout& layout = shown_.map.layout;
    auto* group = new rviz::Property(
        QString("Taxel row %1, column %2").arg(layout.row({taxel})).arg(layout.column({taxel})), QVariant(),
        "", parent);
    const auto add = [group](const QString& name, const std::string& value) {
      (new rviz::Property(name, text(value), "", group))->setReadOnly(true);
    };
    add("Gauge pressure", fsr::pressureText(shown_.map.pressure[taxel], unit));
    add("Standard deviation", fsr::pressureText(shown_.map.deviation[taxel], unit));
    add("Flags", flagsText(shown_.map.flags[taxel]));
    group->setReadOnly(true);
    group->expand();
    properties_.push_back(group);
  }
}

void TaxelSelection::getAABBs(const rviz::Picked& picked, rviz::V_AABB& boxes) {
  for (const uint64_t handle : picked.extra_handles) {
    std::size_t taxel = 0;
    if (!taxelOf(handle, taxel)) continue;
    Ogre::AxisAlignedBox box;
    const std::size_t corners = shown_.mesh->cornersOfTaxel();
    for (std::size_t i = taxel * corners; i < (taxel + 1) * corners; ++i) {
      const fsr::Vector3& v = shown_.mesh->corners()[i];
      const Ogre::Vector3 corner(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
      box.merge(visual_.node()->convertLocalToWorldPosition(corner));
    }
    boxes.push_back(box);
  }
}

void TaxelSelection::onSelect(const rviz::Picked& picked) {
  for (const uint64_t handle : picked.extra_handles) {
    rviz::Picked one = picked;
    one.extra_handles = {handle};
    rviz::V_AABB boxes;
    getAABBs(one, boxes);
    if (!boxes.empty()) createBox(std::make_pair(picked.handle, handle), boxes.front(), "RVIZ/Cyan");
  }
}

void TaxelSelection::onDeselect(const rviz::Picked& picked) {
  for (const uint64_t handle : picked.extra_handles) destroyBox(std::make_pair(picked.handle, handle));
}

}  // namespace fsr_rviz
