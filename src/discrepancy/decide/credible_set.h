#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/comparison.h"

namespace fsr::discrepancy {

/// The explanations that the recordings cannot distinguish. Each is given by the ids of its effects. The
/// preferred one is first. If the temperature was measured and changed, an effect of temperature comes before
/// the others. Drift comes last, because every slow effect looks like it.
std::vector<std::vector<std::string>> credibleSet(const Comparison& comparison,
                                                  const std::vector<Explanation>& pairs,
                                                  const Explanation& best);

/// Explanations that must stay credible beside `first` if nothing else is credible. There are two cases. If
/// an effect of `first` needs data that was not recorded, the best of the effects with similar traces stays.
/// If the form of `first` fits badly, other effects that come near it stay, even where they may explain only
/// noise: a wrong form can also hide the right effect.
std::vector<std::vector<std::string>> partnersOf(const Comparison& comparison, const Explanation& first);

}  // namespace fsr::discrepancy
