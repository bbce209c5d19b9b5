#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "ros/bags/simulated_bags.h"

namespace fsr_ros {

/// `simulate --gap verdict.yaml --drive BAG...`: recomputes the gap of base.yaml and of simulation.yaml
/// beside a verdict on the hold-out scans that it lists, and prints it beside the stated one. The bags must
/// be those of the verdict, in any order; of a folder the bags with their names are taken. Returns 0, also
/// where the gaps differ. Throws fsr::settings::InputError.
int printRecomputedGap(const std::string& verdict, const DrivingBags& bags, std::ostream& out);

/// The command that does this.
std::string recomputeCommand(const std::string& verdict, const DrivingBags& bags);

}  // namespace fsr_ros
