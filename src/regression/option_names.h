#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/regression/regressor_options.h"

namespace fsr::regression {

// The names of the regressors' options in files, parameters and command lines. Every ...FromName() throws
// InputError that lists the names.

/// "sigma", "matlab".
std::vector<std::string> spreadNames();
std::string spreadName(SpreadMeaning spread);
SpreadMeaning spreadFromName(const std::string& name);

/// "squared", "literal".
std::vector<std::string> distanceNames();
std::string distanceName(KernelDistance distance);
KernelDistance distanceFromName(const std::string& name);

/// "each_sample", "equal_bins".
std::string weightingName(SampleWeighting weighting);
SampleWeighting weightingFromName(const std::string& name);

/// "draws", "distinct".
std::vector<std::string> leafRuleNames();
std::string leafRuleName(LeafCount count);
LeafCount leafRuleFromName(const std::string& name);

/// A bandwidth, or none for "auto". Throws InputError if `text` is neither.
std::optional<double> bandwidthFromText(const std::string& text);

}  // namespace fsr::regression
