// A sheet that is mounted again lies slightly differently: a field that is smooth in space changes by mount.

#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

// Position on the sheet, -1 .. 1 in both directions.
struct Place {
  double x, y;
};

class Repositioning : public Hidden {
 protected:
  explicit Repositioning(const HiddenSetup& setup) : setup_(setup), random_(setup.seed, "repositioning") {
    const fsr::matrix::Layout& layout = setup.campaign.layout;
    for (std::size_t i = 0; i < setup.campaign.taxels(); ++i) {
      const fsr::matrix::Position at = layout.position({i});
      const double half_x = std::max(1, layout.size.columns - 1) * layout.pitch_x / 2;
      const double half_y = std::max(1, layout.size.rows - 1) * layout.pitch_y / 2;
      places_.push_back({at.x / half_x, at.y / half_y});
    }
  }
  // Computes `value` of every mount and place; calls use(scan, value) for the scans of one taxel.
  template <typename Use>
  void eachScan(std::size_t taxel, Use use) const {
    for (std::size_t v = 0; v < setup_.campaign.visits.size(); ++v) {
      const Visit& visit = setup_.campaign.visits[v];
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) use(scan, field_[v][taxel]);
    }
  }
  HiddenSetup setup_;
  Random random_;
  std::vector<Place> places_;
  std::vector<std::vector<double>> field_;  // [visit][taxel]
};

// The surface is uneven, and the sheet lies beside its previous place.
class ShiftedMap : public Repositioning {
 public:
  explicit ShiftedMap(const HiddenSetup& setup) : Repositioning(setup) {
    const double size = random_.uniform(0.03, 0.05) * setup.strength;  // share of the load
    const double wave_x = random_.uniform(2, 3.5), wave_y = random_.uniform(2, 3.5);
    const double phase_x = random_.uniform(0, 2 * M_PI), phase_y = random_.uniform(0, 2 * M_PI);
    for (std::size_t v = 0; v < setup.campaign.visits.size(); ++v) {
      const Place shift{0.4 * random_.normal(), 0.4 * random_.normal()};
      field_.emplace_back();
      for (const Place& place : places_) {
        const double ridge = std::sin(wave_x * (place.x + shift.x) + phase_x);
        const double valley = std::cos(wave_y * (place.y + shift.y) + phase_y);
        field_.back().push_back(1 + size * (ridge + valley));
      }
    }
    parameters_ = {{"relief", size, "share of the load"}};
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    eachScan(taxel, [&](std::size_t scan, double factor) { load[scan] *= factor; });
  }
};

// One side is pulled tighter than the other: the preload is a plane.
class Tilt : public Repositioning {
 public:
  explicit Tilt(const HiddenSetup& setup) : Repositioning(setup) {
    const double size = random_.uniform(8e3, 15e3) * setup.strength;  // [Pa]
    for (std::size_t v = 0; v < setup.campaign.visits.size(); ++v) {
      const double all = 0.5 * random_.normal(), x = random_.normal(), y = random_.normal();
      field_.emplace_back();
      for (const Place& place : places_) field_.back().push_back(size * (all + x * place.x + y * place.y));
    }
    parameters_ = {{"tilt", size, "Pa"}};
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    eachScan(taxel, [&](std::size_t scan, double preload) { load[scan] += preload; });
  }
};

// A bubble of glue or air changes the gain of the sheet above it.
class Bubble : public Repositioning {
 public:
  explicit Bubble(const HiddenSetup& setup) : Repositioning(setup) {
    const double size = random_.uniform(0.06, 0.1) * setup.strength;
    for (std::size_t v = 0; v < setup.campaign.visits.size(); ++v) {
      const Place centre{random_.uniform(-1, 1), random_.uniform(-1, 1)};
      const double depth = random_.uniform(0.5, 1.2);
      field_.emplace_back();
      for (const Place& place : places_) {
        const double square = std::pow(place.x - centre.x, 2) + std::pow(place.y - centre.y, 2);
        field_.back().push_back(1 - size * depth / (1 + 2 * square));
      }
    }
    parameters_ = {{"depth", size, "share of the rise"}};
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    eachScan(taxel, [&](std::size_t scan, double factor) { gain[scan] *= factor; });
  }
};

// The gain differs by a smooth random field, a sum of cosine waves of random directions.
// Source: M. Shinozuka, G. Deodatis, Simulation of stochastic processes by spectral representation, Appl.
// Mech. Rev. 44 (1991) 191.
class RandomField : public Repositioning {
 public:
  explicit RandomField(const HiddenSetup& setup) : Repositioning(setup) {
    const double size = random_.uniform(0.02, 0.04) * setup.strength;
    constexpr int kWaves = 12;
    for (std::size_t v = 0; v < setup.campaign.visits.size(); ++v) {
      field_.emplace_back(places_.size(), 1.0);
      for (int wave = 0; wave < kWaves; ++wave) {
        const double x = 1.8 * random_.normal(), y = 1.8 * random_.normal(),
                     phase = random_.uniform(0, 2 * M_PI);
        for (std::size_t i = 0; i < places_.size(); ++i) {
          field_.back()[i] +=
              size * std::sqrt(2.0 / kWaves) * std::cos(x * places_[i].x + y * places_[i].y + phase);
        }
      }
    }
    parameters_ = {{"deviation", size, "share of the rise"}};
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    eachScan(taxel, [&](std::size_t scan, double factor) { gain[scan] *= factor; });
  }
};

// The sheet wrinkles along a line: a ridge of preload with a trough on either side.
// Source: E. Cerda, L. Mahadevan, Geometry and physics of wrinkling, Phys. Rev. Lett. 90 (2003) 074302.
class Wrinkle : public Repositioning {
 public:
  explicit Wrinkle(const HiddenSetup& setup) : Repositioning(setup) {
    const double size = random_.uniform(12e3, 25e3) * setup.strength;  // [Pa]
    const double width = random_.uniform(0.35, 0.7);
    for (std::size_t v = 0; v < setup.campaign.visits.size(); ++v) {
      const double angle = random_.uniform(0, M_PI), where = random_.uniform(-0.8, 0.8);
      const double height = random_.uniform(0.5, 1.5);
      field_.emplace_back();
      for (const Place& place : places_) {
        const double off = (place.x * std::cos(angle) + place.y * std::sin(angle) - where) / width;
        field_.back().push_back(size * height * (1 - off * off) * std::exp(-off * off / 2));
      }
    }
    parameters_ = {{"ridge", size, "Pa"}};
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    eachScan(taxel, [&](std::size_t scan, double preload) { load[scan] += preload; });
  }
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"repositioning", name, {"mount"}, make};
  form.needs_remounts = true;
  return form;
}

}  // namespace

std::vector<HiddenForm> repositioningForms() {
  return {form("shifted_map", makeHidden<ShiftedMap>), form("tilt", makeHidden<Tilt>),
          form("bubble", makeHidden<Bubble>), form("random_field", makeHidden<RandomField>),
          inSetB(form("wrinkle", makeHidden<Wrinkle>))};
}

}  // namespace blind
