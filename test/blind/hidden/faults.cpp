// Taxels and lines that fail, permanently or at times. The duration of the failure is the strength.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

// Scans first .. last - 1, within one mount.
struct Spell {
  std::size_t first, last;
};

class Fault : public Hidden {
 public:
  std::vector<std::size_t> taxels() const override { return taxels_; }
  std::vector<std::pair<double, double>> times() const override {
    std::vector<std::pair<double, double>> times;
    for (const Spell& spell : spells_) {
      times.emplace_back(setup_.campaign.time[spell.first], setup_.campaign.time[spell.last - 1]);
    }
    return times;
  }

 protected:
  Fault(const HiddenSetup& setup, const char* purpose) : setup_(setup), random_(setup.seed, purpose) {}

  void hitTaxels() {
    const std::size_t number = setup_.campaign.taxels();
    taxels_ = random_.choose(1 + random_.below(std::max<std::size_t>(1, number / 30)), number);
  }
  // From a random time to the end.
  void failForGood() {
    if (setup_.strength <= 0) return;
    const double share = std::min(0.95, random_.uniform(0.2, 0.4) * setup_.strength);
    const std::size_t scans = setup_.campaign.first_scans;
    addSpell(scans - std::max<std::size_t>(10, static_cast<std::size_t>(share * static_cast<double>(scans))),
             setup_.campaign.scans());
  }
  // At the usual strength, spells last `seconds` on average and take `share` of the time in total. A stronger
  // fault has more and longer spells, which include those of a weaker fault.
  void failNowAndThen(double share, double seconds, bool random_lengths = false) {
    const auto scans = static_cast<double>(setup_.campaign.scans());
    const double root = std::sqrt(setup_.strength);
    const double usual = seconds / setup_.campaign.scan_period;  // [scans]
    const auto number = static_cast<std::size_t>(std::ceil(share * scans / usual * root));
    for (std::size_t i = 0; i < number; ++i) {
      const double factor = random_lengths ? -std::log(random_.uniform()) : random_.uniform(0.5, 1.5);
      const double length = std::clamp(usual * root * factor, 3.0, 0.2 * scans);
      const auto first = static_cast<std::size_t>(random_.uniform() * (scans - 0.2 * scans));
      addSpell(first, first + static_cast<std::size_t>(length));
    }
    std::sort(spells_.begin(), spells_.end(),
              [](const Spell& a, const Spell& b) { return a.first < b.first; });
    parameters_.push_back({"spells", static_cast<double>(number), "1"});
  }
  bool hits(std::size_t taxel) const { return std::binary_search(taxels_.begin(), taxels_.end(), taxel); }
  template <typename Use>
  void eachHitScan(std::size_t taxel, Use use) const {
    if (!hits(taxel)) return;
    for (const Spell& spell : spells_) {
      for (std::size_t scan = spell.first; scan < spell.last; ++scan) use(spell, scan);
    }
  }

  HiddenSetup setup_;
  Random random_;
  std::vector<std::size_t> taxels_;  // ascending
  std::vector<Spell> spells_;

 private:
  void addSpell(std::size_t first, std::size_t last) {
    for (const Visit& visit : setup_.campaign.visits) {
      const Spell part{std::max(first, visit.first), std::min(last, visit.last)};
      if (part.first < part.last) spells_.push_back(part);
    }
  }
};

// --- stuck: always the same code ------------------------------------------------------------------

class Stuck : public Fault {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    const Trace before = reading;
    eachHitScan(taxel, [&](const Spell& spell, std::size_t scan) {
      reading[scan] = level_ < 0 ? before[spell.first] : level_;
    });
  }
  void onNoise(std::size_t taxel, Trace& factor) const override {
    eachHitScan(taxel, [&](const Spell&, std::size_t scan) { factor[scan] = 0; });
  }

 protected:
  explicit Stuck(const HiddenSetup& setup) : Fault(setup, "stuck") { hitTaxels(); }
  double level_ = -1;  // [share of full scale]; negative = the last reading
};

class Frozen : public Stuck {
 public:
  explicit Frozen(const HiddenSetup& setup) : Stuck(setup) { failForGood(); }
};

class FrozenSpells : public Stuck {
 public:
  explicit FrozenSpells(const HiddenSetup& setup) : Stuck(setup) { failNowAndThen(0.3, 40); }
};

class AtALevel : public Stuck {
 public:
  explicit AtALevel(const HiddenSetup& setup) : Stuck(setup) {
    level_ = random_.uniform(0.1, 0.95);
    parameters_.push_back({"level", level_, "share of full scale"});
    failForGood();
  }
};

// Silver grows between two lines and shorts the taxel: within a minute or so the reading moves to a level,
// where it stays. Source: S. J. Krumbein, Metallic electromigration phenomena, IEEE Trans. Compon. Hybrids
// Manuf. Technol. 11 (1988) 5.
class Migrating : public Stuck {
 public:
  explicit Migrating(const HiddenSetup& setup)
      : Stuck(setup), end_(random_.uniform(0.3, 0.95)), time_(random_.uniform(5, 40)) {
    parameters_ = {{"level", end_, "share of full scale"}, {"time_constant", time_, "s"}};
    failForGood();
  }
  void onReading(std::size_t taxel, Trace& reading) const override {
    if (spells_.empty()) return;
    const std::size_t start = spells_.front().first;
    eachHitScan(taxel, [&](const Spell&, std::size_t scan) {
      const double still = std::exp(-(setup_.campaign.time[scan] - setup_.campaign.time[start]) / time_);
      reading[scan] = end_ + (reading[scan] - end_) * still;
    });
  }

 private:
  double end_, time_;
};

// The taxel's value is not refreshed during the bad stays of a two-state process.
// Source: E. N. Gilbert, Capacity of a burst-noise channel, Bell Syst. Tech. J. 39 (1960) 1253.
class BadStays : public Stuck {
 public:
  explicit BadStays(const HiddenSetup& setup) : Stuck(setup) { failNowAndThen(0.3, 25, true); }
};

// --- dead: no conductance -------------------------------------------------------------------------

class Dead : public Fault {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    eachHitScan(taxel, [&](const Spell& spell, std::size_t scan) { reading[scan] *= left(spell, scan); });
  }
  void onNoise(std::size_t taxel, Trace& factor) const override {
    eachHitScan(taxel, [&](const Spell&, std::size_t scan) { factor[scan] = 0.1; });
  }

 protected:
  explicit Dead(const HiddenSetup& setup) : Fault(setup, "dead") { hitTaxels(); }
  virtual double left(const Spell&, std::size_t) const { return 0; }
};

class Open : public Dead {
 public:
  explicit Open(const HiddenSetup& setup) : Dead(setup) { failForGood(); }
};

class OpenSpells : public Dead {
 public:
  explicit OpenSpells(const HiddenSetup& setup) : Dead(setup) { failNowAndThen(0.2, 8); }
};

// The contact is lost within seconds and returns at once.
class Fading : public Dead {
 public:
  explicit Fading(const HiddenSetup& setup) : Dead(setup), time_(random_.uniform(3, 10)) {
    parameters_.push_back({"time_constant", time_, "s"});
    failNowAndThen(0.3, 60);
  }

 private:
  double left(const Spell& spell, std::size_t scan) const override {
    return std::exp(-static_cast<double>(scan - spell.first) * setup_.campaign.scan_period / time_);
  }
  double time_;
};

// The contact corrodes by fretting: its resistance grows exponentially until nothing is left of the reading.
// Source: M. Antler, Survey of contact fretting in electrical connectors, IEEE Trans. Compon. Hybrids Manuf.
// Technol. 8 (1985) 87.
class Fretting : public Dead {
 public:
  explicit Fretting(const HiddenSetup& setup) : Dead(setup), time_(random_.uniform(5, 30)) {
    parameters_.push_back({"time_constant", time_, "s"});
    failForGood();
  }

 private:
  double left(const Spell&, std::size_t scan) const override {
    const double elapsed = setup_.campaign.time[scan] - setup_.campaign.time[spells_.front().first];
    return std::exp(-std::min(700.0, elapsed / time_));
  }
  double time_;
};

// Open during the bad stays of a two-state process.
// Source: E. N. Gilbert, Capacity of a burst-noise channel, Bell Syst. Tech. J. 39 (1960) 1253.
class OpenStays : public Dead {
 public:
  explicit OpenStays(const HiddenSetup& setup) : Dead(setup) { failNowAndThen(0.2, 15, true); }
};

// --- a row or a column ----------------------------------------------------------------------------

class LineFault : public Fault {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    eachHitScan(taxel, [&](const Spell& spell, std::size_t scan) {
      reading[scan] = disturbed(reading[scan], spell, scan);
    });
  }

 protected:
  LineFault(const HiddenSetup& setup, bool row) : Fault(setup, row ? "row fault" : "column fault") {
    const fsr::matrix::Layout& layout = setup.campaign.layout;
    const std::size_t line = random_.below(row ? layout.size.rows : layout.size.columns);
    for (std::size_t i = 0; i < setup.campaign.taxels(); ++i) {
      if ((row ? layout.row({i}) : layout.column({i})) == line) taxels_.push_back(i);
    }
    parameters_.push_back({row ? "row" : "column", static_cast<double>(line), "1"});
  }
  virtual double disturbed(double reading, const Spell& spell, std::size_t scan) const = 0;
};

// Short bursts, up or down, each with its own height.
template <bool kRow>
class Bursts : public LineFault {
 public:
  explicit Bursts(const HiddenSetup& setup) : LineFault(setup, kRow) { failNowAndThen(0.04, 1.5); }

 private:
  double disturbed(double reading, const Spell& spell, std::size_t) const override {
    Random burst(setup_.seed, "burst", spell.first);
    return std::clamp(reading + burst.sign() * burst.uniform(0.05, 0.2), 0.0, 0.99);
  }
};

// A loose plug adds a resistance to the line: high readings lose most.
template <bool kRow>
class LoosePlug : public LineFault {
 public:
  explicit LoosePlug(const HiddenSetup& setup)
      : LineFault(setup, kRow), resistance_(random_.uniform(0.3, 0.8)) {
    parameters_.push_back({"resistance", resistance_, "of the line's load"});
    failNowAndThen(0.06, 4);
  }

 private:
  double disturbed(double reading, const Spell&, std::size_t) const override {
    return reading / (1 + resistance_ * reading);
  }
  double resistance_;
};

// The line is open: the reading is zero, except for a part that couples from other lines.
template <bool kRow>
class Dropout : public LineFault {
 public:
  explicit Dropout(const HiddenSetup& setup) : LineFault(setup, kRow) { failNowAndThen(0.03, 0.8); }

 private:
  double disturbed(double reading, const Spell&, std::size_t) const override { return 0.05 * reading; }
};

// An intermittent short shifts the line by the same amount each time.
// Source: S. Machlup, Noise in semiconductors: spectrum of a two-parameter random signal, J. Appl. Phys. 25
// (1954) 341.
template <bool kRow>
class TwoLevels : public LineFault {
 public:
  explicit TwoLevels(const HiddenSetup& setup)
      : LineFault(setup, kRow), height_(random_.sign() * random_.uniform(0.06, 0.15)) {
    parameters_.push_back({"height", height_, "share of full scale"});
    failNowAndThen(0.05, 5, true);
  }

 private:
  double disturbed(double reading, const Spell&, std::size_t) const override {
    return std::clamp(reading + height_, 0.0, 0.99);
  }
  double height_;
};

// A fretted plug: in each bad spell another resistance, log-normally distributed, in series with the line.
// Source: M. Antler, Survey of contact fretting in electrical connectors, IEEE Trans. Compon. Hybrids Manuf.
// Technol. 8 (1985) 87.
template <bool kRow>
class FrettedPlug : public LineFault {
 public:
  explicit FrettedPlug(const HiddenSetup& setup) : LineFault(setup, kRow) { failNowAndThen(0.08, 3, true); }

 private:
  double disturbed(double reading, const Spell& spell, std::size_t) const override {
    Random draw(setup_.seed, "fretted", spell.first);
    return reading / (1 + 0.5 * std::exp(1.2 * draw.normal()) * reading);
  }
};

template <bool kRow>
std::vector<HiddenForm> linesOf(const char* id) {
  const std::vector<std::string> covariates = {kRow ? "row" : "column", "clock_time"};
  return {{id, "bursts", covariates, makeHidden<Bursts<kRow>>},
          {id, "loose_plug", covariates, makeHidden<LoosePlug<kRow>>},
          {id, "dropout", covariates, makeHidden<Dropout<kRow>>},
          {id, "two_levels", covariates, makeHidden<TwoLevels<kRow>>},
          inSetB({id, "fretted_plug", covariates, makeHidden<FrettedPlug<kRow>>})};
}

}  // namespace

std::vector<HiddenForm> stuckTaxelForms() {
  return {{"stuck_taxel", "frozen", {"taxel"}, makeHidden<Frozen>},
          {"stuck_taxel", "frozen_spells", {"taxel"}, makeHidden<FrozenSpells>},
          {"stuck_taxel", "at_a_level", {"taxel"}, makeHidden<AtALevel>},
          {"stuck_taxel", "migrating", {"taxel"}, makeHidden<Migrating>},
          inSetB({"stuck_taxel", "bad_stays", {"taxel"}, makeHidden<BadStays>})};
}

std::vector<HiddenForm> deadTaxelForms() {
  return {{"dead_taxel", "open", {"taxel"}, makeHidden<Open>},
          {"dead_taxel", "open_spells", {"taxel"}, makeHidden<OpenSpells>},
          {"dead_taxel", "fading", {"taxel"}, makeHidden<Fading>},
          {"dead_taxel", "fretting", {"taxel"}, makeHidden<Fretting>},
          inSetB({"dead_taxel", "bad_stays", {"taxel"}, makeHidden<OpenStays>})};
}

std::vector<HiddenForm> lineFaultForms() {
  std::vector<HiddenForm> forms = linesOf<true>("row_fault");
  const std::vector<HiddenForm> columns = linesOf<false>("column_fault");
  forms.insert(forms.end(), columns.begin(), columns.end());
  return forms;
}

}  // namespace blind
