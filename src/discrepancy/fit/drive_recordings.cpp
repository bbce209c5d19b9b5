#include "discrepancy/fit/drive_recordings.h"

#include <cmath>

#include "dataset/row_spool.h"
#include "simulation/effects/enabled_effects.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kReadingsInMemory = 16u << 20;  // of one recording [bytes]

// A simulation that goes from recording to recording.
class Driver {
 public:
  Driver(const dataset::Recording& first, const simulation::SimulationSettings& simulation)
      : quiet_(simulation::withoutNoise(simulation::fitted(simulation, first))),
        origin_ns_(first.start_ns),
        rig_(quiet_) {}

  template <typename Use>
  void run(const dataset::Recording& recording, Use use) {
    const double start = 1e-9 * static_cast<double>(recording.start_ns - origin_ns_);
    if (start + recording.time.front() < end_) rig_ = simulation::DrivenRig(quiet_);
    end_ = start + recording.time.back();
    rig_.run(recording, use);
  }

 private:
  simulation::SimulationSettings quiet_;
  std::int64_t origin_ns_;
  simulation::DrivenRig rig_;
  double end_ = -INFINITY;  // of the last recording [s]
};

}  // namespace

void driveRecordings(const std::vector<const dataset::Recording*>& recordings,
                     const simulation::SimulationSettings& simulation,
                     const std::function<void(std::size_t recording, std::size_t scan,
                                              const simulation::SensorChain& chain)>& use) {
  if (recordings.empty()) return;
  Driver driver(*recordings.front(), simulation);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    driver.run(*recordings[r],
               [&](std::size_t scan, const simulation::SensorChain& chain) { use(r, scan, chain); });
  }
}

void driveRecordingsTwice(
    const std::vector<const dataset::Recording*>& recordings, const simulation::SimulationSettings& first,
    const simulation::SimulationSettings& second,
    const std::function<void(std::size_t recording, std::size_t scan, const double* first,
                             const simulation::SensorChain& second)>& use) {
  if (recordings.empty()) return;
  Driver one(*recordings.front(), first), other(*recordings.front(), second);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    dataset::RowSpool<double> spool(kReadingsInMemory);
    spool.begin(recordings[r]->layout.size.taxels(), recordings[r]->scans());
    one.run(*recordings[r],
            [&](std::size_t, const simulation::SensorChain& chain) { spool.add(chain.reading().data()); });
    dataset::RowSpool<double>::Reader readings(spool);
    other.run(*recordings[r], [&](std::size_t scan, const simulation::SensorChain& chain) {
      use(r, scan, readings[scan], chain);
    });
  }
}

}  // namespace fsr::discrepancy
