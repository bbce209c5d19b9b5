// The panel's numbers and buttons with the real calibration, view and session nodes of panel.test.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <rviz/panel.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_loader.hpp>

#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <array>
#include <atomic>
#include <filesystem>
#include <future>
#include <map>
#include <memory>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "ros/bags/resource_path.h"
#include "ros/live/calibration_health.h"
#include "support/calibration_rig.h"
#include "support/small_calibration.h"
#include "support/small_tables.h"

namespace {

using test_support::CalibrationRig;

const std::filesystem::path kFolder = fsr_ros::rosHome() + "/panel_test";  // as in panel.test
const std::string kFile = kFolder / "calibration.h5";

class Panel : public testing::Test {
 protected:
  Panel() : loader("rviz", "rviz::Panel"), panel(loader.createInstance("fsr_pressure_map/PressurePanel")) {
    panel->initialize(nullptr);
  }

  static void SetUpTestSuite() {
    std::filesystem::remove_all(kFolder);
    std::filesystem::create_directories(kFolder);
  }
  void SetUp() override {
    fsr::calibration::saveCalibration(test_support::smallCalibration({3, 4}, {0.0, 10.0}), kFile);
    rig.identify("board-1");
    rig.lieOn({0.0f}, "flat", 3);
  }

  void listenTo(const QString& sensor) {
    auto* line = panel->findChild<QLineEdit*>("sensor");
    line->setText(sensor);
    Q_EMIT line->editingFinished();
  }

  std::string label(const char* name) {
    auto* found = panel->findChild<QLabel*>(name);
    return found == nullptr ? "no such label" : found->text().toStdString();
  }

  bool says(const char* name, const std::string& words) {
    return label(name).find(words) != std::string::npos;
  }

  void press(const QString& name) {
    for (auto* button : panel->findChildren<QPushButton*>()) {
      if (button->text() == name) button->click();
    }
  }

  bool isEnabled(const QString& name) {
    for (const auto* button : panel->findChildren<QPushButton*>()) {
      if (button->text() == name) return button->isEnabled();
    }
    return false;
  }

  bool isHidden(const QString& name) {
    for (const auto* button : panel->findChildren<QPushButton*>()) {
      if (button->text() == name) return button->isHidden();
    }
    return false;
  }

  /// Runs the panel while scans of `code` are published, until `done`; false after 30 s.
  bool runUntil(const std::function<bool()>& done, std::uint16_t code = 50) {
    return test_support::await([&] {
      rig.publishScan(code);
      QApplication::processEvents(QEventLoop::AllEvents, 10);
      return done();
    });
  }

  pluginlib::ClassLoader<rviz::Panel> loader;
  boost::shared_ptr<rviz::Panel> panel;
  CalibrationRig rig;
};

TEST_F(Panel, SaysWhichNodesItWaitsFor) {
  listenTo("/nobody");
  ASSERT_TRUE(runUntil([&] { return says("waiting", "Nothing on /nobody/calibration_info"); }));
  EXPECT_TRUE(says("waiting", "Nothing on /nobody/statistics: the numbers need the view node."));
  EXPECT_TRUE(says("waiting", "Nothing on /nobody/session: events can be marked while record.launch runs."));
  EXPECT_TRUE(says("Alarms", "UNKNOWN: no statistics"));
  press("Tare");
  EXPECT_TRUE(runUntil([&] { return says("reply", "there is no service /nobody/calibration/tare"); }));
  press("Mark event");
  EXPECT_TRUE(runUntil([&] { return says("reply", "there is no service /nobody/session/mark"); }));
}

TEST_F(Panel, ShowsTheSheetsOfALimbAndTheirSums) {
  ros::NodeHandle handle;
  const auto diagnostics = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  const auto statistics = [&](const std::string& topic, double peak, double force) {
    fsr_pressure_map::PressureStatisticsArray array;
    array.regions.resize(2);
    array.regions[0].peak = peak;
    array.regions[0].force = force;
    array.regions[0].saturated = peak > 300e3 ? 1 : 0;
    array.regions[0].alarm = array.regions[1].alarm = 3;
    array.regions[1].region = "toe";
    if (peak > 300e3) array.regions[1].alarm = fsr_pressure_map::PressureStatistics::ALARM;
    static std::map<std::string, ros::Publisher> to;
    if (!to[topic]) to[topic] = handle.advertise<fsr_pressure_map::PressureStatisticsArray>(topic, 10);
    to[topic].publish(array);
  };
  const auto lines = [&](const std::string& words, const std::vector<const char*>& sheets,
                         const std::string& serial) {
    return runUntil([&] {
      diagnostic_msgs::DiagnosticArray array;
      array.status.resize(1);
      array.status[0].name = "limb/limb: sheets";
      array.status[0].level = serial.empty() ? 0 : 2;
      array.status[0].message = serial;
      for (const char* sheet : sheets) {
        array.status[0].values.emplace_back();
        array.status[0].values.back().key = sheet;
      }
      diagnostics.publish(array);
      statistics("/left/statistics", 200e3, 12.5);
      statistics("/right/statistics", 402e3, 30);
      return label("sheets") == words;
    });
  };
  listenTo("/left");
  auto* shown = panel->findChild<QLabel*>("sheets");
  ASSERT_NE(shown, nullptr);
  EXPECT_TRUE(lines("", {"/another", "/third"}, "")) << label("sheets");
  EXPECT_TRUE(shown->isHidden()) << "not a sheet of that limb";
  EXPECT_TRUE(
      lines("all: peak >= 402 kPa, force >= 42.5 N (without back)\n"
            "back: no statistics, peak -, force -\n"
            "left: no maps, peak 200 kPa, force 12.5 N\n"
            "right: ALARM (toe), no maps, peak >= 402 kPa, force >= 30.0 N",
            {"/back", "/left", "/right"}, "/left and /right have the same serial number"))
      << label("sheets");
  EXPECT_FALSE(shown->isHidden());
  EXPECT_TRUE(says("waiting", "Sheets: /left and /right have the same serial number")) << label("waiting");
  listenTo("/fsr");
  EXPECT_TRUE(runUntil([&] { return shown->isHidden(); }));
}

TEST_F(Panel, ForgetsOldAnswers) {
  rviz::Config config;
  config.mapSetValue("Sensor", "/nobody");
  config.mapSetValue("Answers Shown (s)", 0.5F);
  panel->load(config);
  press("Tare");
  EXPECT_TRUE(runUntil([&] { return says("reply", "there is no service"); }));
  EXPECT_TRUE(runUntil([&] { return label("reply").empty(); }));
  press("Mask selected");  // another sensor's answer goes at once
  EXPECT_FALSE(label("reply").empty());
  listenTo("/fsr");
  EXPECT_EQ(label("reply"), "");
}

TEST_F(Panel, ShowsTheInstructionAndSendsThePersonsAnswers) {
  ros::NodeHandle handle("/fsr");
  auto* conductor = panel->findChild<QWidget*>("conductor");
  ASSERT_NE(conductor, nullptr);
  EXPECT_TRUE(conductor->isHidden());
  std::string answered;
  const auto answer = [&](const std::string& name) {
    return handle.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
        "conduct/" + name,
        [&answered, name](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& reply) {
          reply.message = "done: " + name;
          answered = name;
          return true;
        });
  };
  const std::vector<ros::ServiceServer> services = {answer("confirm"), answer("skip"), answer("accept"),
                                                    answer("reject")};
  const auto pictures = handle.advertise<sensor_msgs::Image>("session_coverage", 1, true);
  sensor_msgs::Image picture;
  picture.encoding = "rgb8";
  picture.width = 40;
  picture.height = 30;
  picture.step = 120;
  picture.data.assign(3600, 200);
  pictures.publish(picture);
  const auto instructions = handle.advertise<fsr_pressure_map::Instruction>("instruction", 10, true);
  fsr_pressure_map::Instruction now;
  now.kind = now.CYCLE;
  now.step = 3;
  now.steps = 40;
  now.text = "Cycle 1 of 10: fill.";
  now.remark = "last attempt rejected: leak";
  instructions.publish(now);
  ASSERT_TRUE(runUntil([&] { return label("instruction") == "Step 3 of 40: Cycle 1 of 10: fill."; }));
  EXPECT_FALSE(conductor->isHidden());
  EXPECT_EQ(label("remark"), "Last attempt rejected: leak");
  EXPECT_FALSE(isEnabled("Confirm"));
  ASSERT_TRUE(runUntil([&] { return panel->findChild<QLabel*>("coverage")->sizeHint() == QSize(40, 30); }));
  now.confirm = true;
  now.remark = "";
  instructions.publish(now);
  ASSERT_TRUE(runUntil([&] { return isEnabled("Confirm"); }));
  for (const char* name : {"Confirm", "Accept", "Reject", "Skip"}) {
    press(name);
    const std::string service = QString(name).toLower().toStdString();
    EXPECT_TRUE(runUntil([&] { return says("reply", "done: " + service); })) << label("reply");
    EXPECT_EQ(answered, service);
  }
  EXPECT_TRUE(says("reply", "done: skip"));
  now.kind = now.DONE;
  now.text = "The session is over.";
  now.confirm = false;
  instructions.publish(now);
  EXPECT_TRUE(runUntil([&] { return label("instruction") == now.text && label("reply").empty(); }))
      << "the answer to an instruction goes with it: " << label("reply");
  press("Reload calibration");
  ASSERT_TRUE(runUntil([&] { return says("reply", "reload"); }));
  EXPECT_FALSE(isEnabled("Confirm")) << "a call does not wake it";
}

TEST_F(Panel, ShowsThePressureBesideItsTargetLargeEnoughForTheValves) {
  ros::NodeHandle handle("/conducted");
  const auto instructions = handle.advertise<fsr_pressure_map::Instruction>("instruction", 10, true);
  const auto chamber = handle.advertise<sensor_msgs::FluidPressure>("chamber_pressure", 10, true);
  listenTo("/conducted");
  panel->resize(490, 690);
  panel->show();
  auto* gauge = panel->findChild<QWidget*>("gauge");
  ASSERT_NE(gauge, nullptr);
  fsr_pressure_map::Instruction now;
  now.kind = now.CYCLE;
  now.step = 3;
  now.steps = 40;
  now.peak = 600e3;
  const auto says = [&](double kilopascal, const std::string& words) {
    sensor_msgs::FluidPressure reading;
    reading.fluid_pressure = 101325 + 1000 * kilopascal;
    return runUntil([&] {
      instructions.publish(now);
      chamber.publish(reading);
      return gauge->accessibleName().toStdString() == words;
    });
  };
  EXPECT_TRUE(says(300, "now 300 kPa, target 600 kPa")) << gauge->accessibleName().toStdString();
  // The bar ends at 660 kPa.
  const QImage picture = gauge->grab().toImage();
  const auto isInk = [&](int x, int y) {
    const QColor colour = picture.pixelColor(x, y);
    return colour.blue() > colour.red() + 50;
  };
  const auto isFull = [&](double part) {
    return isInk(static_cast<int>(part * picture.width()), picture.height() - 12);
  };
  EXPECT_TRUE(isFull(0.05) && isFull(0.4));
  EXPECT_FALSE(isFull(0.5) || isFull(0.98));
  int digits = 0;  // rows in which the present pressure is written
  for (int row = 0; row < picture.height() - 40; ++row) {
    int ink = 0;
    for (int x = 0; x < picture.width() / 2; ++x) ink += isInk(x, row);
    digits += ink > 0;
  }
  EXPECT_GT(digits, 40) << "a centimetre on a usual screen";
  EXPECT_TRUE(says(598, "now 598 kPa, target 600 kPa")) << gauge->accessibleName().toStdString();
  EXPECT_TRUE(says(500, "now 500 kPa, target 0.0 kPa")) << gauge->accessibleName().toStdString();
  EXPECT_TRUE(says(2, "now 2.0 kPa, target 600 kPa")) << "the next attempt";
  now.low = 200e3;
  now.kind = now.LOOP;
  ++now.step;
  EXPECT_TRUE(says(600, "now 600 kPa, target 600 kPa")) << gauge->accessibleName().toStdString();
  EXPECT_TRUE(says(400, "now 400 kPa, target 200 kPa")) << gauge->accessibleName().toStdString();
  now.kind = now.REST;
  EXPECT_TRUE(says(400, "now 400 kPa, target 0.0 kPa")) << gauge->accessibleName().toStdString();
  now.kind = now.DONE;
  EXPECT_TRUE(says(400, "now 400 kPa, target -")) << gauge->accessibleName().toStdString();
}

// A service may answer late, or never; the window closes all the same.
TEST_F(Panel, EndsWhileItWaitsForAService) {
  ros::CallbackQueue queue;
  ros::NodeHandle handle("/slow");
  handle.setCallbackQueue(&queue);
  std::promise<void> closed;
  std::atomic<bool> called{false}, in_time{false};
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> answer =
      [&](std_srvs::Trigger::Request&, std_srvs::Trigger::Response&) {
        called = true;
        in_time = closed.get_future().wait_for(std::chrono::seconds(20)) == std::future_status::ready;
        return true;
      };
  const auto service = handle.advertiseService("calibration/tare", answer);
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  listenTo("/slow");
  press("Tare");
  ASSERT_TRUE(runUntil([&] { return called.load(); }));
  panel.reset();
  closed.set_value();
  spinner.stop();
  EXPECT_TRUE(in_time);
}

TEST_F(Panel, KeepsItsButtonsInTheirPlacesDuringASession) {
  ros::NodeHandle handle("/conducted");
  const auto instructions = handle.advertise<fsr_pressure_map::Instruction>("instruction", 10, true);
  const auto pictures = handle.advertise<sensor_msgs::Image>("session_coverage", 1, true);
  listenTo("/conducted");
  panel->resize(500, 1000);
  panel->show();
  fsr_pressure_map::Instruction now;
  now.steps = 400;
  const auto places = [&](const std::string& said, const std::string& remark, bool confirm) {
    ++now.step;
    now.text = said;
    now.remark = remark;
    now.confirm = confirm;
    instructions.publish(now);
    EXPECT_TRUE(runUntil([&] { return says("instruction", "Step " + std::to_string(now.step) + " "); }));
    EXPECT_EQ(isEnabled("Confirm"), confirm);
    EXPECT_FALSE(isHidden("Confirm"));
    QApplication::sendPostedEvents();  // layouts
    std::map<std::string, std::array<int, 4>> found;
    for (const auto* button : panel->findChildren<QPushButton*>()) {
      if (!button->isVisible()) continue;
      const QPoint corner = button->mapTo(panel.get(), QPoint(0, 0));
      found[button->text().toStdString()] = {corner.x(), corner.y(), button->width(), button->height()};
    }
    return found;
  };
  const std::string again =
      "Vent to rest, then again: Cycle 10 of 10: fill to 620 kPa at 17 kPa/s, hold for 1 s, vent at 17 "
      "kPa/s. 3 attempts were rejected: skip this step, or accept the last attempt, to go on.";
  const std::string why =
      "the chamber does not go down: 130 kPa; rejected: the pressure turned at 500 kPa, planned are 620 kPa";
  const auto first = places("Rest.", "", false);
  ASSERT_EQ(first.count("Accept"), 1u);
  ASSERT_EQ(first.count("Tare"), 1u);
  EXPECT_EQ(places(again, "", false), first);
  EXPECT_EQ(places(again, why, false), first);
  EXPECT_EQ(places("Put the sheet on flat.", why + "; " + why, true), first);
  EXPECT_EQ(label("remark"), panel->findChild<QLabel*>("remark")->toolTip().toStdString());
  press("Reject");
  ASSERT_TRUE(runUntil([&] { return says("reply", "there is no service /conducted/conduct/reject"); }));
  EXPECT_EQ(places("Rest.", "", true), first) << "with an answer";
  sensor_msgs::Image picture;
  picture.encoding = "rgb8";
  picture.width = 400;
  picture.height = 200;
  picture.step = 1200;
  picture.data.assign(240000, 200);
  pictures.publish(picture);
  ASSERT_TRUE(runUntil([&] { return panel->findChild<QLabel*>("coverage")->sizeHint().height() == 200; }));
  EXPECT_EQ(places("Rest.", "", true), first) << "with the coverage";
}

TEST_F(Panel, SaysThatARejectionIsTheLastAttempts) {
  ros::NodeHandle handle("/conducted");
  const auto instructions = handle.advertise<fsr_pressure_map::Instruction>("instruction", 10, true);
  listenTo("/conducted");
  fsr_pressure_map::Instruction now;
  const auto shown = [&](const std::string& remark, const std::string& expected) {
    now.remark = remark;
    instructions.publish(now);
    return runUntil([&] { return label("remark") == expected; });
  };
  EXPECT_TRUE(shown("last attempt rejected: by a person", "Last attempt rejected: by a person"))
      << label("remark");
  EXPECT_TRUE(
      shown("no scan for 2 s; last attempt rejected: leak", "No scan for 2 s; last attempt rejected: leak"))
      << label("remark");
  EXPECT_TRUE(shown("", "")) << label("remark");
}

// 12 taxels of 1 cm x 1.2 cm.
TEST_F(Panel, ShowsTheNumbersOfTheRunningNodes) {
  ASSERT_TRUE(runUntil([&] { return says("Contact area", "14.4 cm"); }, 500)) << label("waiting");
  EXPECT_TRUE(says("Surface, mount", "flat, 3"));
  EXPECT_TRUE(runUntil([&] { return says("Peak", "50 kPa \u00b1 1.0 kPa, row "); }, 500)) << label("Peak");
  EXPECT_TRUE(runUntil([&] { return says("Session", "2026-03-01"); }));
  EXPECT_TRUE(runUntil([&] { return says("Calibration", "per_curvature"); })) << label("Calibration");
  EXPECT_TRUE(runUntil([&] { return label("waiting").empty(); })) << label("waiting");
}

TEST_F(Panel, SaysWhatTheDriverComplainsAbout) {
  ros::NodeHandle handle;
  const auto publisher = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(2);
  array.status[0].name = "fsr/driver: link";
  array.status[0].level = diagnostic_msgs::DiagnosticStatus::ERROR;
  array.status[0].message = "the board is silent";
  array.status[1] = array.status[0];
  array.status[1].name = "other/driver: link";
  array.status[1].message = "another sensor";
  EXPECT_TRUE(runUntil([&] {
    publisher.publish(array);
    return says("waiting", "Driver: the board is silent");
  })) << label("waiting");
  EXPECT_FALSE(says("waiting", "another sensor"));
  array.status[0].level = diagnostic_msgs::DiagnosticStatus::OK;
  EXPECT_TRUE(runUntil([&] {
    publisher.publish(array);
    return !says("waiting", "Driver");
  })) << label("waiting");
}

// The diagnostics of a calibration node of the sensor /bent.
diagnostic_msgs::DiagnosticArray comparison(const std::string& verdict, const std::string& sentence,
                                            const std::string& source) {
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(1);
  array.status[0].name = "bent/calibration: calibration";
  for (const auto& [key, value] : {std::pair{fsr_ros::kRestVerdictKey, verdict},
                                   {fsr_ros::kRestKey, sentence},
                                   {fsr_ros::kCurvatureSourceKey, source}}) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    array.status[0].values.push_back(pair);
  }
  return array;
}

TEST_F(Panel, SaysWhetherTheSheetRestsAsTheSurfaceSays) {
  ros::NodeHandle handle;
  const auto publisher = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  listenTo("/bent");
  const auto shown = [&](const std::string& words, const diagnostic_msgs::DiagnosticArray& array) {
    return runUntil([&] {
      publisher.publish(array);
      return label("Sheet at rest") == words;
    });
  };
  const std::string agrees =
      "the sheet rests as on 5.0 cm (4.9 cm to 5.1 cm), which agrees with cylinder_5cm";
  EXPECT_TRUE(shown(agrees, comparison(fsr_ros::kRestAgrees, agrees, fsr_ros::kCurvaturePublished)));
  EXPECT_TRUE(panel->findChild<QLabel*>("Sheet at rest")->styleSheet().isEmpty());
  const std::string wrong = "the sheet rests as on 5.0 cm, but the surface file says cylinder_9cm (9.0 cm)";
  EXPECT_TRUE(
      shown("DISAGREES: " + wrong, comparison(fsr_ros::kRestDisagrees, wrong, fsr_ros::kCurvaturePublished)));
  EXPECT_FALSE(panel->findChild<QLabel*>("Sheet at rest")->styleSheet().isEmpty());
  const std::string open = "how the sheet lies cannot be told: the readings at rest fit none of the bends";
  EXPECT_TRUE(shown(open, comparison(fsr_ros::kRestUnknown, open, fsr_ros::kCurvaturePublished)));
  EXPECT_TRUE(panel->findChild<QLabel*>("Sheet at rest")->styleSheet().isEmpty());
  EXPECT_TRUE(runUntil([&] { return label("Sheet at rest") == "-"; })) << "a node that has died says nothing";
}

TEST_F(Panel, SaysWhatWasDoneAtTheLastDoff) {
  ros::NodeHandle handle;
  const auto publisher = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  listenTo("/bent");
  const auto shown = [&](const std::string& words, const std::string& marked) {
    auto array = comparison(fsr_ros::kRestAgrees, "it agrees", fsr_ros::kCurvaturePublished);
    diagnostic_msgs::KeyValue pair;
    pair.key = fsr_ros::kMarkedRestKey;
    pair.value = marked;
    array.status[0].values.push_back(pair);
    return runUntil([&] {
      publisher.publish(array);
      return label("Sheet at rest") == words;
    });
  };
  EXPECT_TRUE(shown("it agrees\ndoff: being measured", "doff: being measured"));
  EXPECT_TRUE(shown("it agrees", "doff: it agrees")) << "nothing is said twice";
  EXPECT_TRUE(shown("it agrees\ndoff: refused", "doff: refused"));
  EXPECT_TRUE(shown("it agrees", fsr_ros::kNoMarkedRest));
}

TEST_F(Panel, OffersToEstimateTheSurfaceWhereTheCalibrationNodeIsItsSource) {
  ros::NodeHandle handle;
  const auto publisher = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  listenTo("/bent");
  EXPECT_TRUE(isHidden("Estimate surface"));
  const auto hidden = [&](bool expected, const char* source) {
    return runUntil([&] {
      publisher.publish(comparison(fsr_ros::kRestOpen, fsr_ros::kRestOpen, source));
      return isHidden("Estimate surface") == expected;
    });
  };
  EXPECT_TRUE(hidden(false, fsr_ros::kCurvatureEstimated));
  press("Estimate surface");
  EXPECT_TRUE(
      runUntil([&] { return says("reply", "there is no service /bent/calibration/estimate_surface"); }));
  EXPECT_TRUE(hidden(true, fsr_ros::kCurvaturePublished));
}

// The calibration of this test has learnt no shape.
TEST_F(Panel, SaysWhyTheRunningNodeCannotCompareTheSurface) {
  EXPECT_TRUE(runUntil([&] { return says("Sheet at rest", "how the sheet lies cannot be told: "); }))
      << label("Sheet at rest");
  press("Check surface");
  EXPECT_TRUE(runUntil([&] { return says("reply", "how the sheet lies cannot be told: "); }))
      << label("reply");
}

TEST_F(Panel, SaysThatNoAlarmIsSetAndSetsOne) {
  EXPECT_TRUE(runUntil([&] { return says("Alarms", "no alarm set"); }, 500)) << label("Alarms");
  panel->findChild<QLineEdit*>("alarm threshold")->setText("forty");
  press("Set alarm");
  EXPECT_TRUE(says("reply", "\"forty\" is no threshold")) << label("reply");
  panel->findChild<QLineEdit*>("alarm threshold")->setText("40");
  press("Set alarm");
  EXPECT_TRUE(runUntil([&] { return says("reply", "alarm of the whole matrix at 40 kPa"); }, 500));
  EXPECT_TRUE(runUntil([&] { return says("Alarms", "ALARM: whole matrix"); }, 500)) << label("Alarms");
}

// The alarm of the test before is set.
TEST_F(Panel, SaysWhyAnAlarmIsUnknown) {
  panel->findChild<QLineEdit*>("alarm threshold")->setText("400");
  press("Set alarm");
  EXPECT_TRUE(runUntil([&] { return says("Alarms", "UNKNOWN: whole matrix (12 saturated)"); },
                       test_support::kRigFullScale))
      << label("Alarms");
  EXPECT_TRUE(says("Peak", ">= ")) << label("Peak");
  EXPECT_TRUE(says("Force", ">= ")) << label("Force");
}

TEST_F(Panel, TaresTheSheet) {
  ASSERT_TRUE(runUntil([&] { return says("Calibration", "per_curvature"); }));
  press("Tare");
  EXPECT_TRUE(runUntil([&] { return says("reply", "tare.yaml"); })) << label("reply");
  EXPECT_TRUE(runUntil([&] {
    return !rig.maps().empty() && rig.maps().back()->flags[0] == fsr_pressure_map::PressureMap::FLAG_TARED;
  }));
  EXPECT_TRUE(runUntil([&] { return says("Calibration", ", tared"); })) << label("Calibration");
}

TEST_F(Panel, SaysThatTheHistoryIsNotSettledAndOfWhatACalibrationIsACorrection) {
  ros::NodeHandle handle;
  const auto maps = handle.advertise<fsr_pressure_map::PressureMap>("/settling/pressure_map", 10);
  const auto infos = handle.advertise<fsr_pressure_map::CalibrationInfo>("/settling/calibration_info", 10);
  listenTo("/settling");
  fsr_pressure_map::CalibrationInfo info;
  info.id = "0123456789abcdef";
  info.scheme = "per_curvature";
  fsr_pressure_map::PressureMap map;
  map.rows = 1;
  map.columns = 4;
  map.pressure.assign(4, 1e3f);
  map.deviation.assign(4, 1e2f);
  map.flags.assign(4, fsr_pressure_map::PressureMap::FLAG_HISTORY_SHORT);
  const auto shown = [&](const std::string& words) {
    maps.publish(map);
    infos.publish(info);
    return label("Calibration") == "per_curvature, 0123456789ab" + words;
  };
  EXPECT_TRUE(runUntil([&] { return shown(", history not settled"); })) << label("Calibration");
  map.flags = {0, 0, fsr_pressure_map::PressureMap::FLAG_HISTORY_SHORT, 0};
  EXPECT_TRUE(runUntil([&] { return shown(", history not settled on 25 % of taxels"); }))
      << label("Calibration");
  map.flags.assign(4, 0);
  EXPECT_TRUE(runUntil([&] { return shown(""); })) << label("Calibration");
  info.parent = "ba9876543210";
  info.corrected = "2026-11-23T14:05:00Z";
  EXPECT_TRUE(runUntil([&] { return shown(", corrected on 2026-11-23 from ba9876543210"); }))
      << label("Calibration");
}

TEST_F(Panel, SaysHowToMaskTaxels) {
  press("Mask selected");
  EXPECT_TRUE(says("reply", "Select taxels of the map with the tool Select first.")) << label("reply");
}

TEST_F(Panel, ReloadsTheCalibration) {
  const std::string id =
      fsr::calibration::saveCalibration(test_support::smallCalibration({3, 4}, {0.0, 30.0}), kFile);
  press("Reload calibration");
  EXPECT_TRUE(runUntil([&] { return says("reply", kFile); })) << label("reply");
  EXPECT_TRUE(runUntil([&] { return says("Calibration", id.substr(0, 12)); })) << label("Calibration");
}

TEST_F(Panel, MarksAnEvent) {
  std::vector<fsr_pressure_map::Event> events;
  ros::NodeHandle handle;
  const ros::Subscriber ear = handle.subscribe<fsr_pressure_map::Event>(
      "events", 10, [&](const fsr_pressure_map::Event::ConstPtr& event) { events.push_back(*event); });
  ASSERT_TRUE(runUntil([&] { return ear.getNumPublishers() > 0 && says("Session", "2026-03-01"); }));
  panel->findChild<QLineEdit*>("label")->setText("socket don");
  press("Mark event");
  ASSERT_TRUE(runUntil([&] { return !events.empty(); }));
  EXPECT_EQ(events.front().kind, "note");
  EXPECT_EQ(events.front().label, "socket don");
  EXPECT_TRUE(runUntil([&] { return says("reply", "marked note 'socket don'"); })) << label("reply");
}

TEST_F(Panel, ShowsTheWarningOfResearchUse) {
  QString all;
  for (const QLabel* part : panel->findChildren<QLabel*>()) all += part->text() + "\n";
  EXPECT_TRUE(all.contains("Research use, not for diagnosis or fitting decisions"));
}

}  // namespace
