#pragma once

#include <map>
#include <string>
#include <vector>

#include "discrepancy/decide/explaining.h"
#include "discrepancy/fit/generic_terms.h"
#include "discrepancy/fit/random_courses.h"
#include "discrepancy/fit/signatures.h"

namespace fsr::discrepancy {

/// The explanations that compete for what the static curves leave of the common trace.
class Candidates {
 public:
  Candidates(const Measured& measured, const StaticFit& fit, std::vector<Signature> signatures);

  /// Single effects, then generic terms, then random courses of effects.
  const std::vector<Explaining>& explanations() const { return explanations_; }
  const std::vector<Signature>& signatures() const { return signatures_; }
  /// Description of an effect in the library.
  const simulation::EffectInfo& info(const std::string& id) const { return measured_.info(id); }
  /// The random courses of an effect, in the order of the forms; without columns.
  const std::vector<RandomCourse>& courses(const std::string& id) const { return courses_.at(id); }
  /// All columns [samples x columns]. Signatures come first, then generic terms, both scaled to rms 1, then
  /// random courses.
  const Eigen::MatrixXd& columns() const { return columns_; }

 private:
  void gatherEffects();
  void gatherColumns(const StaticFit& fit);
  void gatherCourses(const StaticFit& fit);

  const Measured& measured_;
  std::vector<Signature> signatures_;
  std::vector<Explaining> explanations_;
  std::map<std::string, std::vector<RandomCourse>> courses_;
  Eigen::MatrixXd columns_;
};

/// Whether the traces of an effect depend only on variables that the static curve depends on. Under a uniform
/// load such an effect cannot be distinguished from the static curve.
bool isStatic(const simulation::EffectInfo& info);

}  // namespace fsr::discrepancy
