#pragma once

#include <OgreMaterial.h>
#include <OgrePrerequisites.h>
#include <OgreSceneNode.h>

#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "view/sheet_mesh.h"
#include "view/taxel_look.h"

namespace fsr_rviz {

inline Ogre::Vector3 toOgre(const fsr::view::Vector3& v) {
  return {static_cast<Ogre::Real>(v.x), static_cast<Ogre::Real>(v.y), static_cast<Ogre::Real>(v.z)};
}

/// The values that are drawn on a sheet: pressure, its standard deviation, or counts.
struct SheetPicture {
  fsr::matrix::Layout layout;
  std::vector<float> values;  ///< [rows x columns], row-major, in the unit of the scale; NaN = no reading
  std::vector<fsr::view::TaxelLook> looks;  ///< [rows x columns], row-major
  fsr::view::PressureScale scale;
  bool smooth = true;    ///< colours are interpolated between taxels; false: one square for each taxel
  bool marks = true;     ///< marks on taxels with an unreliable reading
  bool stopped = false;  ///< the values are old: the sheet is drawn in grey, without marks
};

/// The coloured sheet and its marks in the scene of rviz. The colours are those of the scale, without
/// lighting, so that they do not depend on the direction of view.
class SheetVisual {
 public:
  SheetVisual(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~SheetVisual();
  SheetVisual(const SheetVisual&) = delete;
  SheetVisual& operator=(const SheetVisual&) = delete;

  void show(const SheetPicture& picture, const fsr::view::SheetMesh& mesh);
  /// Draws each taxel in a colour that encodes its index + 1 (red = highest byte), for rviz's selection.
  void showIndices(const fsr::view::SheetMesh& mesh);
  void setVisible(bool visible);

  Ogre::SceneNode* node() { return node_; }
  Ogre::ManualObject* sheet() { return sheet_; }

 private:
  void draw(const fsr::view::SheetMesh& mesh, const std::vector<fsr::view::Colour>& colours);
  void drawMarks(const SheetPicture& picture, const fsr::view::SheetMesh& mesh);

  Ogre::SceneManager* scene_;
  Ogre::SceneNode* node_;
  Ogre::ManualObject* sheet_;
  Ogre::ManualObject* marks_;
  Ogre::MaterialPtr material_;
  bool drawn_ = false;                      // the sheet has been drawn once
  std::vector<fsr::view::Colour> colours_;  // colours of the corners at the last drawing
};

}  // namespace fsr_rviz
