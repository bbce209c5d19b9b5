#pragma once

#include <string>

#include "conductor/coverage.h"

namespace fsr::conductor {

/// The picture of drawCoverage() as SVG inside an HTML page. Each cell and bar has its numbers as a title.
std::string coverageSvg(const Coverage& coverage);

}  // namespace fsr::conductor
