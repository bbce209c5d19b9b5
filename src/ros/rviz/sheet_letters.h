#pragma once

#include <OgrePrerequisites.h>

#include <memory>
#include <vector>

#include "view/sheet_mesh.h"

namespace rviz {
class MovableText;
}

namespace fsr_rviz {

/// The letters of the matrix frame, x and y where these axes leave the sheet, in the axes' colours, and the
/// words "row 0" and "column 0" beside the first row and column.
class SheetLetters {
 public:
  SheetLetters(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~SheetLetters();
  SheetLetters(const SheetLetters&) = delete;
  SheetLetters& operator=(const SheetLetters&) = delete;

  void show(const fsr::view::SheetMesh& mesh);
  void hide();
  /// Corners of the taxels at the sheet's edge, and the outer ends of the words if they are shown, in the
  /// matrix frame [m].
  std::vector<fsr::view::Vector3> outline(const fsr::view::SheetMesh& mesh) const;

 private:
  struct Word {
    Ogre::SceneNode* node;
    std::unique_ptr<rviz::MovableText> text;
  };

  Ogre::SceneManager* scene_;
  std::vector<Word> words_;
  bool shown_ = false;
};

}  // namespace fsr_rviz
