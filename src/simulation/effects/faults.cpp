#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

namespace {

// Bursts in which a line loses contact: time is cut into pieces as long as a burst, and each piece is
// bad with probability `share`, by the seed.
class LooseLine {
 public:
  /// `lines`: how many the matrix has. Throws InputError.
  LooseLine(const std::string& id, std::size_t lines, const EffectValues& values,
            const EffectContext& context);

  std::size_t line() const { return line_; }
  /// What is left of the line's conductance at a rig time [s]; exactly 1 between bursts.
  double contact(double time) const;

 private:
  std::size_t line_;
  double share_;
  double burst_;  // [s]
  double depth_;
  statistics::RandomStream stream_;
};

// A taxel, row or column by the seed.
std::size_t picked(const statistics::RandomStream& stream, std::uint64_t position, std::size_t choices) {
  return static_cast<std::size_t>(stream.uniform(position) * static_cast<double>(choices));
}

void requireWhole(const std::string& id, const std::string& parameter, double value, double low,
                  double high) {
  if (value == std::floor(value) && value >= low && value <= high) return;
  throw settings::InputError("effects." + id + ": " + parameter + " is " + std::to_string(value) +
                             ", but must be a whole number, " + settings::Range{low, high}.text());
}

// The parameters `taxels`, `first` and `start` that say which taxels are faulty, and since when.
std::vector<EffectParameter> faultyTaxelParameters() {
  return {
      strength("taxels", "how many", {0, 4096, "taxels"}, 1).within(1, 4096),
      shape("first", "index of the first one, row-major; -1 = by the seed", {-1, 4095, ""}, -1),
      shape("start", "when the fault begins", {0, 1e9, "s"}, 0),
  };
}

// The taxels that those parameters pick: `first`, or one by the seed where it is -1, and the others by
// the seed; none twice. Throws InputError where the matrix has no such taxel.
std::vector<std::size_t> faultyTaxels(const std::string& id, const EffectValues& values,
                                      const EffectContext& context) {
  const std::size_t taxels = context.layout.size.taxels();
  const double count = values.at("taxels"), first = values.at("first");
  requireWhole(id, "taxels", count, 0, static_cast<double>(taxels));
  requireWhole(id, "first", first, -1, static_cast<double>(taxels) - 1);
  const statistics::RandomStream stream = statistics::randomStream(context.seed, id);
  std::vector<std::size_t> faulty;
  if (first >= 0 && count > 0) faulty.push_back(static_cast<std::size_t>(first));
  for (std::uint64_t draw = 0; static_cast<double>(faulty.size()) < count; ++draw) {
    const std::size_t taxel = picked(stream, draw, taxels);
    if (std::find(faulty.begin(), faulty.end(), taxel) == faulty.end()) faulty.push_back(taxel);
  }
  return faulty;
}

// The spells of the context; without one, those taxels from `start` on.
std::vector<FaultSpell> faultSpells(const std::string& id, const EffectValues& values,
                                    const EffectContext& context) {
  const std::vector<std::size_t> faulty = faultyTaxels(id, values, context);
  if (!context.spells.empty()) return context.spells;
  const auto value = values.find("value");  // of stuck_taxel
  std::vector<FaultSpell> spells;
  for (const std::size_t taxel : faulty)
    spells.push_back({taxel, values.at("start"), kForever, value == values.end() ? 0 : value->second});
  return spells;
}

bool isIn(const FaultSpell& spell, double time) {
  return time >= spell.from && time <= spell.to;
}

// The parameters `share`, `line`, `burst` and `depth` of a line with a loose contact.
std::vector<EffectParameter> looseLineParameters(const std::string& line) {
  return {
      strength("share", "share of time without contact", {0, 1, ""}, 0.05).within(1e-4, 1),
      shape("line", "which " + line + "; -1 = by the seed", {-1, matrix::kMaxMatrixSide - 1, ""}, -1),
      shape("burst", "length of a burst", {1e-3, 3600, "s"}, 0.5),
      shape("depth", "share of the conductance that is lost in a burst", {0, 1, ""}, 1),
  };
}

LooseLine::LooseLine(const std::string& id, std::size_t lines, const EffectValues& values,
                     const EffectContext& context)
    : share_(values.at("share")),
      burst_(values.at("burst")),
      depth_(values.at("depth")),
      stream_(statistics::randomStream(context.seed, id)) {
  const double line = values.at("line");
  requireWhole(id, "line", line, -1, static_cast<double>(lines) - 1);
  line_ = line < 0 ? picked(statistics::randomStream(context.seed, id + ".line"), 0, lines)
                   : static_cast<std::size_t>(line);
}

double LooseLine::contact(double time) const {
  const auto piece = static_cast<std::uint64_t>(std::floor(std::max(time, 0.0) / burst_));
  return stream_.uniform(piece) < share_ ? 1 - depth_ : 1;
}

}  // namespace

// A taxel has no contact, or loses it in the course of a time T_f.
//
//     G_i = G_i max(0, 1 - (t - t_0) / T_f) from a start time t_0 on;   G_i = 0 for T_f = 0
//
// Causes: a cracked trace, a detached layer; a contact that corrodes.

namespace {

class DeadTaxel : public Effect {
 public:
  DeadTaxel(const EffectValues& values, const EffectContext& context)
      : spells_(faultSpells("dead_taxel", values, context)), fades_over_(values.at("fades_over")) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    for (const FaultSpell& spell : spells_) {
      if (!isIn(spell, sample.time)) continue;
      const double since = sample.time - spell.from;
      signals.conductance[spell.taxel] *= since < fades_over_ ? 1 - since / fades_over_ : 0;
    }
  }

 private:
  std::vector<FaultSpell> spells_;
  double fades_over_;  // T_f [s]
};

}  // namespace

EffectEntry deadTaxel() {
  EffectInfo info;
  info.id = "dead_taxel";
  info.summary = "a taxel that conducts nothing, or less and less";
  info.equation = "G_i *= max(0, 1 - (t - t_0) / T_f); G_i = 0 for T_f = 0";
  info.source = "fault";
  info.stage = ChainStage::kConductance;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kDetector;
  info.parameters = faultyTaxelParameters();
  info.parameters.push_back(shape("fades_over", "T_f; 0 = at once", {0, 1e9, "s"}, 0));
  info.depends_on = {Covariate::kTaxel};
  info.collinear = {"stuck_taxel"};
  info.detector = Detector::kDeadTaxels;
  return {info, makeEffect<DeadTaxel>};
}

// A taxel always has the same reading.
//
//     y_i = const from a start time on   [counts]
//
// Causes: a short circuit, a crease, a converter that returns an old value. With `value` -1 the taxel keeps
// the reading that it had when the fault began.

namespace {

class StuckTaxel : public Effect {
 public:
  StuckTaxel(const EffectValues& values, const EffectContext& context)
      : spells_(faultSpells("stuck_taxel", values, context)) {
    state_.assign(2 * spells_.size(), 0.0);  // of each spell: whether it has begun, and its reading [counts]
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    for (std::size_t k = 0; k < spells_.size(); ++k) {
      const FaultSpell& spell = spells_[k];
      if (!isIn(spell, sample.time)) continue;
      double& reading = signals.reading[spell.taxel];
      double *begun = &state_[2 * k], *kept = begun + 1;
      if (*begun == 0) *kept = spell.reading < 0 ? reading : spell.reading;
      *begun = 1;
      reading = *kept;
    }
  }

 private:
  std::vector<FaultSpell> spells_;
};

}  // namespace

EffectEntry stuckTaxel() {
  EffectInfo info;
  info.id = "stuck_taxel";
  info.summary = "a taxel that always reads the same";
  info.equation = "y_i = const";
  info.source = "fault";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kDetector;
  info.parameters = faultyTaxelParameters();
  info.parameters.push_back(
      shape("value", "where it is stuck; -1 = where the fault found it", {-1, 65535, "counts"}, 1000));
  info.depends_on = {Covariate::kTaxel};
  info.collinear = {"dead_taxel"};
  info.detector = Detector::kStuckTaxels;
  return {info, makeEffect<StuckTaxel>};
}

// The wire of a row or of a column has a bad contact. All its taxels lose conductance together, in bursts.
//
//     G_i = G_i (1 - depth) in a burst, for all taxels i of the line
//
// Causes: a crimped connector, a cracked tail. The form of a burst is an assumption.

namespace {

EffectInfo lineFaultInfo(const std::string& line, EffectLevel level, Covariate covariate, Detector detector) {
  EffectInfo info;
  info.id = line + "_fault";
  info.summary = "a " + line + " loses contact in bursts";
  info.equation = "G_i *= 1 - depth in a burst, i in the " + line;
  info.source = "fault";
  info.stage = ChainStage::kReadOut;
  info.level = level;
  info.kind = EffectKind::kDetector;
  info.parameters = looseLineParameters(line);
  info.depends_on = {covariate, Covariate::kClockTime};
  info.collinear = {level == EffectLevel::kRow ? "column_fault" : "row_fault"};
  info.by_chance = true;
  info.detector = detector;
  return info;
}

template <bool row>
class LineFault : public Effect {
 public:
  LineFault(const EffectValues& values, const EffectContext& context)
      : size_(context.layout.size),
        line_(row ? "row_fault" : "column_fault", row ? size_.rows : size_.columns, values, context),
        spells_(context.spells) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (spells_.empty()) weaken(line_.line(), line_.contact(sample.time), signals);
    for (const FaultSpell& spell : spells_) {
      if (isIn(spell, sample.time)) weaken(spell.taxel, 1 - spell.reading, signals);
    }
  }

 private:
  void weaken(std::size_t line, double contact, TaxelSignals& signals) const {
    const std::size_t columns = size_.columns;
    const std::size_t first = row ? line * columns : line;
    const std::size_t taxels = row ? columns : size_.rows;
    for (std::size_t k = 0; k < taxels; ++k) signals.conductance[first + k * (row ? 1 : columns)] *= contact;
  }

  matrix::MatrixSize size_;
  LooseLine line_;
  std::vector<FaultSpell> spells_;
};

}  // namespace

EffectEntry rowFault() {
  return {lineFaultInfo("row", EffectLevel::kRow, Covariate::kRow, Detector::kRowFaults),
          makeEffect<LineFault<true>>};
}

EffectEntry columnFault() {
  return {lineFaultInfo("column", EffectLevel::kColumn, Covariate::kColumn, Detector::kColumnFaults),
          makeEffect<LineFault<false>>};
}

}  // namespace fsr::simulation
