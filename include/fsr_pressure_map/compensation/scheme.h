#pragma once

#include <string>
#include <vector>

namespace fsr {

/// How a model answers to curvature. Numbers of the paper's methods in brackets.
enum class Scheme {
  kFlatOnly,      ///< one model from the flat condition, used everywhere (Table 2, "flat")
  kBaseline,      ///< one model from all conditions together (baseline)
  kPerCurvature,  ///< one model a curvature (method 1)
};

/// The readable id that files, messages and options use, e.g. "per_curvature".
std::string schemeName(Scheme scheme);

/// The scheme of that name; throws InputError that lists the names.
Scheme schemeFromName(const std::string& name);

std::vector<std::string> schemeNames();

/// Whether the scheme has a table for each curvature; else its one class answers everywhere.
bool usesCurvature(Scheme scheme);

}  // namespace fsr
