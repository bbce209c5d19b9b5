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

/// What a hidden effect is made from.
struct HiddenSetup {
  const Campaign& campaign;
  const Sheet& sheet;
  std::uint64_t seed = 0;
  double strength = 1;       ///< 1 = the usual size, 0 = nothing
  bool carried_over = true;  ///< states live on from one mount to the next; else each starts afresh
};

/// Something that the sheet, the rig or the read-out does besides its static curve. It acts on the
/// traces of one taxel after the other; each trace has a value for each scan of the campaign. What it
/// does not act on it leaves as it is.
class Hidden {
 public:
  virtual ~Hidden() = default;

  virtual void onLoad(std::size_t /*taxel*/, Trace& /*load*/) const {}        ///< [Pa]
  virtual void onGain(std::size_t /*taxel*/, Trace& /*gain*/) const {}        ///< factor of the rise
  virtual void onReading(std::size_t /*taxel*/, Trace& /*reading*/) const {}  ///< [share of full scale]
  virtual void onNoise(std::size_t /*taxel*/, Trace& /*factor*/) const {}     ///< of the noise

  /// Taxels that it can show in; empty = all.
  virtual std::vector<std::size_t> taxels() const { return {}; }
  /// Intervals in which it acts [s, campaign clock]; empty = always.
  virtual std::vector<std::pair<double, double>> times() const { return {}; }

  const std::vector<HiddenParameter>& parameters() const { return parameters_; }

 protected:
  std::vector<HiddenParameter> parameters_;
};

/// Which static fit cannot swallow it.
enum class LeftAfter {
  kCurveEach,   ///< one monotone curve for each taxel and surface
  kCurveShared  ///< one monotone curve a taxel, with gain and preload for each surface
};

/// One of the forms that a hidden effect comes in.
struct HiddenForm {
  std::string id;  ///< as in the package's list of effects; of a foreign one its own
  std::string form;
  std::vector<std::string> depends_on;  ///< covariates that whoever finds it must name
  std::unique_ptr<Hidden> (*make)(const HiddenSetup& setup);
  bool may_be_local = false;    ///< may be confined to some taxels or surfaces
  bool has_state = false;       ///< may be carried over or start afresh
  bool needs_remounts = false;  ///< shows only where a surface is mounted more than once
  bool foreign = false;         ///< no library has it; the answer is "unknown"
  LeftAfter left_after = LeftAfter::kCurveEach;
};

inline void PrintTo(const HiddenForm& form, std::ostream* out) {
  *out << form.id << ":" << form.form;
}

/// All forms of all effects, those of one effect one after the other.
const std::vector<HiddenForm>& hiddenForms();
std::vector<const HiddenForm*> formsOf(const std::string& id);
/// Ids in the order of the list; foreign ones last.
std::vector<std::string> hiddenIds();
/// Throws fsr::InputError where there is no such form.
const HiddenForm& findForm(const std::string& id, const std::string& form);

template <typename Type>
std::unique_ptr<Hidden> makeHidden(const HiddenSetup& setup) {
  return std::make_unique<Type>(setup);
}

/// Leads a state through the campaign: step(input, seconds) for every scan, then use(scan, state). In
/// the pauses between mounts the input is 0; where states are not carried over each mount begins with
/// a copy of `fresh`.
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

/// A factor of about 1 for each taxel.
std::vector<double> taxelScatter(const HiddenSetup& setup, const std::string& purpose, double deviation);

}  // namespace blind
