#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <string>
#include <vector>

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

/// Whether each of the covariates, except curvature, is one that the explanation depends on. Any effect may
/// be stronger on one surface than on another.
bool within(const std::vector<simulation::Covariate>& covariates, const Explaining& explaining);

}  // namespace fsr::discrepancy
