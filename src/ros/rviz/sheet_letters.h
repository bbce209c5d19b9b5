#pragma once

#include <OgrePrerequisites.h>

#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "view/sheet_mesh.h"

namespace rviz {
class MovableText;
}

namespace fsr_rviz {

/// Words in the scene that face the viewer.
class Words {
 public:
  Words(Ogre::SceneManager* scene, Ogre::SceneNode* parent, const std::string& text,
        const Ogre::ColourValue& colour);
  ~Words();
  Words(const Words&) = delete;
  Words& operator=(const Words&) = delete;

  void setText(const std::string& text);
  /// `height` of a capital letter, and the middle of the words in the parent's frame [m].
  void show(double height, const fsr::view::Vector3& middle);
  void hide();

 private:
  Ogre::SceneManager* scene_;
  Ogre::SceneNode* node_;
  std::unique_ptr<rviz::MovableText> text_;
};

/// The letters of the matrix frame, x and y where these axes leave the sheet, in the axes' colours, and the
/// words "row 0" and "column 0" beside the first row and column.
class SheetLetters {
 public:
  SheetLetters(Ogre::SceneManager* scene, Ogre::SceneNode* parent);

  void show(const fsr::view::SheetMesh& mesh);
  void hide();
  /// Corners of the taxels at the sheet's edge, and the outer ends of the words if they are shown, in the
  /// matrix frame [m].
  std::vector<fsr::view::Vector3> outline(const fsr::view::SheetMesh& mesh) const;

 private:
  std::vector<std::unique_ptr<Words>> words_;
  bool shown_ = false;
};

/// A line of text beside the sheet's first row, which identifies the sheet when there are several.
class SheetTitle {
 public:
  SheetTitle(Ogre::SceneManager* scene, Ogre::SceneNode* parent);

  /// Shows the text; an empty text hides the title.
  void show(const std::string& text, const fsr::matrix::Layout& layout);
  void hide() { words_.hide(); }
  /// Distance of the title's lower end from the middle of the sheet [m].
  static double reach(const fsr::matrix::Layout& layout);

 private:
  Words words_;
};

}  // namespace fsr_rviz
