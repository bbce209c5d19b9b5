#include <fsr_pressure_map/SetSurface.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "support/board_listener.h"
#include "support/ros_listener.h"

namespace {

using test_support::BoardListener;

std::string port() {
  std::string path;
  EXPECT_TRUE(ros::param::get("rig_emulator/link", path));
  return path;
}

std::string command(const std::string& name) {
  const auto reply = test_support::call<std_srvs::Trigger>("rig_emulator/" + name);
  EXPECT_TRUE(reply.success);
  return reply.message;
}

fsr_pressure_map::SetSurface::Response layOn(const std::string& surface, std::uint32_t mount) {
  fsr_pressure_map::SetSurface::Request request;
  request.surface = surface;
  request.mount = mount;
  return test_support::call<fsr_pressure_map::SetSurface>("rig_emulator/set_surface", request);
}

std_srvs::SetBool::Response switchOn(const std::string& name, bool on) {
  std_srvs::SetBool::Request request;
  request.data = on;
  return test_support::call<std_srvs::SetBool>("rig_emulator/" + name, request);
}

std_srvs::SetBool::Response setDamage(bool damaged) {
  return switchOn("set_damage", damaged);
}

/// Mean counts of the last scan.
double meanOf(const BoardListener& listener) {
  double sum = 0;
  for (const std::uint16_t count : listener.scans.back().counts) sum += count;
  return sum / static_cast<double>(listener.scans.back().counts.size());
}

/// Keeps `~status`, because a status may have ended before the test checks it.
class Status {
 public:
  bool becomes(const std::string& status) const {
    return test_support::await([&] {
      return std::any_of(heard_.messages.begin(), heard_.messages.end(),
                         [&](const auto& heard) { return heard->data == status; });
    });
  }

 private:
  test_support::Listener<std_msgs::String> heard_{"rig_emulator/status"};
};

TEST(RigEmulatorNode, RunsItsCyclesOnRequestAndSaysWhenTheyAreDone) {
  Status status;
  EXPECT_TRUE(status.becomes("idle 0"));
  const ros::Time started = ros::Time::now();
  EXPECT_EQ(command("start"), "run 1: 2 cycles to 300 kPa gauge, 12 s each");
  EXPECT_TRUE(status.becomes("running 1"));
  EXPECT_TRUE(status.becomes("done 1"));
  EXPECT_GT((ros::Time::now() - started).toSec(), 23.5) << "two cycles of 12 s in rig time";
}

TEST(RigEmulatorNode, ANewRunUsesThePresentParameters) {
  ros::param::set("rig_emulator/chamber/cycles", 1);
  ros::param::set("rig_emulator/chamber/peak", 120000.0);
  EXPECT_EQ(command("start"), "run 2: 1 cycle to 120 kPa gauge, 6 s each");
  Status status;
  EXPECT_TRUE(status.becomes("done 2"));
  ros::param::set("rig_emulator/chamber/peak", 800000.0);
  const auto refused = test_support::call<std_srvs::Trigger>("rig_emulator/start");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("793000 Pa"), std::string::npos) << refused.message;
  ros::param::del("rig_emulator/chamber");
}

TEST(RigEmulatorNode, StopsOnRequest) {
  ros::param::set("rig_emulator/chamber/cycles", 500);  // so many that the run is stopped before its end
  command("start");
  command("stop");
  ros::param::del("rig_emulator/chamber");
  Status status;
  EXPECT_TRUE(status.becomes("stopped 3"));
}

TEST(RigEmulatorNode, PublishesRigTimeDenselyAndInOrder) {
  std::vector<double> clock;
  ros::NodeHandle handle;
  const auto subscriber = handle.subscribe<rosgraph_msgs::Clock>(
      "/clock", 10000, [&](const rosgraph_msgs::Clock::ConstPtr& m) { clock.push_back(m->clock.toSec()); });
  ASSERT_TRUE(test_support::await([&] { return !clock.empty() && clock.back() - clock.front() > 10; }));
  EXPECT_TRUE(std::is_sorted(clock.begin(), clock.end()));
  double widest = 0;
  for (std::size_t i = 1; i < clock.size(); ++i) widest = std::max(widest, clock[i] - clock[i - 1]);
  EXPECT_LE(widest, 0.0501) << "20 scans a second, each with its /clock";
}

TEST(RigEmulatorNode, ChangesTheSurfaceUnderTheMatrix) {
  BoardListener listener(port());
  ASSERT_TRUE(listener.untilScans(10));
  const double flat = meanOf(listener);
  const auto reply = layOn("cylinder_7cm", 5);
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.message, "the emulated matrix lies on cylinder_7cm (mount 5)");
  EXPECT_TRUE(listener.until([&] { return meanOf(listener) > flat + 100; })) << "the preload of the bend";
  EXPECT_NE(layOn("flat", 0).message.find("mount 6"), std::string::npos);
  const auto refused = layOn("cylinder_6cm", 0);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("cylinder_7cm"), std::string::npos) << "lists what there is";
}

TEST(RigEmulatorNode, DamagesTheLineByItsParametersAndEndsTheDamage) {
  ros::param::set("rig_emulator/damage/unplug", true);
  EXPECT_NE(setDamage(true).message.find("unplugged"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(port()));
  EXPECT_TRUE(setDamage(false).success);
  EXPECT_TRUE(std::filesystem::exists(port()));

  ros::param::del("rig_emulator/damage");
  ros::param::set("rig_emulator/damage/flipped_bits", 0.002);
  BoardListener listener(port());
  EXPECT_TRUE(setDamage(true).success);
  EXPECT_TRUE(listener.until([&] { return listener.counts().bad_packet_check > 3; }));
  ros::param::set("rig_emulator/damage/lost_bytes", 2.0);
  const auto refused = setDamage(true);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("damage/lost_bytes is 2"), std::string::npos) << refused.message;
  ros::param::del("rig_emulator/damage");
  EXPECT_TRUE(setDamage(false).success);
}

TEST(RigEmulatorNode, SendsAnEdgeOfTheTrigger) {
  BoardListener listener(port());
  for (const bool high : {true, false}) {
    EXPECT_EQ(switchOn("set_trigger", high).message,
              std::string(high ? "a rising" : "a falling") + " edge at the trigger input");
  }
  ASSERT_TRUE(listener.until([&] { return listener.triggers.size() == 2; }));
  EXPECT_EQ(listener.triggers, (std::vector<bool>{true, false}));
}

TEST(RigEmulatorNode, AResetRestartsTheBoard) {
  BoardListener listener(port());
  ASSERT_TRUE(listener.until([&] { return !listener.scans.empty() && listener.scans.back().sequence > 40; }));
  ros::param::set("rig_emulator/damage/reset", true);
  EXPECT_TRUE(setDamage(true).success);
  EXPECT_TRUE(
      listener.until([&] { return listener.counts().of(fsr::protocol::PacketType::kScan).restarts == 1; }));
  ros::param::del("rig_emulator/damage");
  EXPECT_TRUE(setDamage(false).success);
}

TEST(RigEmulatorNode, ExitsWithStatusTwoForInvalidSettings) {
  const auto node = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rig_emulator_node";
  const int status =
      std::system((node.string() + " __name:=other _simulation:=/nowhere.yaml > /dev/null 2>&1").c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

}  // namespace
