#pragma once

#include <string>
#include <vector>

#include "check/sheet_life.h"

namespace fsr::report {

/// A file that could not be used, and why.
struct SkippedFile {
  std::string file;
  std::string reason;
};

/// The life of one sheet: a table by date, what changed suddenly, what could not be tested, and the rule.
std::string lifeText(const check::SheetLife& life);

/// All sheets as JSON. Pressures in Pa, readings in counts; NaN is null.
std::string lifeJson(const std::vector<check::SheetLife>& lives, const std::vector<SkippedFile>& skipped);

/// All sheets as a table, one line for each date and source.
std::string lifeCsv(const std::vector<check::SheetLife>& lives);

}  // namespace fsr::report
