#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "blind/campaign.h"
#include "blind/sheet.h"

namespace blind {

/// A number of a hidden effect, for the key.
struct HiddenParameter {
  std::string name;
  double value = 0;
  std::string unit;
};

/// Input for constructing a hidden effect.
struct HiddenSetup {
  const Campaign& campaign;
  const Sheet& sheet;
  std::uint64_t seed = 0;
  double strength = 1;       ///< 1 = the usual size, 0 = nothing
  bool carried_over = true;  ///< true: the state is kept at a new mount; false: it is reset
};

/// An effect of the sheet, the rig or the read-out besides the static curve. It changes the traces of one
/// taxel after the other; each trace has one value for each scan of the campaign. The functions that a
/// class does not override leave their trace unchanged.
class Hidden {
 public:
  virtual ~Hidden() = default;

  virtual void onLoad(std::size_t /*taxel*/, Trace& /*load*/) const {}        ///< [Pa]
  virtual void onGain(std::size_t /*taxel*/, Trace& /*gain*/) const {}        ///< factor of the signal
  virtual void onReading(std::size_t /*taxel*/, Trace& /*reading*/) const {}  ///< [share of full scale]
  virtual void onNoise(std::size_t /*taxel*/, Trace& /*factor*/) const {}     ///< factor of the noise

  /// Taxels in which the effect can show; empty = all.
  virtual std::vector<std::size_t> taxels() const { return {}; }
  /// Intervals in which the effect acts [s, campaign clock]; empty = always.
  virtual std::vector<std::pair<double, double>> times() const { return {}; }

  const std::vector<HiddenParameter>& parameters() const { return parameters_; }

 protected:
  std::vector<HiddenParameter> parameters_;
};

/// The static fit that leaves a residual of the effect.
enum class LeftAfter {
  kCurveEach,   ///< one monotone curve for each taxel and surface
  kCurveShared  ///< one monotone curve for each taxel, with a gain and a preload for each surface
};

/// One form of a hidden effect.
struct HiddenForm {
  std::string id;  ///< as in the package's list of effects; a foreign effect has an id of its own
  std::string form;
  std::vector<std::string> depends_on;  ///< covariates that a correct answer must name
  std::unique_ptr<Hidden> (*make)(const HiddenSetup& setup);
  bool may_be_local = false;    ///< may be limited to some taxels or surfaces
  bool has_state = false;       ///< has a state that is kept or reset at a new mount
  bool needs_remounts = false;  ///< shows only where a surface is mounted more than once
  bool foreign = false;         ///< no library has it; the correct answer is "unknown"
  LeftAfter left_after = LeftAfter::kCurveEach;
  char set = 'A';  ///< A = development may look at it; B = for the published campaign only
};

inline HiddenForm inSetB(HiddenForm form) {
  form.set = 'B';
  return form;
}

inline void PrintTo(const HiddenForm& form, std::ostream* out) {
  *out << form.id << ":" << form.form;
}

/// All forms of all effects, grouped by effect.
const std::vector<HiddenForm>& hiddenForms();
std::vector<const HiddenForm*> formsOf(const std::string& id);
/// The forms that development may look at.
std::vector<const HiddenForm*> openFormsOf(const std::string& id);
/// Ids in the order of the list; foreign effects last.
std::vector<std::string> hiddenIds();
/// Throws fsr::InputError where there is no such form.
const HiddenForm& findForm(const std::string& id, const std::string& form);

template <typename Type>
std::unique_ptr<Hidden> makeHidden(const HiddenSetup& setup) {
  return std::make_unique<Type>(setup);
}

/// Steps a state through the campaign: for every scan it calls step(input, seconds), then use(scan, state).
/// In the pauses between mounts the input is 0. Where states are not carried over, each mount begins with a
/// copy of `fresh`.
template <typename State, typename Input, typename Use>
void follow(const HiddenSetup& setup, const State& fresh, Input input, Use use) {
  State state = fresh;
  for (const Visit& visit : setup.campaign.visits) {
    if (!setup.carried_over) state = fresh;
    if (setup.carried_over && visit.first > 0) {
      for (int i = 0; i < 50; ++i) state.step(0.0, visit.pause / 50);
    }
    for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
      state.step(input(scan), setup.campaign.scan_period);
      use(scan, state);
    }
  }
}

/// One factor near 1 for each taxel.
std::vector<double> taxelScatter(const HiddenSetup& setup, const std::string& purpose, double deviation);

}  // namespace blind
