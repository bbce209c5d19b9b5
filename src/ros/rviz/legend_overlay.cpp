#include "ros/rviz/legend_overlay.h"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayManager.h>
#include <Overlay/OgrePanelOverlayElement.h>

#include <vector>

namespace fsr_rviz {

namespace {

constexpr unsigned short kAboveAll = 600;  // z-order of overlays, 0 to 650

std::string freshName() {
  static int count = 0;
  return "fsr_pressure_map_legend_" + std::to_string(count++);
}

}  // namespace

LegendOverlay::LegendOverlay() : name_(freshName()) {
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_ = overlays.create(name_);
  overlay_->setZOrder(kAboveAll);
  panel_ = static_cast<Ogre::PanelOverlayElement*>(overlays.createOverlayElement("Panel", name_ + "_panel"));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  material_ = Ogre::MaterialManager::getSingleton().create(
      name_ + "_material", Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  overlay_->add2D(panel_);
}

LegendOverlay::~LegendOverlay() {
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->hide();
  overlay_->remove2D(panel_);
  overlays.destroyOverlayElement(panel_);
  overlays.destroy(overlay_);
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_);
  Ogre::MaterialManager::getSingleton().remove(material_);
}

void LegendOverlay::hide() {
  overlay_->hide();
}

void LegendOverlay::moveTo(int left, int top) {
  panel_->setPosition(static_cast<Ogre::Real>(left), static_cast<Ogre::Real>(top));
}

QRect LegendOverlay::place() const {
  if (!overlay_->isVisible()) return {};
  return {QPoint(static_cast<int>(panel_->getLeft()), static_cast<int>(panel_->getTop())), largest_};
}

void LegendOverlay::makeTexture(const fsr::view::Image& image) {
  Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
  if (texture_) textures.remove(texture_);
  texture_ = textures.createManual(
      name_ + "_texture", Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D,
      static_cast<Ogre::uint>(image.width()), static_cast<Ogre::uint>(image.height()), 0, Ogre::PF_X8R8G8B8,
      Ogre::TU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
  Ogre::Pass* pass = material_->getTechnique(0)->getPass(0);
  pass->removeAllTextureUnitStates();
  pass->setLightingEnabled(false);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  Ogre::TextureUnitState* unit = pass->createTextureUnitState(texture_->getName());
  unit->setTextureFiltering(Ogre::TFO_NONE);  // no filter, so that text stays sharp
  panel_->setMaterialName(material_->getName());
  panel_->setDimensions(static_cast<Ogre::Real>(image.width()), static_cast<Ogre::Real>(image.height()));
}

void LegendOverlay::show(const fsr::view::Legend& legend) {
  if (!texture_ || !(legend == drawn_)) blit(fsr::view::drawLegend(legend));
  drawn_ = legend;
  overlay_->show();
}

void LegendOverlay::blit(const fsr::view::Image& image) {
  const bool fits = texture_ && texture_->getWidth() == static_cast<Ogre::uint32>(image.width()) &&
                    texture_->getHeight() == static_cast<Ogre::uint32>(image.height());
  if (!fits) makeTexture(image);
  largest_ = largest_.expandedTo(QSize(image.width(), image.height()));
  // blitFromMemory() only reads, but needs a pointer to non-const data.
  std::vector<std::uint8_t> bytes = image.bytes();
  const Ogre::PixelBox box(static_cast<Ogre::uint32>(image.width()),
                           static_cast<Ogre::uint32>(image.height()), 1, Ogre::PF_BYTE_RGB, bytes.data());
  texture_->getBuffer()->blitFromMemory(box);
}

}  // namespace fsr_rviz
