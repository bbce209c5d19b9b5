#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/comparison.h"

namespace fsr::discrepancy {

/// The explanations that the recordings do not tell apart, each by its effects, the one to put first in
/// front: a temperature that was measured, and moved, comes before what was not, and drift stands behind
/// whatever comes near it, since everything slow looks like it.
std::vector<std::vector<std::string>> credibleSet(const Comparison& comparison,
                                                  const std::vector<Explanation>& pairs,
                                                  const Explanation& best);

/// Effects that must stay beside `first` if nothing else is credible: it needs what was not recorded, and
/// then the best of its partners for each of its effects; or its form is so bad that others in theirs come
/// near, even if noise might be all that they explain: a wrong form hides the right effect as well.
std::vector<std::vector<std::string>> partnersOf(const Comparison& comparison, const Explanation& first);

}  // namespace fsr::discrepancy
