#pragma once

#include <gtest/gtest.h>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// The trained values, bit for bit.
inline void expectSameTables(const Calibration& a, const Calibration& b) {
  ASSERT_EQ(a.tables.tables.size(), b.tables.tables.size());
  for (std::size_t i = 0; i < a.tables.tables.size(); ++i) {
    EXPECT_EQ(a.tables.tables[i].pressure, b.tables.tables[i].pressure);
    EXPECT_EQ(a.tables.tables[i].deviation, b.tables.tables[i].deviation);
    EXPECT_EQ(a.tables.tables[i].support, b.tables.tables[i].support);
  }
  EXPECT_TRUE(a.statistics->cells == b.statistics->cells);
  EXPECT_EQ(a.regressor.grnn.bandwidth, b.regressor.grnn.bandwidth);
  EXPECT_EQ(a.history.play_weight, b.history.play_weight);
  EXPECT_EQ(a.history.correction, b.history.correction);
}

}  // namespace fsr::calibration
