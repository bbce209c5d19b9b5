#include "discrepancy/decide/candidates.h"

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Noise that all taxels share is uncorrelated after this time [s].
constexpr double kRepeats = 1.2;

bool sameShapes(const simulation::EffectInfo& info, const Signature& a, const Signature& b) {
  if (a.id != b.id || a.state_kept != b.state_kept) return false;
  for (const auto& [name, value] : a.values) {
    const auto other = b.values.find(name);
    const bool shape = simulation::parameter(info, name).role == simulation::ParameterRole::kShape;
    if (shape && other != b.values.end() && other->second != value) return false;
  }
  return true;
}

// The alternatives of one effect. A mixture has one set of columns for each start state (state kept or not).
// Any other effect has one set for each combination of shapes; the set holds the strengths.
Family familyOf(const simulation::EffectInfo& info, const std::vector<Signature>& signatures) {
  Family family;
  family.id = info.id;
  std::vector<std::size_t> heads;  // the first signature of each alternative
  for (std::size_t s = 0; s < signatures.size(); ++s) {
    if (signatures[s].id != info.id) continue;
    const auto belongs = [&](std::size_t head) {
      return info.mixture ? signatures[head].state_kept == signatures[s].state_kept
                          : sameShapes(info, signatures[head], signatures[s]);
    };
    auto head = std::find_if(heads.begin(), heads.end(), belongs);
    if (head == heads.end()) {
      heads.push_back(s);
      family.alternatives.emplace_back();
      head = heads.end() - 1;
    }
    ColumnSet& set = family.alternatives[static_cast<std::size_t>(head - heads.begin())];
    set.columns.push_back(static_cast<Eigen::Index>(s));
    set.free.push_back(signatures[s].free_sign);
    set.bent_only.push_back(false);
  }
  return family;
}

// Adds a copy of every alternative that acts only where the surface is bent.
void addBentOnly(Family& family) {
  std::vector<ColumnSet> bent = family.alternatives;
  for (ColumnSet& set : bent) set.bent_only.assign(set.columns.size(), true);
  family.alternatives.insert(family.alternatives.end(), bent.begin(), bent.end());
}

bool someFlatSomeBent(const Measured& measured) {
  const auto flat = std::count_if(measured.classes.begin(), measured.classes.end(), dataset::isFlat);
  return flat > 0 && static_cast<std::size_t>(flat) < measured.classes.size();
}

}  // namespace

bool isStatic(const simulation::EffectInfo& info) {
  return std::all_of(info.depends_on.begin(), info.depends_on.end(), [](simulation::Covariate covariate) {
    switch (covariate) {
      case simulation::Covariate::kPressure:
      case simulation::Covariate::kCurvature:
      case simulation::Covariate::kRow:
      case simulation::Covariate::kColumn:
      case simulation::Covariate::kTaxel:
      case simulation::Covariate::kCode:
      case simulation::Covariate::kTotalLoad:
        return true;
      default:
        return false;
    }
  });
}

Candidates::Candidates(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                       std::vector<Signature> signatures, unsigned threads)
    : measured_(measured), signatures_(std::move(signatures)) {
  std::vector<std::string> ids;
  for (const Signature& s : signatures_) {
    const simulation::EffectInfo& info = measured.info(s.id);
    if (!isStatic(info) && info.looked_for && !std::count(ids.begin(), ids.end(), s.id)) ids.push_back(s.id);
  }
  for (const std::string& id : ids) {
    effects_.push_back(familyOf(measured.info(id), signatures_));
    if (someFlatSomeBent(measured)) addBentOnly(effects_.back());
  }
  gather(fit, measured);
  columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
  columns_.col(columns_.cols() - 1) = fit.project(common.all);
  mean_square_ = columns_.col(columns_.cols() - 1).squaredNorm() / static_cast<double>(columns_.rows());
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (const MeasuredCycle& cycle : measured.cycles) ranges.emplace_back(cycle.first, cycle.last);
  grams_ = std::make_unique<CycleGrams>(columns_, ranges, threads);
  cross_validation_ = std::make_unique<CrossValidation>(measured, *grams_);
  judgeRepeating(measured, common, fit);
}

void Candidates::gather(const StaticFit& fit, const Measured& measured) {
  const std::vector<GenericTerms> generic = genericTerms(measured, fit);
  auto number = static_cast<Eigen::Index>(signatures_.size());
  for (const GenericTerms& terms : generic) number += static_cast<Eigen::Index>(terms.columns.size());
  columns_.resize(static_cast<Eigen::Index>(measured.samples()), number);
  Eigen::Index next = 0;
  for (Signature& signature : signatures_) {
    columns_.col(next++) = signature.trace;
    signature.trace.resize(0);
  }
  for (const GenericTerms& terms : generic) {
    Family family;
    family.generic = true;
    family.alternatives.emplace_back();
    for (const simulation::Covariate covariate : terms.covariates) {
      family.id += (family.id.empty() ? "" : " x ") + simulation::name(covariate);
    }
    for (const Trace& column : terms.columns) {
      family.alternatives.front().columns.push_back(next);
      family.alternatives.front().free.push_back(true);
      family.alternatives.front().bent_only.push_back(false);
      columns_.col(next++) = column;
    }
    generics_.push_back(family);
    covariates_.push_back(terms.covariates);
  }
}

void Candidates::judgeRepeating(const Measured& measured, const CommonTraces& common, const StaticFit& fit) {
  const Trace white = fit.project(common.halves[0]), black = fit.project(common.halves[1]);
  double sum = 0, number = 0;
  for (const MeasuredCycle& cycle : measured.cycles) {
    if (cycle.use == CycleUse::kHoldOut) continue;
    std::size_t later = cycle.first;
    for (std::size_t i = cycle.first; i < cycle.last; ++i) {
      while (later < cycle.last && measured.time[later] - measured.time[i] < kRepeats) ++later;
      if (later == cycle.last) break;
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(later);
      sum += white[a] * black[b] + black[a] * white[b];
      number += 2;
    }
  }
  repeating_ = number > 0 && mean_square_ > 0 ? std::max(0.0, sum / number / mean_square_) : 0;
}

Eigen::MatrixXd Candidates::columns(const std::vector<Eigen::Index>& chosen) const {
  Eigen::MatrixXd columns(columns_.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = columns_.col(chosen[k]);
  return columns;
}

Trace Candidates::explained(const Score& score) const {
  return explainedBy(score.set, score.coefficients);
}

Trace Candidates::explainedWithout(const Score& score, const std::vector<bool>& cycles) const {
  const auto size = static_cast<Eigen::Index>(score.set.columns.size());
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(size + 1, size + 1);
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    if (cycle.use != CycleUse::kFit || cycles[c]) continue;
    const bool flat = dataset::isFlat(measured_.classes[measured_.visits[cycle.visit].curvature_class]);
    part += partOf(grams_->of(c), score.set, flat);
  }
  return explainedBy(score.set, fitColumns(part, score.set));
}

Trace Candidates::explainedBy(const ColumnSet& set, const Eigen::VectorXd& coefficients) const {
  Trace everywhere = Trace::Zero(columns_.rows()), bent = everywhere;
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    const double b = coefficients[static_cast<Eigen::Index>(i)];
    if (b != 0) (set.bent_only[i] ? bent : everywhere) += b * columns_.col(set.columns[i]);
  }
  for (std::size_t i = 0; i < measured_.samples(); ++i) {
    if (dataset::isFlat(measured_.classes[measured_.classOf(i)])) bent[static_cast<Eigen::Index>(i)] = 0;
  }
  return everywhere + bent;
}

}  // namespace fsr::discrepancy
