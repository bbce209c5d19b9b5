// rviz with the shipped configuration and a recorded map: the picture on the screen is compared with the map.
// Needs an X server; test/ros/rviz/rviz.test starts a headless one.

#include <OgreCamera.h>
#include <OgreSceneNode.h>
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SetMask.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/properties/property_tree_model.h>
#include <rviz/render_panel.h>
#include <rviz/selection/selection_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>

#include <QApplication>
#include <QDir>
#include <QImage>
#include <QLabel>
#include <QPixmap>
#include <QPushButton>
#include <QScreen>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <typeinfo>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "ros/messages/message_reader.h"
#include "ros/messages/view_messages.h"
#include "support/source_dir.h"
#include "view/taxel_look.h"

namespace {

using fsr_pressure_map::MatrixFrame;
using fsr_pressure_map::PressureMap;
using fsr_pressure_map::SurfaceCurvature;

const std::string kBag = test_support::sourceDir() + "/test/data/indenter_map.bag";
const QString kConfigs = QString::fromStdString(test_support::sourceDir() + "/config/rviz");

/// The last message of a topic; null, with a sentence on the terminal, if it cannot be read. (A test suite
/// whose set-up fails is skipped, which rostest takes for success.)
template <typename Message>
typename Message::ConstPtr lastOf(const std::string& topic) {
  rosbag::Bag bag(kBag);
  boost::shared_ptr<Message> last;
  fsr_ros::MessageReader reader;  // the bag has an earlier definition of PressureMap
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    try {
      last = boost::make_shared<Message>(reader.read<Message>(instance));
    } catch (const fsr::settings::InputError& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return nullptr;
    }
  }
  return last;
}

/// The window of rviz, shared by all tests: its renderer cannot be started twice in a process.
class Rviz : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    frame = new rviz::VisualizationFrame;
    frame->setSplashPath("");
    frame->initialize(kConfigs + "/live.rviz");
    frame->resize(1280, 900);
    frame->show();
    handle = new ros::NodeHandle;
    maps = handle->advertise<PressureMap>("/fsr/pressure_map", 10);
    curvature = handle->advertise<SurfaceCurvature>("/fsr/curvature", 10, true);
    map = lastOf<PressureMap>("/fsr/pressure_map");
    surface = lastOf<SurfaceCurvature>("/fsr/curvature");
    display = displayNamed("Pressure map");
  }

  void SetUp() override {
    ASSERT_NE(map, nullptr);
    ASSERT_NE(display, nullptr);
  }

  static rviz::Display* displayNamed(const QString& name) {
    rviz::DisplayGroup* group = frame->getManager()->getRootDisplayGroup();
    for (int i = 0; i < group->numDisplays(); ++i) {
      if (group->getDisplayAt(i)->getName() == name) return group->getDisplayAt(i);
    }
    return nullptr;
  }

  /// Runs rviz until `done`, and publishes the map meanwhile if `publishing`; false after 20 s.
  static bool runUntil(const std::function<bool()>& done, bool publishing = true) {
    const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(20);
    while (!done() && ros::WallTime::now() < give_up) {
      if (publishing) maps.publish(map);
      QApplication::processEvents(QEventLoop::AllEvents, 50);
    }
    return done();
  }

  static void set(const QString& property, const QVariant& value) {
    ASSERT_NE(display->subProp(property), nullptr);
    ASSERT_TRUE(display->subProp(property)->setValue(value)) << property.toStdString();
  }

  /// A line of the display's status as "Level text", e.g. "Warn no map has come on ...".
  static std::string status(const QString& name, rviz::Display* of = display) {
    for (int i = 0; i < of->numChildren(); ++i) {
      rviz::Property* list = of->childAt(i);
      if (!list->getName().startsWith("Status")) continue;
      for (int j = 0; j < list->numChildren(); ++j) {
        if (list->childAt(j)->getName() == name) return list->childAt(j)->getValue().toString().toStdString();
      }
    }
    return "";
  }

  static bool says(const QString& name, const std::string& words) {
    return status(name).find(words) != std::string::npos;
  }

  /// The 3D scene as shown on the screen, including overlays.
  static QImage picture() {
    rviz::RenderPanel* panel = frame->getManager()->getRenderPanel();
    return QApplication::primaryScreen()->grabWindow(panel->winId()).toImage();
  }

  /// Position of a taxel's centre on the screen, computed here for a cylinder of the recorded curvature.
  static QPoint place(std::size_t taxel, const QImage& image) {
    const double k = double(surface->x.front());  // [1/m]
    const double along = double(map->pitch_x) * (double(taxel % map->columns) - 0.5 * (map->columns - 1));
    const double y = double(map->pitch_y) * (double(taxel / map->columns) - 0.5 * (map->rows - 1));
    return onScreen({static_cast<float>(std::sin(k * along) / k), static_cast<float>(y),
                     static_cast<float>((std::cos(k * along) - 1) / k)},
                    image);
  }

  static QPoint onScreen(const Ogre::Vector3& position, const QImage& image) {
    const Ogre::Vector4 point(position.x, position.y, position.z, 1);
    const Ogre::Camera* camera = frame->getManager()->getRenderPanel()->getCamera();
    const Ogre::Vector4 clip = camera->getProjectionMatrix() * (camera->getViewMatrix() * point);
    return {static_cast<int>(0.5 * double(1 + clip.x / clip.w) * image.width()),
            static_cast<int>(0.5 * double(1 - clip.y / clip.w) * image.height())};
  }

  static bool hasColour(const QImage& image, const QPoint& at, fsr::view::Colour colour, int tolerance) {
    const QColor pixel = image.pixelColor(at);
    return std::abs(pixel.red() - colour.red) <= tolerance &&
           std::abs(pixel.green() - colour.green) <= tolerance &&
           std::abs(pixel.blue() - colour.blue) <= tolerance;
  }

  static std::size_t rightTaxels(const std::vector<float>& values, const fsr::view::PressureScale& scale,
                                 int tolerance) {
    const QImage image = picture();
    std::size_t right = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      right += hasColour(image, place(i, image), scale.colour(double(values[i])), tolerance);
    }
    return right;
  }

  static std::size_t greyTaxels() {
    const QImage image = picture();
    std::size_t grey = 0;
    for (std::size_t i = 0; i < map->pressure.size(); ++i) {
      grey += hasColour(image, place(i, image), fsr::view::kNoReadingColour, 2);
    }
    return grey;
  }

  static rviz::VisualizationFrame* frame;
  static ros::NodeHandle* handle;
  static ros::Publisher maps, curvature;
  static PressureMap::ConstPtr map;
  static SurfaceCurvature::ConstPtr surface;
  static rviz::Display* display;
};

rviz::VisualizationFrame* Rviz::frame = nullptr;
ros::NodeHandle* Rviz::handle = nullptr;
ros::Publisher Rviz::maps, Rviz::curvature;
PressureMap::ConstPtr Rviz::map;
SurfaceCurvature::ConstPtr Rviz::surface;
rviz::Display* Rviz::display = nullptr;

TEST_F(Rviz, A1SaysThatNoMapHasCome) {
  EXPECT_EQ(display->getClassId(), "fsr_pressure_map/PressureMap");  // not rviz's FailedDisplay
  EXPECT_TRUE(runUntil([] { return says("Messages", "no map has come on /fsr/pressure_map"); }, false));
  EXPECT_TRUE(says("Curvature", "drawn flat"));
}

TEST_F(Rviz, A2SaysWhyAnUncalibratedMapShowsNoPressure) {
  PressureMap uncalibrated = *map;
  uncalibrated.state = PressureMap::STATE_UNCALIBRATED;
  uncalibrated.pressure.assign(uncalibrated.pressure.size(), NAN);
  const auto publish = [&] {
    maps.publish(uncalibrated);
    return says("State", "uncalibrated");
  };
  EXPECT_TRUE(runUntil(publish, false));
  EXPECT_TRUE(says("Taxels", "70 no reading"));
}

TEST_F(Rviz, A3SaysInWhichStateAMapIs) {
  const std::pair<int, std::string> states[] = {
      {PressureMap::STATE_CURVATURE_UNKNOWN, "curvature unknown: fallback in use"},
      {PressureMap::STATE_CURVATURE_STALE, "curvature stale"},
      {PressureMap::STATE_SIZE_MISMATCH, "the calibration is for another matrix size: no pressure to show"},
      {PressureMap::STATE_WRONG_SENSOR,
       "the calibration belongs to another sensor: the pressures are not valid"},
      {PressureMap::STATE_OK, "calibrated"}};
  for (const auto& [state, words] : states) {
    PressureMap other = *map;
    other.state = static_cast<std::uint8_t>(state);
    EXPECT_TRUE(runUntil([&] { return maps.publish(other), status("State") == words; }, false))
        << status("State");
  }
}

TEST_F(Rviz, A4SaysThatAMapCannotBeShown) {
  PressureMap broken = *map;
  broken.pressure.pop_back();
  EXPECT_TRUE(runUntil([&] { return maps.publish(broken), says("State", "69"); }, false)) << status("State");
}

TEST_F(Rviz, A5SaysThatMapsStoppedComing) {
  EXPECT_TRUE(runUntil([] { return says("Messages", "maps are coming"); }));
  EXPECT_TRUE(runUntil([] { return says("Messages", "no map for 2 s on /fsr/pressure_map"); }, false));
}

TEST_F(Rviz, A6SaysThatASurfaceIsOfAnotherMatrix) {
  SurfaceCurvature other;
  other.x = {1.0F, 2.0F, 3.0F};
  curvature.publish(other);
  EXPECT_TRUE(runUntil([] { return says("Curvature", "3"); })) << status("Curvature");
}

TEST_F(Rviz, A7SaysThatTheHistoryIsNotSettled) {
  PressureMap settling = *map;
  settling.flags.assign(settling.flags.size(), PressureMap::FLAG_HISTORY_SHORT);
  const auto shown = [&] { return maps.publish(settling), says("History", "history not settled"); };
  EXPECT_TRUE(runUntil(shown, false)) << status("History");
  EXPECT_EQ(status("Taxels"), "all readings are within range");  // no marks
  EXPECT_TRUE(runUntil([] { return status("History").empty(); })) << status("History");
}

PressureMap flatMap(int rows, int columns) {
  PressureMap map;
  map.header.frame_id = "fsr_matrix";
  map.rows = static_cast<std::uint16_t>(rows);
  map.columns = static_cast<std::uint16_t>(columns);
  map.pitch_x = map.pitch_y = 0.01F;
  map.pressure.assign(static_cast<std::size_t>(rows * columns), 100e3F);
  map.deviation.assign(map.pressure.size(), 1e3F);
  map.flags.assign(map.pressure.size(), 0);
  return map;
}

TEST_F(Rviz, A8ShowsTheWholeSheetOfAnySizeBesideItsLegend) {
  curvature.publish(SurfaceCurvature());
  for (const auto& [rows, columns] : {std::pair{7, 10}, {16, 10}, {3, 4}, {2, 20}}) {
    const PressureMap sized = flatMap(rows, columns);
    const float x = 0.005F * static_cast<float>(columns), y = 0.005F * static_cast<float>(rows);
    QRect place;
    QSize scene;
    const auto fits = [&] {
      maps.publish(sized);
      const QImage image = picture();
      scene = image.size();
      place = QRect();
      for (const Ogre::Vector3& corner : {Ogre::Vector3(-x, -y, 0), Ogre::Vector3(x, -y, 0),
                                          Ogre::Vector3(x, y, 0), Ogre::Vector3(-x, y, 0)})
        place |= QRect(onScreen(corner, image), QSize(1, 1));
      const QRect legend(10, 10, 206, 290);
      return image.rect().contains(place) && !place.intersects(legend) &&
             (place.width() > 0.55 * (scene.width() - legend.right()) ||
              place.height() > 0.55 * scene.height());
    };
    EXPECT_TRUE(runUntil(fits, false))
        << rows << " x " << columns << ": " << place.left() << " to " << place.right() << ", " << place.top()
        << " to " << place.bottom() << " of " << scene.width() << " x " << scene.height();
  }
}

TEST_F(Rviz, A8WritesWhereRowZeroAndTheAxesAre) {
  const PressureMap sized = flatMap(7, 10);
  const auto words = [&](const Ogre::Vector3& at) {  // bright points about it
    const QImage image = picture();
    const QRect box = QRect(onScreen(at, image) - QPoint(25, 12), QSize(50, 24)) & image.rect();
    int bright = 0;
    for (int y = box.top(); y <= box.bottom(); ++y) {
      for (int x = box.left(); x <= box.right(); ++x) bright += image.pixelColor(x, y).value() > 200;
    }
    return bright;
  };
  displayNamed("Grid 1 cm")->setEnabled(false);
  displayNamed("Matrix frame")->setEnabled(false);  // it would hide some taxels, too, as would the letter z
  const std::vector<Ogre::Vector3> places = {
      {-0.0605F, -0.03F, 0}, {-0.045F, -0.0505F, 0}, {0.0545F, 0, 0}, {0, 0.0395F, 0}, {0, 0, 0.0245F}};
  for (const bool shown : {false, true, false}) {
    set("Letters", shown);
    for (const Ogre::Vector3& place : places) {
      EXPECT_TRUE(runUntil([&] { return maps.publish(sized), (words(place) > 5) == shown; }, false))
          << place << ", shown: " << shown;
    }
  }
  displayNamed("Grid 1 cm")->setEnabled(true);
}

TEST_F(Rviz, A9LeavesTheViewToTheUserWhoMovesIt) {
  rviz::Property* distance = frame->getManager()->getViewManager()->getCurrent()->subProp("Distance");
  distance->setValue(0.5);
  EXPECT_TRUE(runUntil([] { return !display->subProp("Fit View")->getValue().toBool(); }));
  EXPECT_NEAR(distance->getValue().toDouble(), 0.5, 1e-6);
  set("Fit View", true);
  EXPECT_TRUE(runUntil([&] { return distance->getValue().toDouble() < 0.4; }));
}

TEST_F(Rviz, BShowsTheRecordedMapInTheColoursOfItsScale) {
  curvature.publish(surface);
  set("Legend", false);  // it would hide some taxels
  set("Marks", false);
  set("Style", "Cells");
  const auto all = map->pressure.size();
  EXPECT_TRUE(runUntil([&] {
    return says("Curvature", "cylinder_7cm") && rightTaxels(map->pressure, {}, 2) == all;
  })) << rightTaxels(map->pressure, {}, 2)
      << " of " << all << " taxels have their colour";
  EXPECT_TRUE(says("State", "calibrated"));
}

TEST_F(Rviz, BTakesTheRangeOfTheCalibrationInUse) {
  const auto infos = handle->advertise<fsr_pressure_map::CalibrationInfo>("/fsr/calibration_info", 1, true);
  fsr_pressure_map::CalibrationInfo info;
  for (const double high : {250e3, 600e3}) {
    info.pressure_high = high;
    infos.publish(info);
    fsr::view::PressureScale scale;
    scale.high = high;
    EXPECT_TRUE(runUntil([&] { return rightTaxels(map->pressure, scale, 2) == map->pressure.size(); }))
        << high;
  }
}

// The check of colours itself is tested: it detects one wrong taxel, and a picture that is upside down or
// mirrored.
TEST_F(Rviz, CTheCheckOfColoursSeesWhatIsWrong) {
  std::vector<float> other = map->pressure;
  other[36] += 60e3F;
  EXPECT_EQ(rightTaxels(other, {}, 2), other.size() - 1);
  other = map->pressure;
  for (std::size_t row = 0; row < map->rows; ++row) {
    std::reverse(other.begin() + row * map->columns, other.begin() + (row + 1) * map->columns);
  }
  EXPECT_LT(rightTaxels(other, {}, 2), other.size() / 2);
}

TEST_F(Rviz, CShowsATaxelWithoutAReadingInGreyWithItsMark) {
  PressureMap gap = *map;
  gap.pressure[36] = NAN;
  gap.flags[36] = PressureMap::FLAG_DEAD;
  const auto grey = [&](const QPoint& off) {
    const QImage image = picture();
    return hasColour(image, place(36, image) + off, fsr::view::kNoReadingColour, 2);
  };
  const auto publish = [&] { return maps.publish(gap), grey({0, 0}); };
  EXPECT_TRUE(runUntil(publish, false));
  set("Marks", true);
  EXPECT_TRUE(runUntil(
      [&] {
        return maps.publish(gap), !grey({0, 0}) && grey({0, 9});
      },
      false))
      << "a cross goes through the middle and leaves the sides";
  EXPECT_TRUE(says("Taxels", "1 no reading"));
  set("Marks", false);
}

TEST_F(Rviz, CShowsItSmoothlyToo) {
  const QImage cells = picture();
  set("Style", "Smooth");
  const auto all = map->pressure.size();
  EXPECT_TRUE(runUntil([&] { return picture() != cells && rightTaxels(map->pressure, {}, 16) == all; }))
      << rightTaxels(map->pressure, {}, 16) << " of " << all << " taxels have their colour";
}

TEST_F(Rviz, DGreysTheSheetWhenMapsStopButNotWhileAReplayIsPaused) {
  const auto all = map->pressure.size();
  ros::Time::setNow(ros::Time::now());  // the clock of a replay that is paused
  EXPECT_TRUE(runUntil([] { return says("Messages", "the clock stands still"); }, false))
      << status("Messages");
  EXPECT_EQ(rightTaxels(map->pressure, {}, 16), all);
  ros::Time::init();  // the clock runs
  EXPECT_TRUE(runUntil([&] { return greyTaxels() == all; }, false)) << greyTaxels() << " taxels are grey";
  EXPECT_TRUE(runUntil([] { return says("Messages", "the sheet is grey"); }, false)) << status("Messages");
  EXPECT_TRUE(runUntil([&] { return rightTaxels(map->pressure, {}, 16) == all; }));
}

TEST_F(Rviz, DShowsTheDeviationOnItsOwnScale) {
  set("Style", "Cells");
  set("Layer", "Deviation");
  set("High (kPa)", 40);
  fsr::view::PressureScale scale;
  scale.high = 40e3;
  const auto all = map->deviation.size();
  EXPECT_TRUE(runUntil([&] { return rightTaxels(map->deviation, scale, 2) == all; }));
  set("Layer", "Pressure");
  set("High (kPa)", 0);
}

TEST_F(Rviz, EShowsItsLegendFromTheHighEndDown) {
  set("Legend", true);
  const fsr::view::PressureScale scale;
  const auto bar = [&] {
    const QImage image = picture();
    const int x = 30, top = 76, height = 190;  // position of the colour bar in the window [pixels]
    int right = 0;
    for (int i = 0; i < 10; ++i) {
      const double part = (i + 0.5) / 10;
      right += hasColour(image, {x, top + static_cast<int>(part * height)},
                         fsr::view::colourAt(scale.colours, 1 - part), 8);
    }
    return right;
  };
  EXPECT_TRUE(runUntil([&] { return bar() == 10; })) << bar() << " of 10 places of the bar are right";
}

// A scan of the plane x = 30 mm, with the matrix on it, in mm. In the frame of the matrix it is the plane
// z = -1 mm: it is seen beside the sheet, and goes again.
TEST_F(Rviz, EShowsTheScanUnderTheSheet) {
  const std::string folder = QDir::tempPath().toStdString() + "/fsr scan";  // with a space
  QDir().mkpath(QString::fromStdString(folder));
  std::ofstream stl(folder + "/plane.stl", std::ios::binary);
  const float low = -100, high = 100, x = 30;
  const float corners[2][9] = {{x, low, low, x, high, low, x, high, high},
                               {x, low, low, x, high, high, x, low, high}};
  const std::uint32_t count = 2;
  stl << std::string(80, ' ');
  stl.write(reinterpret_cast<const char*>(&count), 4);
  for (const auto& triangle : corners) {
    const float normal[3] = {1, 0, 0};
    stl.write(reinterpret_cast<const char*>(normal), 12).write(reinterpret_cast<const char*>(triangle), 36);
    stl.write("\0\0", 2);
  }
  stl.close();
  std_msgs::Header header;
  header.frame_id = "fsr_matrix";
  // Rows along the mesh's y axis, normal along its x axis: a turn by 120 degrees about (1, 1, 1).
  const fsr::matrix::MeshPlace scan{folder + "/plane.stl", 0.001, {{0.03, 0, 0}, {0.5, 0.5, 0.5, 0.5}}};
  ros::Publisher mesh = handle->advertise<visualization_msgs::Marker>("/fsr/mesh", 1, true);
  const auto beside = [] {  // behind the last row
    const QImage image = picture();
    const QPoint at = onScreen({0, 0.06F, -0.001F}, image);
    return image.rect().contains(at) ? image.pixelColor(at) : QColor();
  };
  displayNamed("Grid 1 cm")->setEnabled(false);
  set("Fit View", false);  // it shows less of what is beside the sheet
  rviz::ViewController* view = frame->getManager()->getViewManager()->getCurrent();
  view->subProp("Distance")->setValue(0.3);
  ASSERT_TRUE(runUntil([&] { return beside() == QColor(48, 48, 48); })) << beside().name().toStdString();
  const QColor before = beside();
  mesh.publish(fsr_ros::toMarker(header, scan));
  EXPECT_TRUE(runUntil([&] { return beside().lightness() > before.lightness() + 10; }))
      << before.lightness() << " without, " << beside().lightness() << " with the scan";
  mesh.publish(fsr_ros::noMesh(header));
  EXPECT_TRUE(runUntil([&] { return beside() == before; }));
  displayNamed("Grid 1 cm")->setEnabled(true);
  set("Fit View", true);
  QDir(QString::fromStdString(folder)).removeRecursively();
}

TEST_F(Rviz, FReadsATaxelOutWhenItIsSelected) {
  set("Legend", false);
  const std::size_t taxel = 36;  // row 3, column 6
  ASSERT_TRUE(runUntil([&] { return rightTaxels(map->pressure, {}, 2) == map->pressure.size(); }));
  const QPoint at = place(taxel, picture());
  rviz::SelectionManager* selection = frame->getManager()->getSelectionManager();
  selection->select(frame->getManager()->getRenderPanel()->getViewport(), at.x() - 2, at.y() - 2, at.x() + 2,
                    at.y() + 2, rviz::SelectionManager::Replace);
  rviz::Property* root = selection->getPropertyModel()->getRoot();
  const auto readOut = [&] { return root->numChildren() > 0 ? root->childAt(0) : nullptr; };
  ASSERT_TRUE(runUntil([&] { return readOut() != nullptr; }));
  EXPECT_EQ(readOut()->getName().toStdString(), "Taxel row 3, column 6");
  EXPECT_EQ(readOut()->subProp("Gauge pressure")->getValue().toString().toStdString(),
            fsr::view::pressureText(double(map->pressure[taxel]), fsr::view::PressureUnit::kKilopascal));
}

// The button's service is this test's own.
TEST_F(Rviz, FMasksTheTaxelThatIsSelected) {
  std::vector<std::uint8_t> mask;
  const boost::function<bool(fsr_pressure_map::SetMask::Request&, fsr_pressure_map::SetMask::Response&)>
      keep = [&](fsr_pressure_map::SetMask::Request& request, fsr_pressure_map::SetMask::Response&) {
        mask = request.mask;
        return true;
      };
  const ros::ServiceServer service = ros::NodeHandle().advertiseService("/fsr/calibration/set_mask", keep);
  for (auto* button : frame->findChildren<QPushButton*>()) {
    if (button->text() == "Mask selected") button->click();
  }
  ASSERT_TRUE(runUntil([&] { return !mask.empty(); }));
  std::vector<std::uint8_t> expected(map->pressure.size(), 0);
  expected[36] = 1;  // selected by the test before
  EXPECT_EQ(mask, expected);
}

TEST_F(Rviz, GHoldsThePeakOfEachTaxelUntilReset) {
  PressureMap low = *map;
  std::vector<float> peaks = map->pressure;
  for (float& pressure : low.pressure) pressure = 100e3f;
  for (float& peak : peaks) peak = std::fmax(peak, 100e3f);
  display->subProp("Style")->setValue("Cells");
  set("Peak Hold", true);
  const auto shows = [](const std::vector<float>& values) {
    return rightTaxels(values, {}, 2) == values.size();
  };
  EXPECT_TRUE(runUntil([&] { return shows(map->pressure); }));
  EXPECT_TRUE(runUntil([&] { return maps.publish(low), shows(peaks); }, false))
      << rightTaxels(peaks, {}, 2) << " of the peaks, " << rightTaxels(map->pressure, {}, 2)
      << " of the map, " << rightTaxels(low.pressure, {}, 2) << " of the last map";
  display->reset();
  EXPECT_TRUE(runUntil([&] { return maps.publish(low), shows(low.pressure); }, false));
  set("Peak Hold", false);
  EXPECT_TRUE(runUntil([&] { return shows(map->pressure); }));
}

TEST_F(Rviz, GShowsTheNumbersAndTheWarningInItsPanel) {
  QString all;
  for (const QLabel* label : frame->findChildren<QLabel*>()) all += label->text() + "\n";
  EXPECT_TRUE(all.contains("Research use, not for diagnosis or fitting decisions"));
  EXPECT_TRUE(all.contains("Contact area"));
  EXPECT_TRUE(all.contains("UNKNOWN: no statistics"));
}

TEST_F(Rviz, GShowsRawCountsOnTheirOwnScale) {
  const auto scan = lastOf<MatrixFrame>("/fsr/raw");
  ros::Publisher raw = handle->advertise<MatrixFrame>("/fsr/raw", 10);
  display->setEnabled(false);
  rviz::Display* counts = frame->getManager()->createDisplay("fsr_pressure_map/RawCounts", "Raw", true);
  for (const auto& [name, value] : std::vector<std::pair<QString, QVariant>>{
           {"Topic", "/fsr/raw"}, {"Style", "Cells"}, {"Marks", false}, {"Legend", false}}) {
    counts->subProp(name)->setValue(value);
  }
  fsr::view::PressureScale scale;
  scale.high = scan->full_scale;
  const std::vector<float> values(scan->counts.begin(), scan->counts.end());
  const auto shown = [&] { return raw.publish(scan), rightTaxels(values, scale, 2) == values.size(); };
  EXPECT_TRUE(runUntil(shown, false)) << rightTaxels(values, scale, 2) << " taxels have their colour";
  MatrixFrame broken = *scan;
  broken.counts.pop_back();
  const auto refused = [&] {
    raw.publish(broken);
    return status("State", counts).find("69 counts, but must have one for each taxel") != std::string::npos;
  };
  EXPECT_TRUE(runUntil(refused, false)) << status("State", counts);
  delete counts;
  display->setEnabled(true);
}

TEST_F(Rviz, HSaysThatTheFixedFrameIsWrong) {
  frame->getManager()->setFixedFrame("nowhere");
  EXPECT_TRUE(runUntil([] { return says("Transform", "nowhere"); })) << status("Transform");
  frame->getManager()->setFixedFrame("fsr_matrix");
  EXPECT_TRUE(runUntil([] { return rightTaxels(map->pressure, {}, 2) == map->pressure.size(); }));
}

TEST_F(Rviz, IOpensEveryShippedConfiguration) {
  const QStringList files = QDir(kConfigs).entryList({"*.rviz"});
  EXPECT_GE(files.size(), 4);
  // A plugin that could not be loaded is replaced by an object that differs in its class only.
  const auto failed = [](const QObject& part) {
    return std::string(typeid(part).name()).find("Failed") != std::string::npos;
  };
  const auto instructions = handle->advertise<fsr_pressure_map::Instruction>("/fsr/instruction", 1, true);
  const auto of_sheet = handle->advertise<fsr_pressure_map::Instruction>("/sheet_1/instruction", 1, true);
  for (const QString& file : files) {
    ASSERT_TRUE(frame->loadDisplayConfigHelper((kConfigs + "/" + file).toStdString(), true));
    for (const QWidget* part : frame->findChildren<QWidget*>())
      EXPECT_FALSE(failed(*part)) << qPrintable(file);
    rviz::DisplayGroup* group = frame->getManager()->getRootDisplayGroup();
    EXPECT_GT(group->numDisplays(), 2) << qPrintable(file);
    for (int i = 0; i < group->numDisplays(); ++i) {
      EXPECT_FALSE(failed(*group->getDisplayAt(i))) << qPrintable(file);
    }
    const auto* gauge = frame->findChild<QWidget*>("gauge");
    ASSERT_NE(gauge, nullptr);
    const auto conducted = [&] {
      const fsr_pressure_map::Instruction any;
      return instructions.publish(any), of_sheet.publish(any), gauge->isVisible();
    };
    EXPECT_TRUE(runUntil(conducted)) << qPrintable(file);
    QApplication::processEvents();
    EXPECT_LE(frame->height(), 800) << qPrintable(file);
    EXPECT_LE(frame->width(), 1280) << qPrintable(file);
    EXPECT_LE(frame->minimumSizeHint().height(), 800) << qPrintable(file);
  }
}

}  // namespace
