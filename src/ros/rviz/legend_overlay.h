#pragma once

#include <OgrePrerequisites.h>
#include <OgreTexture.h>

#include <QRect>

#include "view/legend.h"

namespace Ogre {
class Overlay;
class PanelOverlayElement;
}  // namespace Ogre

namespace fsr_rviz {

/// A legend at a fixed place of the window, in front of the 3D scene. It is drawn again only when it has
/// changed.
class LegendOverlay {
 public:
  LegendOverlay();
  ~LegendOverlay();
  LegendOverlay(const LegendOverlay&) = delete;
  LegendOverlay& operator=(const LegendOverlay&) = delete;

  void show(const fsr::view::Legend& legend);
  void hide();
  /// Sets the position of the top left corner [pixels].
  void moveTo(int left, int top);
  /// Its place, with the largest size that it has had [pixels]; empty while it is hidden.
  QRect place() const;

 private:
  void makeTexture(const fsr::view::Image& image);
  void blit(const fsr::view::Image& image);

  std::string name_;
  Ogre::Overlay* overlay_;
  Ogre::PanelOverlayElement* panel_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
  fsr::view::Legend drawn_;
  QSize largest_;
};

}  // namespace fsr_rviz
