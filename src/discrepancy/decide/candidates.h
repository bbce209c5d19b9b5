#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "discrepancy/fit/candidate_terms.h"
#include "discrepancy/fit/signatures.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// One way in which an explanation may act: columns of the design, fitted together under one prior variance.
struct Form {
  std::vector<Eigen::Index> columns;
  std::vector<bool> free;  ///< of each column: its coefficient may have either sign
  bool bent_only = false;  ///< acts only where the surface is bent
  bool fitted = false;  ///< its columns are not signatures: a fit through the forward model, or generic terms
  bool trend = false;   ///< of a random course: the smooth one beside it, which is no form of the effect
};

/// Competing explanation: one or two effects with their forms, or generic terms of some covariates. The form
/// with the largest marginal likelihood counts.
struct Explaining {
  std::vector<std::string> ids;  ///< of the effects; empty for generic terms
  std::vector<Form> forms;
  std::vector<simulation::Covariate> covariates;  ///< that it depends on
  bool slow = false;                              ///< changes from cycle to cycle, hardly within a cycle
  /// A random course of the effect: noise with a covariance. It imitates any slow effect, so it is asked only
  /// where nothing else explains the readings.
  bool by_chance = false;

  bool generic() const { return ids.empty(); }
  /// One effect with a course of its own.
  bool single() const { return ids.size() == 1 && !by_chance; }
};

/// "creep", "creep + drift", "pressure_rate x curvature".
std::string nameOf(const Explaining& explaining);

/// Whether each of the covariates, except curvature, is among `own`, those that an explanation depends on.
/// Any effect may be stronger on one surface than on another.
bool within(const std::vector<simulation::Covariate>& covariates,
            const std::vector<simulation::Covariate>& own);

/// Whether what depends on these covariates changes from cycle to cycle, or from mount to mount.
bool isSlow(const std::vector<simulation::Covariate>& covariates);

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
