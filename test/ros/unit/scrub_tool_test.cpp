#include "ros/tools/tools.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <rosgraph_msgs/Log.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/pty.h"
#include "support/source_dir.h"
#include "support/tool_run.h"

namespace {

constexpr double kNow = 1763690400.25;  // [s]

class ScrubTool : public testing::Test {
 protected:
  void SetUp() override {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    const ros::Time time(kNow);
    const boost::shared_ptr<ros::M_string> connection(new ros::M_string);
    (*connection)["callerid"] = "/record_SECRETHOST_4711";
    (*connection)["topic"] = "/fsr/raw";
    (*connection)["type"] = ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>();
    (*connection)["md5sum"] = ros::message_traits::md5sum<fsr_pressure_map::MatrixFrame>();
    (*connection)["message_definition"] = ros::message_traits::definition<fsr_pressure_map::MatrixFrame>();
    fsr_pressure_map::MatrixFrame frame;
    frame.header.stamp = time;
    frame.sequence = 7;
    frame.counts = {1, 2, 3};
    bag.write("/fsr/raw", time, frame, connection);
    fsr_pressure_map::Session session;
    session.header.stamp = time;
    session.session_id = "SECRETDATE";
    session.subject_code = "S012";
    session.notes.resize(1);
    session.notes[0].value = "SECRETNOTE";
    bag.write("/fsr/session", time, session);
    fsr_pressure_map::Event event;
    event.header.stamp = time;
    event.kind = "note";
    event.label = "SECRETLABEL";
    bag.write("/fsr/events", time, event);
    event.kind = "step";
    event.label = "stairs";
    bag.write("/fsr/events", time + ros::Duration(1.5), event);
    rosgraph_msgs::Log log;
    log.msg = "SECRETLOG";
    bag.write("/rosout", time, log);
    bag.close();
  }
  static std::string run(const std::vector<std::string>& words) {
    return test_support::runTool(fsr_ros::scrubTool, "scrub", words).said();
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = folder_.path("in.bag");
  std::string output_ = folder_.path("out.bag");
};

TEST_F(ScrubTool, RemovesIdentifyingDataAndKeepsTheScans) {
  const std::string said = run({path_, "--output", output_});
  const std::string bytes = test_support::contentOf(output_);
  EXPECT_EQ(bytes.find("SECRET"), std::string::npos) << bytes.substr(bytes.find("SECRET"), 20);
  ASSERT_TRUE(std::filesystem::exists(output_)) << said;
  rosbag::Bag bag(output_);
  std::size_t messages = 0;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    ++messages;
    EXPECT_LT(message.getTime().toSec(), 946684802.0) << message.getTopic();
    if (const auto frame = message.instantiate<fsr_pressure_map::MatrixFrame>()) {
      EXPECT_EQ(frame->sequence, 7u);
      EXPECT_EQ(frame->counts, (std::vector<std::uint16_t>{1, 2, 3}));
      EXPECT_DOUBLE_EQ(frame->header.stamp.toSec(), 946684800.25);
    }
    if (const auto session = message.instantiate<fsr_pressure_map::Session>()) {
      EXPECT_EQ(session->subject_code, "S012");
    }
  }
  EXPECT_EQ(messages, 4u);
  EXPECT_NE(bytes.find("stairs"), std::string::npos) << "what is no note stays";
  for (const char* removed : {"/rosout", "session ids", "notes of the session",
                              "labels of events of kind note", "names of the nodes", "absolute times"}) {
    EXPECT_NE(said.find(removed), std::string::npos) << removed << " in:\n" << said;
  }
}

TEST_F(ScrubTool, ListsTheTextsThatItKeeps) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Append);
    const ros::Time time(kNow);
    fsr_pressure_map::MatrixInfo info;
    info.serial = "FSR-0042";
    info.transducer = "PX-3 no. 17";
    info.header.frame_id = "left_leg_of_anna";
    bag.write("/fsr/matrix_info", time, info);
    fsr_pressure_map::SurfaceCurvature curvature;
    curvature.surface = "/home/anna/limb.yaml";
    bag.write("/fsr/curvature", time, curvature);
    fsr_pressure_map::Session session;
    session.trial = "3";
    session.protocol = "stairs v2";
    bag.write("/fsr/session", time, session);
  }
  const std::string said = run({path_, "--output", output_});
  for (const char* kept :
       {"\n  subject code: S012\n", "\n  trial: 3\n", "\n  protocol: stairs v2\n",
        "\n  label of an event of kind step: stairs\n", "\n  surface: /home/anna/limb.yaml\n",
        "\n  serial number: FSR-0042\n", "\n  transducer: PX-3 no. 17\n",
        "\n  frame of /fsr/matrix_info: left_leg_of_anna\n"}) {
    EXPECT_NE(said.find(kept), std::string::npos) << kept << " in:\n" << said;
  }
}

// ros::Duration holds 68 years: stamps of another age are moved all the same, or refused.
TEST_F(ScrubTool, MovesStampsOfAnyAge) {
  for (const std::uint32_t start : {1u, 2500000000u, 4200000000u}) {
    {
      rosbag::Bag bag(path_, rosbag::bagmode::Write);
      fsr_pressure_map::MatrixFrame frame;
      frame.header.stamp = ros::Time(start, 250000000);
      bag.write("/fsr/raw", frame.header.stamp, frame);
    }
    run({path_, "--output", output_});
    rosbag::Bag bag(output_);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      EXPECT_EQ(message.instantiate<fsr_pressure_map::MatrixFrame>()->header.stamp,
                ros::Time(946684800, 250000000))
          << start;
    }
  }
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    fsr_pressure_map::MatrixFrame frame;
    frame.header.stamp = ros::Time(1);
    bag.write("/fsr/raw", ros::Time(kNow), frame);
  }
  const std::string said = run({path_, "--output", output_});
  EXPECT_NE(said.find("/fsr/raw: a stamp of 1 s"), std::string::npos) << said;
}

// Another definition of the PressureMap, without FLAG_HISTORY_SHORT. The copy has the present one.
TEST_F(ScrubTool, KeepsMapsOfTheEarlierDefinition) {
  const std::string old = test_support::sourceDir() + "/test/data/indenter_map.bag";
  const std::string said = run({old, "--output", output_});
  EXPECT_EQ(said.find("messages of /fsr/pressure_map"), std::string::npos) << said;
  rosbag::Bag from(old), bag(output_);
  rosbag::View before(from, rosbag::TopicQuery("/fsr/pressure_map")),
      after(bag, rosbag::TopicQuery("/fsr/pressure_map"));
  ASSERT_EQ(after.size(), before.size());
  const auto map = after.begin()->instantiate<fsr_pressure_map::PressureMap>();
  ASSERT_NE(map, nullptr);
  EXPECT_EQ(map->pressure.size(), 70u);
}

TEST_F(ScrubTool, RefusesToOverwriteTheBagAndFilesThatAreNoBags) {
  EXPECT_NE(run({path_, "--output", path_}).find("would be overwritten"), std::string::npos);
  std::ofstream(folder_.path("text")) << "no bag";
  EXPECT_NE(run({folder_.path("text"), "--output", output_}).find("is not a complete bag"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
