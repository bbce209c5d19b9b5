#pragma once

#include "support/synthetic_recording.h"

namespace fsr::health {

/// A healthy sheet of 4 x 5 taxels.
inline dataset::Recording recorded() {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  return test_support::syntheticRecording(rig);
}

}  // namespace fsr::health
