#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace test_support {

/// A simulated day in rounds: each round mounts cylinder_10cm, cylinder_6cm, flat and cylinder_8cm once, so
/// that mount 5 is the second one on cylinder_10cm.
struct MountedDay {
  std::string rig = "bench";  // its effects; of config/simulation
  int rounds = 2;             // mounts of each surface
  bool wrong = false;         // mount 5 lies on 6 cm, and is declared as 10 cm
  unsigned seed = 1;
};

/// One recording for each mount.
std::vector<fsr::dataset::Recording> recorded(const MountedDay& day);

}  // namespace test_support
