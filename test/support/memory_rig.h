#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace test_support {

/// Cycles of one protocol.
struct MemoryCycles {
  int cycles = 2;
  double peak = 600e3;    // [Pa]
  double rate = 20e3;     // [Pa/s]
  double dwell_peak = 2;  // [s]
  double dwell_rest = 2;  // [s]
};

/// A sheet of straight sensors, some 3,500 of 4,095 counts at 600 kPa, that remember. The formulas are not
/// those of the package: the loop is one of Bouc and Wen, the creep a stretched exponential of time.
struct MemoryRig {
  fsr::matrix::MatrixSize size{1, 3};
  std::vector<MemoryCycles> program;
  double loop = 0;        // width, share of 600 kPa
  double creep = 0;       // final rise under a constant load, share of the load
  double noise = 4;       // standard deviation [counts]
  double frequency = 10;  // of the scans [Hz]
  unsigned seed = 1;
};

/// Two paces, short and long dwells, and partial cycles.
std::vector<MemoryCycles> variedProgram();

/// The recording of the rig on a flat surface.
fsr::dataset::Recording memoryRecording(const MemoryRig& rig);

/// One stay of a sheet of 2 x 3 taxels that starts with 4 s at rest, followed by two protocols (`rig.program`
/// is not used). Each taxel reads the load plus an offset of its own, by some 0.9 `offset` in root mean
/// square [Pa]. Seven sessions repeat: the largest offsets occur twice, so that none of them is beyond all
/// others, where a table is constant and a session cannot be predicted.
fsr::dataset::Recording memorySession(std::size_t number, double offset, MemoryRig rig = {});

/// The scans from `first` to before `last`, as a bag of its own.
fsr::dataset::Recording partOf(const fsr::dataset::Recording& whole, std::size_t first, std::size_t last);

}  // namespace test_support
