#include <fsr_pressure_map/Instruction.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <functional>

#include "simulation/settings_text.h"
#include "support/board_listener.h"
#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::Instruction;

/// A very small conductor: it gives instructions and hears what the operator does.
class RigOperatorNode : public testing::Test {
 protected:
  explicit RigOperatorNode(const std::string& sensor = "/fsr") : handle_(sensor) {
    instruction_ = handle_.advertise<Instruction>("instruction", 10, true);
    confirm_ = handle_.advertiseService("conduct/confirm", &RigOperatorNode::onConfirm, this);
    heard_ = handle_.subscribe("rig_emulator/acts", 100, &RigOperatorNode::onAct, this);
    EXPECT_TRUE(test_support::await(
        [this] { return instruction_.getNumSubscribers() > 0 && heard_.getNumPublishers() > 0; }));
  }
  void give(const Instruction& instruction) { instruction_.publish(instruction); }
  bool does(const std::string& act) {
    return test_support::await([&] { return std::count(acts_.begin(), acts_.end(), act) > 0; });
  }
  /// Highest pressure from now on, until the chamber was above 50 kPa and is empty again [Pa].
  double pressPeak() {
    std::string port;
    EXPECT_TRUE(ros::param::get("rig_emulator/link", port));
    test_support::BoardListener board(port);
    double highest = 0;
    EXPECT_TRUE(board.until([&] {
      if (board.transducer.empty()) return false;
      const double now = transducer_.gaugePressure(board.transducer.back().value);
      for (const auto& reading : board.transducer)
        highest = std::max(highest, transducer_.gaugePressure(reading.value));
      return highest > 50e3 && now < 1e3;
    }));
    return highest;
  }

  std::vector<std::string> acts_;
  int confirmed_ = 0;
  fsr::simulation::Transducer transducer_;

 private:
  bool onConfirm(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    ++confirmed_;
    response.success = true;
    return true;
  }
  void onAct(const std_msgs::String& act) { acts_.push_back(act.data); }

  ros::NodeHandle handle_;
  ros::Publisher instruction_;
  ros::ServiceServer confirm_;
  ros::Subscriber heard_;
};

Instruction mount(std::uint32_t step, const std::string& surface) {
  Instruction instruction;
  instruction.kind = Instruction::MOUNT;
  instruction.step = instruction.mount = step;
  instruction.surface = surface;
  instruction.confirm = true;
  return instruction;
}

Instruction cycle(std::uint32_t step, const std::string& remark = "") {
  Instruction instruction;
  instruction.kind = Instruction::CYCLE;
  instruction.step = step;
  instruction.cycle = instruction.cycles = 1;
  instruction.peak = 300e3;
  instruction.rate = 60e3;
  instruction.dwell_peak = 1;
  instruction.remark = remark;
  return instruction;
}

TEST_F(RigOperatorNode, PutsTheSheetOnAndConfirms) {
  give(mount(1, "cylinder_5cm"));
  EXPECT_TRUE(does("take the sheet off"));
  EXPECT_TRUE(does("put the sheet on cylinder_5cm"));
  EXPECT_TRUE(test_support::await([this] { return confirmed_ > 0; }));
  EXPECT_EQ(confirmed_, 1);
}

/// The operator at the other rig leaves the confirmation to a person.
class TaughtPerson : public RigOperatorNode {
 protected:
  TaughtPerson() : RigOperatorNode("/taught") {}
};

TEST_F(TaughtPerson, IsToldOnceWhenToConfirm) {
  const auto told = [](const std::string& where) {
    return "the sheet lies on " + where + ": confirm it in the panel";
  };
  give(mount(1, "cylinder_5cm"));
  EXPECT_TRUE(does(told("cylinder_5cm, mount 1")));
  Instruction remarked = mount(1, "cylinder_5cm");
  remarked.remark = "the pressure rises before the surface is confirmed";  // lets a forgotten one be done
  give(remarked);
  give(mount(2, "flat"));
  EXPECT_TRUE(does(told("flat, mount 2")));
  EXPECT_EQ(std::count(acts_.begin(), acts_.end(), told("cylinder_5cm, mount 1")), 1);
  EXPECT_EQ(std::count(acts_.begin(), acts_.end(), "confirm"), 0);
  EXPECT_EQ(confirmed_, 0);
}

TEST_F(RigOperatorNode, DoesACycleAgainWhenRejected) {
  give(cycle(2));
  EXPECT_NEAR(pressPeak(), 300e3, 0.015 * 300e3);
  give(cycle(2, "last attempt rejected: the rest was too short"));
  EXPECT_NEAR(pressPeak(), 300e3, 0.015 * 300e3);
}

TEST_F(RigOperatorNode, SurvivesInstructionsThatNobodyCanFollow) {
  Instruction strange = mount(3, "no_such_surface");
  give(strange);
  strange.kind = 200;
  give(strange);
  strange = cycle(3);
  strange.peak = 1e9;
  give(strange);
  give(mount(4, "flat"));
  EXPECT_TRUE(does("put the sheet on flat"));
}

}  // namespace
