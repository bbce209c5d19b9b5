#include "ros/rviz/sheet_letters.h"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/movable_text.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ros/rviz/sheet_visual.h"

namespace fsr_rviz {

namespace {

using fsr::view::SheetMesh;
using fsr::view::Vector3;

// As parts of the sheet's longer side, so that the title of any matrix is as large on the screen.
constexpr double kTitleHeight = 0.065;  // of a capital letter
constexpr double kTitleGap = 0.11;      // to the sheet's edge
constexpr double kHeight = 0.05;        // of a capital letter, as a part of the sheet's longer side
constexpr double kLetterWidth = 0.6;    // of a letter, as a part of its height

struct Label {
  const char* words;
  float red, green, blue;
};

// The axes' colours, brighter than rviz draws them: pure blue is hardly seen on dark grey.
constexpr std::array<Label, 5> kLabels = {{{"x", 1, 0.45F, 0.45F},
                                           {"y", 0.5F, 1, 0.5F},
                                           {"z", 0.55F, 0.7F, 1},
                                           {"row 0", 1, 1, 1},
                                           {"column 0", 1, 1, 1}}};
constexpr double kAxis = 0.02;  // length of the axes in config/rviz [m]

// A point of the edge, and the way out of the sheet, of length 1.
struct Edge {
  Vector3 point, out;
};

// From the middle of an outer taxel to its edge.
Edge edgeAt(const SheetMesh& mesh, double row, double column, double down, double right) {
  const Vector3 from = mesh.point(row, column), to = mesh.point(row + 0.5 * down, column + 0.5 * right);
  const double x = to.x - from.x, y = to.y - from.y, z = to.z - from.z, length = std::hypot(x, y, z);
  return {to, {x / length, y / length, z / length}};
}

Edge edgeOf(const SheetMesh& mesh, std::size_t label) {
  const double last_row = mesh.layout().size.rows - 1, last_column = mesh.layout().size.columns - 1;
  switch (label) {
    case 0:
      return edgeAt(mesh, 0.5 * last_row, last_column, 0, 1);
    case 1:
      return edgeAt(mesh, last_row, 0.5 * last_column, 1, 0);
    case 2:
      return {{0, 0, kAxis}, {0, 0, 1}};
    case 3:
      return edgeAt(mesh, 0, 0, 0, -1);
    default:
      return edgeAt(mesh, 0, 0, -1, 0);
  }
}

double longerSide(const fsr::matrix::Layout& layout) {
  return std::max(layout.pitch_x * layout.size.columns, layout.pitch_y * layout.size.rows);
}

double heightFor(const SheetMesh& mesh) {
  return kHeight * longerSide(mesh.layout());
}

// Half the length of the words in letters, and the gap of one letter to the sheet.
double reach(const Label& label, double height) {
  return height * kLetterWidth * (1 + 0.5 * static_cast<double>(std::char_traits<char>::length(label.words)));
}

Vector3 moved(const Edge& edge, double way) {
  return {edge.point.x + way * edge.out.x, edge.point.y + way * edge.out.y, edge.point.z + way * edge.out.z};
}

}  // namespace

Words::Words(Ogre::SceneManager* scene, Ogre::SceneNode* parent, const std::string& text,
             const Ogre::ColourValue& colour)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      text_(std::make_unique<rviz::MovableText>(text, "Liberation Sans", 1.0F, colour)) {
  text_->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_CENTER);
  node_->attachObject(text_.get());
  hide();
}

Words::~Words() {
  node_->detachObject(text_.get());
  scene_->destroySceneNode(node_);
}

void Words::setText(const std::string& text) {
  text_->setCaption(text);
}

void Words::show(double height, const Vector3& middle) {
  text_->setCharacterHeight(static_cast<Ogre::Real>(height));
  node_->setPosition(toOgre(middle));
  node_->setVisible(true);
}

void Words::hide() {
  node_->setVisible(false);
}

SheetLetters::SheetLetters(Ogre::SceneManager* scene, Ogre::SceneNode* parent) {
  for (const Label& label : kLabels)
    words_.push_back(std::make_unique<Words>(scene, parent, label.words,
                                             Ogre::ColourValue(label.red, label.green, label.blue)));
}

void SheetLetters::show(const SheetMesh& mesh) {
  const double height = heightFor(mesh);
  for (std::size_t i = 0; i < words_.size(); ++i)
    words_[i]->show(height, moved(edgeOf(mesh, i), reach(kLabels[i], height)));
  shown_ = true;
}

void SheetLetters::hide() {
  for (const auto& words : words_) words->hide();
  shown_ = false;
}

std::vector<Vector3> SheetLetters::outline(const SheetMesh& mesh) const {
  std::vector<Vector3> points;
  const int rows = mesh.layout().size.rows, columns = mesh.layout().size.columns;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) points.push_back(mesh.point(row - 0.5, column - 0.5));
  }
  for (std::size_t i = 0; shown_ && i < words_.size(); ++i)
    points.push_back(moved(edgeOf(mesh, i), 2 * reach(kLabels[i], heightFor(mesh))));
  return points;
}

SheetTitle::SheetTitle(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : words_(scene, parent, "-", Ogre::ColourValue::White) {}

double SheetTitle::reach(const fsr::matrix::Layout& layout) {
  return 0.5 * layout.pitch_y * layout.size.rows + (kTitleGap + kTitleHeight) * longerSide(layout);
}

void SheetTitle::show(const std::string& text, const fsr::matrix::Layout& layout) {
  if (text.empty()) return words_.hide();
  words_.setText(text);
  const double letter = kTitleHeight * longerSide(layout);
  words_.show(letter, {0, letter - reach(layout), 0});
}

}  // namespace fsr_rviz
