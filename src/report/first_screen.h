#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::report {

/// One answer on the first screen of a discrepancy report.
struct FirstScreenItem {
  std::string title;
  std::string answer;  ///< sentences
};

/// The answers that stand first in the text and in report.html: the scatter between cycles where it is larger
/// than what is missing, what is missing, how sure its name is, what
/// these recordings would have shown, answers to the user's questions, what the effect costs, the scatter
/// between cycles, the gap, the command that recomputes it, and what to record next. Answers that a verdict
/// does not have are left out.
std::vector<FirstScreenItem> firstScreen(const discrepancy::DiscrepancyReport& report);

}  // namespace fsr::report
