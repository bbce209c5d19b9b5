// One checker for all effects of the library: what each says of itself holds, and each behaves as every
// effect must.

#include "simulation/effects/effect_library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/pressure_profile.h"
#include "simulation/rig.h"
#include "simulation/sensitivity.h"
#include "support/allocation_guard.h"
#include "support/simulated_rig.h"

namespace {

using fsr::simulation::EffectEntry;
using fsr::simulation::EffectKind;
using fsr::simulation::EffectParameter;
using fsr::simulation::EffectValues;
using fsr::simulation::ParameterRole;
using fsr::simulation::RigSample;
using fsr::simulation::SensorChain;
using fsr::simulation::SimulationSettings;
using test_support::rig;

// A run that lets every effect show: two cycles, warming up, a second mount half-way on another surface
// under a disc. The fault that needs time has it: 140 s.
class Course {
 public:
  Course() : profile_(fsr::simulation::pressureProfile({500e3, 20e3, 30e3, 20, 8, 2})) {}
  int scans() const { return static_cast<int>(profile_.duration() / kPeriod); }

  template <typename Chain>
  void prepare(Chain& chain, int scan) const {
    if (scan == 0) chain.mount(test_support::cylinder(0.07, 1));
    if (scan == scans() / 2) {
      chain.mount(test_support::cylinder(0.05, 2),
                  {fsr::simulation::LoadPattern::Kind::kDisc, {0, 0}, 0.015, 0});
    }
  }
  RigSample sample(int scan) const {
    const double time = scan * kPeriod;
    return {time, profile_.at(time), static_cast<std::uint64_t>(scan), 23 + time / 40, &course_};
  }

 private:
  static constexpr double kPeriod = 0.3;  // [s]
  fsr::simulation::PressureProfile profile_;
  fsr::simulation::PressureCourse course_ = [this](double time) { return profile_.at(time); };
};

const Course kCourse;

void readOn(SensorChain& chain, int first, int last, std::vector<double>& readings) {
  for (int scan = first; scan < last; ++scan) {
    kCourse.prepare(chain, scan);
    chain.read(kCourse.sample(scan));
    readings.insert(readings.end(), chain.reading().begin(), chain.reading().end());
  }
}

/// Unrounded readings of all scans and taxels, and what the reference shows.
std::vector<double> run(const SimulationSettings& settings) {
  SensorChain chain(settings);
  const fsr::simulation::ReferenceChannel reference(settings);
  std::vector<double> readings;
  readOn(chain, 0, kCourse.scans(), readings);
  for (int scan = 0; scan < kCourse.scans(); ++scan) {
    readings.push_back(reference.indicated(kCourse.sample(scan).pressure));
  }
  return readings;
}

EffectValues usualValues(const EffectEntry& entry) {
  EffectValues values;
  for (const auto& parameter : entry.info.parameters) values[parameter.name] = parameter.usual;
  return values;
}

EffectValues neutralValues(const EffectEntry& entry) {
  EffectValues values;
  for (const auto& parameter : entry.info.parameters) {
    values[parameter.name] = std::isnan(parameter.neutral) ? parameter.usual : parameter.neutral;
  }
  return values;
}

SimulationSettings with(const std::string& id, const EffectValues& values) {
  SimulationSettings settings = rig("", 3, 4);
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(), [&](const auto& e) { return e.id == id; }),
                effects.end());
  effects.push_back({id, values});
  return settings;
}

bool simulated(const EffectEntry& entry) {
  return entry.make != nullptr;
}

/// Runs a check on each effect, and says on failure on which.
template <typename Check>
void onEvery(bool (*wanted)(const EffectEntry&), Check check) {
  for (const EffectEntry& entry : fsr::simulation::effectLibrary()) {
    if (!wanted(entry)) continue;
    SCOPED_TRACE(entry.info.id);
    check(entry);
  }
}

bool any(const EffectEntry&) {
  return true;
}
bool optional(const EffectEntry& entry) {
  return simulated(entry) && !entry.info.required;
}
bool triedByStrength(const EffectEntry& entry) {
  return entry.info.kind == EffectKind::kAdditive || entry.info.kind == EffectKind::kGrid;
}

TEST(EffectLibrary, HoldsTheEffectsThatAreKnownByName) {
  const std::vector<std::string> ids = fsr::simulation::effectIds();
  std::istringstream words(
      "static_curve turn_on bending_preload bending_gain hysteresis creep drift temperature "
      "break_in wear time_skew scan_skew crosstalk saturation supply_droop mains_pickup "
      "seal_leak trapped_gas repositioning stuck_taxel edge_stiffness dead_taxel row_fault "
      "column_fault compliance shear wrinkle humidity converter white_noise transducer_error "
      "relaxation session_offset");
  const std::set<std::string> known{std::istream_iterator<std::string>(words), {}};
  EXPECT_EQ(ids.size(), known.size());
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()), known);
  EXPECT_EQ(fsr::simulation::findEffect("hysterese"), nullptr);
}

TEST(EveryEffect, DescribesItself) {
  onEvery(any, [](const EffectEntry& entry) {
    for (const std::string& text : {entry.info.summary, entry.info.equation, entry.info.source})
      EXPECT_FALSE(text.empty());
    EXPECT_FALSE(entry.info.depends_on.empty() && entry.info.kind != EffectKind::kBase);
    EXPECT_EQ(simulated(entry), entry.info.kind != EffectKind::kListed);
    if (entry.info.kind == EffectKind::kListed) {
      EXPECT_NE(entry.info.experiment, fsr::simulation::Experiment::kNone);
    }
    const bool tried_by_strength =
        entry.info.kind == EffectKind::kAdditive || entry.info.kind == EffectKind::kGrid;
    if (tried_by_strength) {
      EXPECT_FALSE(strengths(entry.info).empty());
    }
    for (const std::string& text : {name(entry.info.stage), name(entry.info.level), name(entry.info.kind),
                                    name(entry.info.sign), name(entry.info.experiment)}) {
      EXPECT_FALSE(text.empty());
    }
    for (const auto covariate : entry.info.depends_on) EXPECT_FALSE(name(covariate).empty());
    for (const auto evidence : entry.info.needs) EXPECT_FALSE(name(evidence).empty());
  });
}

TEST(EveryEffect, HasParametersInTheirRanges) {
  onEvery(any, [](const EffectEntry& entry) {
    bool tried = false;
    for (const EffectParameter& parameter : entry.info.parameters) {
      const auto& [permitted, plausible] = std::tie(parameter.permitted, parameter.plausible);
      EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
      EXPECT_TRUE(permitted.contains(parameter.usual)) << parameter.name;
      EXPECT_TRUE(permitted.contains(plausible.low) && permitted.contains(plausible.high)) << parameter.name;
      EXPECT_LE(plausible.low, plausible.high) << parameter.name;
      EXPECT_TRUE(plausible.contains(parameter.usual) || parameter.usual == parameter.neutral)
          << parameter.name;
      EXPECT_EQ(plausible.unit, permitted.unit) << parameter.name;
      if (parameter.role != ParameterRole::kShape) {
        EXPECT_TRUE(permitted.contains(parameter.neutral));
      }
      for (const double value : parameter.tried) EXPECT_TRUE(permitted.contains(value)) << parameter.name;
      tried = tried || !parameter.tried.empty();
      if (parameter.role == ParameterRole::kShape) continue;
      EXPECT_TRUE(parameter.tried.empty()) << parameter.name << " is linear: one derivative tells all";
    }
    if (entry.info.kind == EffectKind::kGrid) {
      EXPECT_TRUE(tried);
    }
    if (entry.info.kind == EffectKind::kAdditive) {
      EXPECT_FALSE(tried);
    }
  });
}

TEST(EveryEffect, HasStrengthsOfTheSignThatItStates) {
  onEvery(triedByStrength, [](const EffectEntry& entry) {
    for (const EffectParameter& strength : strengths(entry.info)) {
      if (entry.info.sign == fsr::simulation::SignRule::kPositive) {
        EXPECT_GE(strength.plausible.low, 0) << strength.name;
      }
      if (entry.info.sign == fsr::simulation::SignRule::kNegative) {
        EXPECT_LE(strength.plausible.high, 0) << strength.name;
      }
    }
  });
}

TEST(EveryEffect, KnowsItsDoublesAndTheyKnowIt) {
  onEvery(simulated, [](const EffectEntry& entry) {
    for (const std::string& id : entry.info.collinear) {
      const EffectEntry* other = fsr::simulation::findEffect(id);
      ASSERT_NE(other, nullptr) << id;
      const auto& back = other->info.collinear;
      EXPECT_NE(std::find(back.begin(), back.end(), entry.info.id), back.end()) << id << " does not list it";
    }
  });
}

TEST(EveryEffect, AtNeutralChangesNothingBitForBit) {
  onEvery(optional, [](const EffectEntry& entry) {
    EXPECT_EQ(run(with(entry.info.id, neutralValues(entry))), run(rig("", 3, 4)));
  });
}

// So simulation files that do not know these parameters give the same readings as before.
TEST(EffectLibrary, UsesOtherFormsOfAnEffectOnlyWhereTheSettingsAskForThem) {
  const std::vector<std::pair<std::string, std::string>> forms = {
      {"time_skew", "rate"},        {"hysteresis", "rayleigh"}, {"seal_leak", "orifice_share"},
      {"temperature", "reference"}, {"temperature", "start"},   {"temperature", "zero_shift"},
      {"wear", "fading"},           {"wear", "impulse_share"}};
  for (const auto& [id, name] : forms) {
    const EffectParameter& form = parameter(fsr::simulation::findEffect(id)->info, name);
    EXPECT_EQ(form.usual, form.neutral) << id << "." << name;
  }
}

TEST(EveryEffect, AtItsUsualSizeDoesSomething) {
  onEvery(optional, [](const EffectEntry& entry) {
    EXPECT_NE(run(with(entry.info.id, usualValues(entry))), run(rig("", 3, 4)));
  });
}

TEST(EveryEffect, EveryParameterThatIsOffAtNeutralDoesSomethingWhenOn) {
  onEvery(simulated, [](const EffectEntry& entry) {
    for (const EffectParameter& parameter : entry.info.parameters) {
      if (std::isnan(parameter.neutral) || parameter.usual != parameter.neutral) continue;
      EffectValues values = usualValues(entry);
      const std::vector<double> off = run(with(entry.info.id, values));
      const double on = std::isfinite(parameter.plausible.high) ? parameter.plausible.high : 1;
      values[parameter.name] = parameter.role == ParameterRole::kScatter ? on / 4 : on;
      EXPECT_NE(run(with(entry.info.id, values)), off) << parameter.name;
    }
  });
}

TEST(EveryEffect, StaysFiniteAtTheEndsOfEveryPermittedRange) {
  onEvery(simulated, [](const EffectEntry& entry) {
    for (const EffectParameter& parameter : entry.info.parameters) {
      for (const double end : {parameter.permitted.low, parameter.permitted.high}) {
        EffectValues values = usualValues(entry);
        values[parameter.name] = end;
        std::vector<double> readings;
        try {
          readings = run(with(entry.info.id, values));
        } catch (const fsr::settings::InputError&) {
          continue;  // refused because it does not go with the other parameters
        }
        EXPECT_TRUE(std::all_of(readings.begin(), readings.end(), [](double y) { return std::isfinite(y); }))
            << parameter.name << " = " << end;
      }
    }
  });
}

TEST(EveryEffect, GoesOnFromASavedState) {
  onEvery(simulated, [](const EffectEntry& entry) {
    const SimulationSettings settings = with(entry.info.id, usualValues(entry));
    SensorChain chain(settings), resumed(settings);
    const int half = kCourse.scans() / 2 + 10;  // the second mount came before
    std::vector<double> before, after, again;
    readOn(chain, 0, half, before);
    kCourse.prepare(resumed, 0);
    kCourse.prepare(resumed, kCourse.scans() / 2);
    resumed.restore(chain.state());
    readOn(chain, half, kCourse.scans(), after);
    readOn(resumed, half, kCourse.scans(), again);
    EXPECT_EQ(again, after);
  });
}

TEST(EveryEffect, ForgetsItsHistoryWhenReset) {
  onEvery(simulated, [](const EffectEntry& entry) {
    const SimulationSettings settings = with(entry.info.id, usualValues(entry));
    SensorChain chain(settings);
    std::vector<double> first, second;
    readOn(chain, 0, kCourse.scans(), first);
    chain.reset();
    readOn(chain, 0, kCourse.scans(), second);
    EXPECT_EQ(second, first);
  });
}

TEST(EveryEffect, ReadsWithoutAllocating) {
  onEvery(simulated, [](const EffectEntry& entry) {
    SensorChain chain(with(entry.info.id, usualValues(entry)));
    std::vector<RigSample> samples;
    for (int scan = 0; scan < 100; ++scan) samples.push_back(kCourse.sample(scan));
    chain.read(samples[0]);
    const test_support::AllocationGuard guard;
    for (const RigSample& sample : samples) chain.read(sample);
    EXPECT_EQ(guard.allocations(), 0u);
  });
}

// The slope of the reading from a step of its own, 1,000 times larger than Sensitivity's and of second
// order, one-sided where the strength is.
std::vector<double> slope(const EffectEntry& entry, EffectValues values, const EffectParameter& strength) {
  const double scale = strength.usual != 0 ? std::abs(strength.usual) : 0.1 * strength.plausible.high;
  const bool one_sided = strength.permitted.low == strength.neutral;
  const double step = one_sided ? 1e-3 * scale : 1e-2 * scale;
  const auto at = [&](double value) {
    values[strength.name] = value;
    SensorChain chain(with(entry.info.id, values));
    std::vector<double> readings;
    readOn(chain, 0, kCourse.scans(), readings);
    return readings;
  };
  const auto low = at(one_sided ? 0 : -step), middle = at(one_sided ? step : 0),
             high = at(one_sided ? 2 * step : step);
  std::vector<double> slopes;
  for (std::size_t i = 0; i < low.size(); ++i) {
    slopes.push_back(one_sided ? (4 * middle[i] - 3 * low[i] - high[i]) / (2 * step)
                               : (high[i] - low[i]) / (2 * step));
  }
  return slopes;
}

// Below this the static curve's exponent of 0.9 has no slope to speak of [Pa].
constexpr double kNoLoad = 2e3;

TEST(EveryEffect, ItsDerivativesAgreeWithFiniteDifferences) {
  onEvery(triedByStrength, [](const EffectEntry& entry) {
    if (entry.info.stage == fsr::simulation::ChainStage::kReference) return;  // see TransducerError
    for (const EffectParameter& strength : strengths(entry.info)) {
      fsr::simulation::Sensitivity sensitivity(rig("", 3, 4), entry.info.id, strength.name);
      const std::vector<double> expected = slope(entry, neutralValues(entry), strength);
      double error = 0, size = 0;  // sums of squares
      for (int scan = 0; scan < kCourse.scans(); ++scan) {
        kCourse.prepare(sensitivity, scan);
        const auto& derivative = sensitivity.read(kCourse.sample(scan)).reading;
        if (kCourse.sample(scan).pressure < kNoLoad) continue;
        for (std::size_t i = 0; i < derivative.size(); ++i) {
          const double wanted = expected[std::size_t(scan) * derivative.size() + i];
          error += (derivative[i] - wanted) * (derivative[i] - wanted);
          size += wanted * wanted;
        }
      }
      EXPECT_GT(size, 0) << strength.name;
      EXPECT_LT(std::sqrt(error / size), 0.01) << strength.name;
    }
  });
}

}  // namespace
