#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "report/verdict_file.h"
#include "ros/bags/simulated_bags.h"

namespace fsr_ros {

/// The files at the top of the folder that writeDiscrepancy() replaces, with their kinds (kindOf()).
std::map<std::string, std::string> discrepancyFiles();

/// Writes a report into a folder: verdict.yaml, simulation.yaml (with the effects found), base.yaml (fitted,
/// without them), prediction.yaml, results.json, and the tables for the figures in figures/. Each file is
/// either complete or not written; verdict.yaml is written last. `recordings` are those of the report,
/// for the prediction. Throws fsr::InputError.
void writeDiscrepancy(const fsr::discrepancy::DiscrepancyReport& report, const std::string& folder,
                      const std::vector<fsr::dataset::Recording>& recordings = {});

/// SHA-256 of the counts of all scans: a copy of a bag that was compressed, renamed or written anew has the
/// same.
std::string readingsSha256(const fsr::dataset::Recording& recording);

/// A prediction and the simulation to which its effects are added.
struct StoredPrediction {
  fsr::report::FrozenPrediction frozen;
  fsr::simulation::SimulationSettings base;
};

/// Reads the prediction that writeDiscrepancy() wrote beside a verdict.yaml. Throws fsr::InputError, also if
/// the verdict was edited afterwards.
StoredPrediction readPredictionBeside(const std::string& verdict_path);

/// Counts how often the hold-out (show) cycles of a bag were used: a test on data that was used twenty times
/// proves little. There is one small file for each bag in ROS_HOME/fsr_pressure_map/show_opened (~/.ros if
/// ROS_HOME is not set). Its name is the SHA-256 of the bag, so that the count does not depend on the output
/// folder or on the name of the bag. Each use adds one line with date and seed.
class ShowLedger {
 public:
  ShowLedger();
  explicit ShowLedger(std::string folder) : folder_(std::move(folder)) {}

  /// Adds one use and returns the number of uses, including this one. Throws fsr::InputError if the file
  /// cannot be written.
  int open(const std::string& sha256, std::uint64_t seed) const;
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

/// `simulate --gap verdict.yaml --drive BAG...`: recomputes the gap of base.yaml and of simulation.yaml
/// beside a verdict on the hold-out scans that it lists, and prints it beside the stated one. The bags must
/// be those of the verdict, in any order; of a folder the bags with their names are taken. Returns 0, also
/// where the gaps differ. Throws fsr::settings::InputError.
int printRecomputedGap(const std::string& verdict, const DrivingBags& bags, std::ostream& out);

/// The command that does this.
std::string recomputeCommand(const std::string& verdict, const DrivingBags& bags);

}  // namespace fsr_ros
