#pragma once

#include <deque>
#include <string>
#include <vector>

#include "discrepancy/decide/appraisal.h"
#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/cycle_design.h"

namespace fsr::discrepancy {

/// An effect or a pair, fitted through the forward model.
struct Fitted {
  std::vector<std::string> ids;
  Refined refined;
  std::vector<bool> bent_only;  ///< of each effect: acts only where the surface is bent
};

/// The search over all explanations of the common trace. Effects compete with their signatures first, then
/// with the change that a fit through the forward model gives, then in pairs.
class Search {
 public:
  Search(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
         const Candidates& candidates, const simulation::SimulationSettings& base,
         const DiscrepancyOptions& options);

  void run();

  const Appraisal& appraisal() const { return appraisal_; }
  const CycleDesign& design() const { return design_; }
  const NullFit& null() const { return null_; }
  bool empty() const { return explanations_.empty() || design_.cycles.size() < 2; }
  /// Whether the best score is more than chance gives.
  bool found() const { return appraisal_.p <= options_.level; }
  /// Whether what was found is at least as large as the least gap.
  bool matters() const;
  double leastGap(const Explaining& explaining) const;  ///< [Pa]
  /// A random course that is at least as large as the least gap and not larger than its sources know;
  /// nullptr = none.
  const Weighed* course() const;
  const simulation::EffectParameter& courseParameter() const;  ///< its step
  double courseStep(double variance) const;                    ///< in the parameter's unit
  /// Best explanation by effects that the score does not exclude.
  const Weighed& preferred() const { return appraisal_.all[appraisal_.credible.front()]; }
  /// Whether more is left beside the preferred explanation than chance gives.
  bool refuted() const { return appraisal_.p_beyond <= options_.level; }
  const Fitted& fitted(const Weighed& weighed);
  Trace explained(const Weighed& weighed) const;
  Trace column(Eigen::Index index) const { return columns_.col(index); }
  double atMap(const Trace& trace) const;
  void putLikelyFirst();

 private:
  void sharpen();
  void pairUp();
  double usualCoefficient(const Signature& signature) const;
  std::vector<SingleColumn> startsOf(const Weighed& weighed) const;
  std::vector<SingleColumn> nearestShapes(const std::string& id) const;
  bool isSlowBesideFast(std::size_t second);
  struct Second {
    std::size_t effect;  // an explanation
    SingleColumn beginning;
    bool by_gains;  // the gains of the cycles show it
  };
  std::vector<Second> seconds();
  std::vector<Second> secondsByDensity();
  std::vector<Second> secondsByCycles();
  std::vector<Form> formsOf(const Weighed& first, const Second& second, Eigen::Index fitted) const;
  double genericBeside(bool slow_beside_fast) const;
  simulation::EnabledEffect begin(const SingleColumn& column) const;
  Fitted fitSingle(const Weighed& weighed) const;
  std::vector<Eigen::Index> addEnabled();
  Eigen::Index addColumn(const Trace& trace);
  double meanSlope() const;
  void measureSizes();
  void keepLikeTooLarge();
  bool isNone(std::size_t e);
  bool isPhase(std::size_t e);
  Trace withoutEnabled(const Trace& trace, const Trace& part) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const Candidates& candidates_;
  const simulation::SimulationSettings& base_;
  const DiscrepancyOptions& options_;
  std::vector<Explaining> explanations_;
  Eigen::MatrixXd columns_;  // [samples x columns]
  std::vector<Eigen::Index> always_;
  CycleDesign design_;
  double least_slope_;  // [share of full scale / Pa]
  NullFit null_;
  Appraisal appraisal_;
  std::deque<Fitted> fitted_;
};

}  // namespace fsr::discrepancy
