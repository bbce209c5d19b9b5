#include "ros/rviz/sheet_visual.h"

#include <OgreManualObject.h>
#include <OgreMaterialManager.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>

#include <cmath>

namespace fsr_rviz {

namespace {

constexpr double kMarkLift =
    0.0004;  // height of the strokes above the surface, so that they stay visible [m]
constexpr double kStrokeWidth = 0.06;  // width of a stroke, as a part of a taxel's side

Ogre::ColourValue ogreColour(fsr::view::Colour c) {
  return Ogre::ColourValue(static_cast<float>(c.red) / 255, static_cast<float>(c.green) / 255,
                           static_cast<float>(c.blue) / 255);
}

// A material without lighting whose both faces are visible, also in the second pass of rviz's selection.
Ogre::MaterialPtr plainMaterial() {
  static int count = 0;
  Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create("fsr_pressure_map_sheet_" + std::to_string(count++),
                                                   Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  for (const char* scheme : {"Default", "Pick1"}) {
    Ogre::Technique* technique =
        scheme == std::string("Default") ? material->getTechnique(0) : material->createTechnique();
    technique->setSchemeName(scheme);
    Ogre::Pass* pass = technique->getNumPasses() > 0 ? technique->getPass(0) : technique->createPass();
    pass->setLightingEnabled(false);
    pass->setCullingMode(Ogre::CULL_NONE);
    pass->setManualCullingMode(Ogre::MANUAL_CULL_NONE);
  }
  return material;
}

// Adds a stroke as a narrow band of two triangles on the surface.
void addBand(Ogre::ManualObject& object, const fsr::view::SheetMesh& mesh, double row, double column,
             const fsr::view::Stroke& stroke, const Ogre::ColourValue& colour) {
  const double dx = stroke.to.x - stroke.from.x, dy = stroke.to.y - stroke.from.y;
  const double half = 0.5 * kStrokeWidth / std::hypot(dx, dy);
  const auto corner = [&](const fsr::matrix::Position& end, double side) {
    object.position(
        toOgre(mesh.point(row + end.y + side * half * dx, column + end.x - side * half * dy, kMarkLift)));
    object.colour(colour);
  };
  corner(stroke.from, -1);
  corner(stroke.to, -1);
  corner(stroke.to, 1);
  corner(stroke.from, -1);
  corner(stroke.to, 1);
  corner(stroke.from, 1);
}

}  // namespace

SheetVisual::SheetVisual(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      node_(parent->createChildSceneNode()),
      sheet_(scene->createManualObject()),
      marks_(scene->createManualObject()),
      material_(plainMaterial()) {
  sheet_->setDynamic(true);
  marks_->setDynamic(true);
  node_->attachObject(sheet_);
  node_->attachObject(marks_);
}

SheetVisual::~SheetVisual() {
  scene_->destroyManualObject(sheet_);
  scene_->destroyManualObject(marks_);
  scene_->destroySceneNode(node_);
  Ogre::MaterialManager::getSingleton().remove(material_);
}

void SheetVisual::setVisible(bool visible) {
  node_->setVisible(visible);
}

void SheetVisual::show(const SheetPicture& picture, const fsr::view::SheetMesh& mesh) {
  if (picture.stopped) {
    colours_.assign(mesh.corners().size(), fsr::view::kNoReadingColour);
  } else if (picture.smooth) {
    mesh.colourSmoothly(picture.values, picture.scale, colours_);
  } else {
    mesh.colourCells(picture.values, picture.scale, colours_);
  }
  draw(mesh, colours_);
  marks_->clear();
  if (picture.marks && !picture.stopped) drawMarks(picture, mesh);
}

void SheetVisual::showIndices(const fsr::view::SheetMesh& mesh) {
  std::vector<fsr::view::Colour> indices;
  for (std::size_t i = 0; i < mesh.corners().size(); ++i) {
    const std::size_t value = i / mesh.cornersOfTaxel() + 1;
    indices.push_back({static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
                       static_cast<std::uint8_t>(value)});
  }
  draw(mesh, indices);
}

void SheetVisual::draw(const fsr::view::SheetMesh& mesh, const std::vector<fsr::view::Colour>& colours) {
  if (drawn_) {
    sheet_->beginUpdate(0);
  } else {
    sheet_->begin(material_->getName(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  }
  drawn_ = true;
  sheet_->estimateVertexCount(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    sheet_->position(toOgre(mesh.corners()[i]));
    sheet_->colour(ogreColour(colours[i]));
  }
  sheet_->end();
}

void SheetVisual::drawMarks(const SheetPicture& picture, const fsr::view::SheetMesh& mesh) {
  bool any = false;
  for (std::size_t i = 0; i < picture.looks.size(); ++i) {
    const auto& strokes = fsr::view::mark(picture.looks[i]);
    if (strokes.empty()) continue;
    if (!any) marks_->begin(material_->getName(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
    any = true;
    const auto value = double(picture.values[i]);
    const auto under = std::isnan(value) ? fsr::view::kNoReadingColour : picture.scale.colour(value);
    for (const fsr::view::Stroke& stroke : strokes) {
      addBand(*marks_, mesh, picture.layout.row({i}), picture.layout.column({i}), stroke,
              ogreColour(fsr::view::markColour(under)));
    }
  }
  if (any) marks_->end();
}

}  // namespace fsr_rviz
