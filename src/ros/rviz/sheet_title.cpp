#include "ros/rviz/sheet_title.h"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/movable_text.h>

#include <algorithm>

namespace fsr_rviz {

namespace {

// As parts of the sheet's longer side, so that the title of any matrix is as large on the screen.
constexpr double kTitleHeight = 0.065;  // of a capital letter
constexpr double kTitleGap = 0.11;      // to the sheet's edge

double longerSide(const fsr::matrix::Layout& layout) {
  return std::max(layout.pitch_x * layout.size.columns, layout.pitch_y * layout.size.rows);
}

}  // namespace

double SheetTitle::reach(const fsr::matrix::Layout& layout) {
  return 0.5 * layout.pitch_y * layout.size.rows + (kTitleGap + kTitleHeight) * longerSide(layout);
}

SheetTitle::SheetTitle(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      text_(std::make_unique<rviz::MovableText>("-", "Liberation Sans", 1.0F)) {
  text_->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_CENTER);
  node_->attachObject(text_.get());
  hide();
}

SheetTitle::~SheetTitle() {
  node_->detachObject(text_.get());
  scene_->destroySceneNode(node_);
}

void SheetTitle::show(const std::string& text, const fsr::matrix::Layout& layout) {
  if (text.empty()) return hide();
  text_->setCaption(text);
  const double letter = kTitleHeight * longerSide(layout);
  text_->setCharacterHeight(static_cast<Ogre::Real>(letter));
  node_->setPosition(0, static_cast<Ogre::Real>(letter - reach(layout)), 0);
  node_->setVisible(true);
}

void SheetTitle::hide() {
  node_->setVisible(false);
}

}  // namespace fsr_rviz
