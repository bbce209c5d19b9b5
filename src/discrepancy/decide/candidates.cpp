#include "discrepancy/decide/candidates.h"

#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

bool sameShapes(const simulation::EffectInfo& info, const Signature& a, const Signature& b) {
  if (a.id != b.id || a.state_kept != b.state_kept || a.amplitude != b.amplitude) return false;
  for (const auto& [name, value] : a.values) {
    const auto other = b.values.find(name);
    const bool shape = simulation::parameter(info, name).role == simulation::ParameterRole::kShape;
    if (shape && other != b.values.end() && other->second != value) return false;
  }
  return true;
}

// The forms of one effect. A mixture has one form for each start state (state kept or not) and amplitude.
// Any other effect has one form for each combination of shapes; the form holds the strengths.
Explaining explainingBy(const simulation::EffectInfo& info, const std::vector<Signature>& signatures) {
  Explaining effect{{info.id}, {}, info.depends_on, info.slow};
  std::vector<std::size_t> heads;  // the first signature of each form
  for (std::size_t s = 0; s < signatures.size(); ++s) {
    if (signatures[s].id != info.id) continue;
    const auto belongs = [&](std::size_t head) {
      return info.mixture ? signatures[head].state_kept == signatures[s].state_kept &&
                                signatures[head].amplitude == signatures[s].amplitude
                          : sameShapes(info, signatures[head], signatures[s]);
    };
    auto head = std::find_if(heads.begin(), heads.end(), belongs);
    if (head == heads.end()) {
      heads.push_back(s);
      effect.forms.emplace_back();
      head = heads.end() - 1;
    }
    Form& form = effect.forms[static_cast<std::size_t>(head - heads.begin())];
    form.columns.push_back(static_cast<Eigen::Index>(s));
    form.free.push_back(signatures[s].free_sign);
  }
  return effect;
}

// Adds a copy of every form that acts only where the surface is bent.
void addBentOnly(Explaining& effect) {
  std::vector<Form> bent = effect.forms;
  for (Form& form : bent) form.bent_only = true;
  effect.forms.insert(effect.forms.end(), bent.begin(), bent.end());
}

// An effect of any course over the clock acts in the form of the generic terms of clock time, too.
void addAnyCourse(Explaining& effect, const std::vector<Explaining>& all) {
  for (const Explaining& generic : all) {
    if (!generic.generic() || generic.covariates != effect.covariates) continue;
    Form form = generic.forms.front();
    form.fitted = true;
    effect.forms.push_back(form);
  }
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

std::string nameOf(const Explaining& explaining) {
  std::string text;
  for (const std::string& id : explaining.ids) text += (text.empty() ? "" : " + ") + id;
  if (!explaining.generic()) return text;
  for (const simulation::Covariate c : explaining.covariates)
    text += (text.empty() ? "" : " x ") + simulation::name(c);
  return text;
}

bool isSlow(const std::vector<simulation::Covariate>& covariates) {
  return std::any_of(covariates.begin(), covariates.end(), [](simulation::Covariate c) {
    return c == simulation::Covariate::kCycle || c == simulation::Covariate::kClockTime ||
           c == simulation::Covariate::kMount;
  });
}

bool within(const std::vector<simulation::Covariate>& covariates,
            const std::vector<simulation::Covariate>& own) {
  return std::all_of(covariates.begin(), covariates.end(), [&](simulation::Covariate c) {
    return c == simulation::Covariate::kCurvature || std::count(own.begin(), own.end(), c) > 0;
  });
}

Candidates::Candidates(const Measured& measured, const StaticFit& fit, std::vector<Signature> signatures)
    : measured_(measured), signatures_(std::move(signatures)) {
  gatherEffects();
  gatherColumns(fit);
  for (Explaining& effect : explanations_) {
    if (!effect.generic() && measured.info(effect.ids.front()).any_course)
      addAnyCourse(effect, explanations_);
  }
  gatherCourses(fit);
}

void Candidates::gatherEffects() {
  std::vector<std::string> ids;
  for (const Signature& s : signatures_) {
    const simulation::EffectInfo& info = measured_.info(s.id);
    if (!isStatic(info) && info.looked_for && !std::count(ids.begin(), ids.end(), s.id)) ids.push_back(s.id);
  }
  for (const std::string& id : ids) {
    explanations_.push_back(explainingBy(measured_.info(id), signatures_));
    if (someFlatSomeBent(measured_)) addBentOnly(explanations_.back());
  }
}

void Candidates::gatherColumns(const StaticFit& fit) {
  const std::vector<GenericTerms> generic = genericTerms(measured_, fit);
  auto number = static_cast<Eigen::Index>(signatures_.size());
  for (const GenericTerms& terms : generic) number += static_cast<Eigen::Index>(terms.columns.size());
  columns_.resize(static_cast<Eigen::Index>(measured_.samples()), number);
  Eigen::Index next = 0;
  for (Signature& signature : signatures_) {
    columns_.col(next++) = signature.trace;
    signature.trace.resize(0);
  }
  for (const GenericTerms& terms : generic) {
    explanations_.push_back({{}, {{}}, terms.covariates, isSlow(terms.covariates)});
    Form& form = explanations_.back().forms.front();
    for (const Trace& column : terms.columns) {
      form.columns.push_back(next);
      form.free.push_back(true);
      columns_.col(next++) = column;
    }
  }
}

void Candidates::gatherCourses(const StaticFit& fit) {
  const std::vector<Explaining> effects = explanations_;
  for (const Explaining& effect : effects) {
    if (effect.generic()) continue;
    std::vector<RandomCourse> courses = randomCourses(measured_, fit, measured_.info(effect.ids.front()));
    if (courses.empty()) continue;
    explanations_.push_back({effect.ids, {}, effect.covariates, effect.slow, true});
    for (RandomCourse& course : courses) {
      const auto number = static_cast<Eigen::Index>(course.columns.size());
      Form form{{}, std::vector<bool>(course.columns.size(), true), false, true, course.step.empty()};
      columns_.conservativeResize(Eigen::NoChange, columns_.cols() + number);
      for (Eigen::Index k = 0; k < number; ++k) {
        form.columns.push_back(columns_.cols() - number + k);
        columns_.col(form.columns.back()) = course.columns[static_cast<std::size_t>(k)];
      }
      explanations_.back().forms.push_back(std::move(form));
      course.columns.clear();
    }
    courses_[effect.ids.front()] = std::move(courses);
  }
}

}  // namespace fsr::discrepancy
