#include "fsr_pressure_map/ros/pressure_map_message.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/messages/view_messages.h"

namespace fsr_ros {
namespace {

fsr::map::PressureMap someMap() {
  fsr::map::PressureMap map;
  map.reset({{2, 3}, 0.010, 0.012});
  map.state = fsr::map::MapState::kCurvatureStale;
  map.pressure = {0, 1, 2, 3, 4, 5};
  map.deviation.assign(6, 7.0f);
  map.flags[4] = fsr::map::taxel_flag::kTared;
  return map;
}

fsr_pressure_map::PressureMap someMessage() {
  fsr_pressure_map::PressureMap message;
  fillMessage(someMap(), message);
  return message;
}

TEST(PressureMapMessage, ConvertsAMapThereAndBack) {
  const fsr_pressure_map::PressureMap message = someMessage();
  EXPECT_EQ(message.state, fsr_pressure_map::PressureMap::STATE_CURVATURE_STALE);
  EXPECT_EQ(message.rows, 2);
  EXPECT_EQ(message.columns, 3);
  EXPECT_FLOAT_EQ(message.pitch_y, 0.012f);
  EXPECT_EQ(message.flags[4], fsr_pressure_map::PressureMap::FLAG_TARED);
  const fsr::map::PressureMap map = toPressureMap(message);
  EXPECT_EQ(map.state, fsr::map::MapState::kCurvatureStale);
  EXPECT_EQ(map.layout.size, someMap().layout.size);
  EXPECT_EQ(map.pressure, someMap().pressure);
  EXPECT_EQ(map.deviation, someMap().deviation);
  EXPECT_EQ(map.flags, someMap().flags);
}

TEST(PressureMapMessage, RemarksOnStateAndHistory) {
  fsr::map::PressureMap map = someMap();
  EXPECT_EQ(remarkText(map), "curvature stale");
  map.flags.assign(6, fsr::map::taxel_flag::kHistoryShort);
  EXPECT_EQ(remarkText(map), "curvature stale; history not settled");
  map.state = fsr::map::MapState::kOk;
  EXPECT_EQ(remarkText(map), "history not settled");
  map.flags.assign(6, 0);
  EXPECT_EQ(remarkText(map), "");
}

TEST(PressureMapMessage, RefusesArraysOfAnotherSize) {
  auto message = someMessage();
  message.flags.pop_back();
  EXPECT_THROW(toPressureMap(message), fsr::settings::InputError);
  message = someMessage();
  message.rows = 64;
  EXPECT_THROW(toPressureMap(message), fsr::settings::InputError);
}

// The view node would draw a sheet of a million taxels.
TEST(PressureMapMessage, RefusesAMatrixLargerThanAnyBoards) {
  fsr_pressure_map::PressureMap message;
  message.rows = message.columns = 1000;
  message.pressure.resize(1000000);
  message.deviation.resize(1000000);
  message.flags.resize(1000000);
  EXPECT_THROW(toPressureMap(message), fsr::settings::InputError);
}

TEST(PressureMapMessage, RefusesAnUnknownState) {
  auto message = someMessage();
  message.state = 6;
  EXPECT_THROW(toPressureMap(message), fsr::settings::InputError);
}

TEST(PressureMapMessage, ViewsAScanWithoutACopy) {
  fsr_pressure_map::MatrixFrame frame;
  frame.rows = 2;
  frame.columns = 3;
  frame.full_scale = 4095;
  frame.counts = {1, 2, 3, 4, 5, 6};
  const fsr::matrix::ScanView scan = toScanView(frame);
  EXPECT_EQ(scan.counts, frame.counts.data());
  EXPECT_EQ(fsr::matrix::honestSize(scan), (fsr::matrix::MatrixSize{2, 3}));
  frame.counts.pop_back();
  EXPECT_EQ(fsr::matrix::honestSize(toScanView(frame)), fsr::matrix::MatrixSize{});
}

}  // namespace
}  // namespace fsr_ros
