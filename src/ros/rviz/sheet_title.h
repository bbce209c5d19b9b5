#pragma once

#include <OgrePrerequisites.h>

#include <memory>
#include <string>

#include "fsr_pressure_map/matrix/layout.h"

namespace rviz {
class MovableText;
}

namespace fsr_rviz {

/// A line of text beside the sheet's first row, which identifies the sheet when there are several.
class SheetTitle {
 public:
  SheetTitle(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~SheetTitle();
  SheetTitle(const SheetTitle&) = delete;
  SheetTitle& operator=(const SheetTitle&) = delete;

  /// Shows the text; an empty text hides the title.
  void show(const std::string& text, const fsr::matrix::Layout& layout);
  void hide();
  /// Distance of the title's lower end from the middle of the sheet [m].
  static double reach(const fsr::matrix::Layout& layout);

 private:
  Ogre::SceneManager* scene_;
  Ogre::SceneNode* node_;
  std::unique_ptr<rviz::MovableText> text_;
};

}  // namespace fsr_rviz
