#pragma once

#include <string>

#include "blind/blind_case.h"

namespace blind {

/// A case that takes a tenth of a second: 3 x 4 taxels on the flat surface and on the tightest cylinder.
inline CaseSpec smallCase(const std::string& id, const std::string& form, double snr = 1,
                          std::uint64_t seed = 11) {
  CaseSpec spec;
  spec.seed = seed;
  spec.snr = snr;
  spec.matrix = {3, 4};
  spec.size = {2, 0.5};
  if (!id.empty()) spec.effects = {{id, form, {}}};
  return spec;
}

/// A protocol under which the form shows.
inline std::string protocolFor(const HiddenForm& form) {
  if (form.needs_remounts) return "random_order";
  if (form.id == "temperature") return "two_ambients";
  return form.form == "valley_memory_bent" ? "minor_loops" : "two_speeds";
}

}  // namespace blind
