#include "ros/rviz/taxel_selection.h"

#include <OgreManualObject.h>
#include <OgreSceneNode.h>
#include <rviz/properties/property.h>

namespace fsr_rviz {

TaxelSelection::TaxelSelection(rviz::DisplayContext* context, SheetVisual& visual, const ShownSheet& shown,
                               std::function<ReadOut(std::size_t taxel)> read_out)
    : SelectionHandler(context), visual_(visual), shown_(shown), read_out_(std::move(read_out)) {}

bool TaxelSelection::taxelOf(uint64_t extra_handle, std::size_t& taxel) const {
  taxel = static_cast<std::size_t>(extra_handle & 0xffffffff) -
          1;  // the handle 0 means none and becomes a very large index
  return shown_.mesh && taxel < shown_.picture.values.size();
}

std::vector<std::size_t> TaxelSelection::taxelsOf(const rviz::Picked& picked) const {
  std::vector<std::size_t> taxels;
  for (const uint64_t handle : picked.extra_handles) {
    std::size_t taxel = 0;
    if (taxelOf(handle, taxel)) taxels.push_back(taxel);
  }
  return taxels;
}

void TaxelSelection::preRenderPass(uint32_t pass) {
  SelectionHandler::preRenderPass(pass);
  if (pass == 1 && shown_.mesh) visual_.showIndices(*shown_.mesh);
}

void TaxelSelection::postRenderPass(uint32_t pass) {
  SelectionHandler::postRenderPass(pass);
  if (pass == 1 && shown_.mesh) visual_.show(shown_.picture, *shown_.mesh);
}

void TaxelSelection::createProperties(const rviz::Picked& picked, rviz::Property* parent) {
  for (const uint64_t handle : picked.extra_handles) {
    std::size_t taxel = 0;
    if (!taxelOf(handle, taxel)) continue;
    const fsr::matrix::Layout& layout = shown_.picture.layout;
    auto* group = new rviz::Property(
        QString("Taxel row %1, column %2").arg(layout.row({taxel})).arg(layout.column({taxel})), QVariant(),
        "", parent);
    for (const auto& [name, value] : read_out_(taxel)) {
      (new rviz::Property(QString::fromStdString(name), QString::fromStdString(value), "", group))
          ->setReadOnly(true);
    }
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
      box.merge(visual_.node()->convertLocalToWorldPosition(toOgre(shown_.mesh->corners()[i])));
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
