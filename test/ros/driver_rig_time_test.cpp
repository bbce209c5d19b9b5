#include <fsr_pressure_map/MatrixFrame.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/FluidPressure.h>

#include <string>

#include "support/board_packets.h"
#include "support/diagnostics.h"
#include "support/pty.h"
#include "support/ros_listener.h"

namespace {

using test_support::await;

constexpr double kWander = 0.02;  // [s]; a tenth of a tick

// A rig that runs as fast as the driver reads it. Each step is 0.1 s of rig time, with one scan and one
// reading of the transducer. /clock ticks every second step, so for half of the packets the clock is 0.1 s
// late.
class Rig {
 public:
  explicit Rig(const std::string& port) : pty_(port) {
    clock_ = ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 1000);
  }

  double time() const { return 100 + 0.1 * step_; }  // [s]
  void tick() const {
    rosgraph_msgs::Clock message;
    message.clock.fromSec(time());
    clock_.publish(message);
  }
  void step() {
    ++step_;
    if (step_ % 2 == 0) tick();
    const auto device =
        static_cast<std::uint32_t>(step_) * 100'000U;  // the board's clock starts 100 s late [us]
    pty_.write(test_support::scanPacket(step_, device, 1, 1, {7}, 0));
    pty_.write(test_support::transducerPacket(step_, device + 30'000, 5));
  }

 private:
  test_support::Pty pty_;
  ros::Publisher clock_;
  int step_ = 0;
};

TEST(DriverInRigTime, StampsInRigTimeAsEvenlyAsTheBoardScans) {
  constexpr int kSteps = 600;
  test_support::Listener<fsr_pressure_map::MatrixFrame> raw("fsr/raw");
  test_support::Listener<sensor_msgs::FluidPressure> pressure("fsr/chamber_pressure");
  ASSERT_TRUE(raw.connected() && pressure.connected());
  test_support::Diagnostics diagnostics;
  Rig rig(ros::NodeHandle("~").param<std::string>("port", ""));
  ASSERT_TRUE(await([&] {
    rig.tick();
    return diagnostics.says("fsr/driver: link", "reading");
  }));
  for (std::size_t i = 0; i < kSteps; ++i) {
    rig.step();
    ASSERT_TRUE(raw.has(i + 1) && pressure.has(i + 1)) << i;
  }

  for (int i = 0; i < kSteps; ++i) {
    const double truth = 100 + 0.1 * (i + 1);
    const double scan = raw.messages[i]->header.stamp.toSec();
    // A tick is 0.2 s; its message may be late by one more packet.
    ASSERT_NEAR(scan, truth - 0.15, 0.16) << i;
    if (i < 200) continue;
    // After 20 s the estimate changes by milliseconds; more if ticks are late on a busy computer, but never
    // so much that the order or spacing of scans (0.1 s apart) and readings (30 ms later) is lost.
    ASSERT_NEAR(scan - raw.messages[i - 1]->header.stamp.toSec(), 0.1, kWander) << i;
    ASSERT_NEAR(pressure.messages[i]->header.stamp.toSec() - scan, 0.03, kWander) << i;
  }
}

}  // namespace
