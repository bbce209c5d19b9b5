#include "ros/rviz/sheet_title.h"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/movable_text.h>

namespace fsr_rviz {

namespace {

constexpr float kHeight = 0.0065F;  // height of a capital letter [m]
constexpr double kGap = 0.011;      // distance to the sheet's edge [m]

}  // namespace

SheetTitle::SheetTitle(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      text_(std::make_unique<rviz::MovableText>("-", "Liberation Sans", kHeight)) {
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
  const double y = -0.5 * layout.pitch_y * layout.size.rows - kGap;
  node_->setPosition(0, static_cast<Ogre::Real>(y), 0);
  node_->setVisible(true);
}

void SheetTitle::hide() {
  node_->setVisible(false);
}

}  // namespace fsr_rviz
