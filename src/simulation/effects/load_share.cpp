#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

// Near its border a sealed sheet carries part of the load itself, or its rim concentrates the load.
//
//     P_e = P_e (1 + e exp(-d / L))   [Pa]
//
// d: distance of the taxel's centre from the nearest edge of the matrix [m]. L: length over which the effect
// decays [m]. e: a few per cent, negative where the rim carries load, positive where it concentrates load.
// Form and size are assumptions without data.

namespace {

double distanceFromEdge(const matrix::Layout& layout, std::size_t taxel) {
  const matrix::Position place = layout.position({taxel});
  const double x = layout.size.columns * layout.pitch_x / 2 - std::abs(place.x);
  const double y = layout.size.rows * layout.pitch_y / 2 - std::abs(place.y);
  return std::min(x, y);
}

class EdgeStiffness : public Effect {
 public:
  EdgeStiffness(const EffectValues& values, const EffectContext& context) {
    for (std::size_t i = 0; i < context.layout.size.taxels(); ++i) {
      const double decay = std::exp(-distanceFromEdge(context.layout, i) / values.at("length"));
      factor_.push_back(1 + values.at("change") * decay);
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < factor_.size(); ++i) signals.load[i] *= factor_[i];
  }

 private:
  std::vector<double> factor_;  // [taxels]
};

}  // namespace

EffectEntry edgeStiffness() {
  EffectInfo info;
  info.id = "edge_stiffness";
  info.summary = "taxels near the edge feel more or less of the load";
  info.equation = "P_e *= 1 + e exp(-d / L)";
  info.source = "assumption, a few per cent";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("change", "e, at the very edge", {-0.9, 2, ""}, -0.05).within(-0.2, 0.2),
      shape("length", "L, how far it reaches inwards", {1e-4, 1, "m"}, 0.01).trying({0.005, 0.01, 0.02}),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTaxel, Covariate::kPressure};
  info.collinear = {"static_curve", "repositioning"};
  info.experiment = Experiment::kRemount;
  return {info, makeEffect<EdgeStiffness>};
}

// A sheet that is laid down again never lies exactly as before.
//
//     P_e = P_e + o f_m(x, y),   g = g (1 + c h_m(x, y)),   map shifted by (s N, s N)
//
// f_m, h_m: smooth random fields over the sheet with standard deviation 1 and correlation length l, drawn
// anew for each mount m. N: a standard normal number. The shift moves curvatures and loads that differ from
// taxel to taxel.
// Size: no figure is published for a matrix; Ahmadizadeh and Menon 2019 never remounted theirs. The values
// are estimates from the repeatability that data sheets give for a repeated actuation (Tangio TPE-500,
// Interlink FSR 400: 2 %).

namespace {

/// Values of a sheet's taxels at places between them, straight between neighbours, held at the edges.
std::vector<double> shifted(const std::vector<double>& values, matrix::MatrixSize size, double columns,
                            double rows) {
  std::vector<double> result(values.size());
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const double y = std::clamp(row + rows, 0.0, size.rows - 1.0);
      const double x = std::clamp(column + columns, 0.0, size.columns - 1.0);
      const auto top = static_cast<std::size_t>(y), left = static_cast<std::size_t>(x);
      const std::size_t bottom = std::min<std::size_t>(top + 1, size.rows - 1u);
      const std::size_t right = std::min<std::size_t>(left + 1, size.columns - 1u);
      const auto at = [&](std::size_t r, std::size_t c) { return values[r * size.columns + c]; };
      const double fx = x - static_cast<double>(left), fy = y - static_cast<double>(top);
      const double upper = at(top, left) + fx * (at(top, right) - at(top, left));
      const double lower = at(bottom, left) + fx * (at(bottom, right) - at(bottom, left));
      result[std::size_t(row) * size.columns + std::size_t(column)] = upper + fy * (lower - upper);
    }
  }
  return result;
}

class Repositioning : public Effect {
 public:
  Repositioning(const EffectValues& values, const EffectContext& context)
      : context_(context),
        offset_deviation_(values.at("offset")),
        gain_deviation_(values.at("gain")),
        shift_deviation_(values.at("shift")),
        length_(values.at("length")),
        offset_(context.layout.size.taxels(), 0.0),
        gain_(context.layout.size.taxels(), 1.0) {}

  void place(Mounting& mounting) override {
    if (shift_deviation_ == 0) return;
    const statistics::RandomStream stream =
        statistics::randomStream(context_.seed, "repositioning.shift", mounting.number);
    const matrix::Layout& layout = context_.layout;
    const double columns = shift_deviation_ * stream.normal(0) / layout.pitch_x;
    const double rows = shift_deviation_ * stream.normal(1) / layout.pitch_y;
    mounting.curvature = shifted(mounting.curvature, layout.size, columns, rows);
    mounting.share = shifted(mounting.share, layout.size, columns, rows);
  }

  void mount(const Mounting& mounting) override {
    const SmoothRandomField offset(length_, context_.seed, "repositioning.offset", mounting.number);
    const SmoothRandomField gain(length_, context_.seed, "repositioning.gain", mounting.number);
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      offset_[i] = offset_deviation_ * offset(context_.layout.position({i}));
      gain_[i] = std::max(0.0, 1 + gain_deviation_ * gain(context_.layout.position({i})));
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      signals.load[i] += offset_[i];
      signals.gain[i] *= gain_[i];
    }
  }

 private:
  EffectContext context_;
  double offset_deviation_;  // [Pa]
  double gain_deviation_;
  double shift_deviation_;      // [m]
  double length_;               // [m]
  std::vector<double> offset_;  // [taxels], Pa
  std::vector<double> gain_;    // [taxels]
};

}  // namespace

EffectEntry repositioning() {
  EffectInfo info;
  info.id = "repositioning";
  info.summary = "every mount lies a little differently";
  info.equation = "P_e += o f_m(x, y), g *= 1 + c h_m(x, y), map shifted by s N";
  info.source = "estimate";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kMount;
  info.kind = EffectKind::kDetector;
  info.parameters = {
      scatter("offset", "o, deviation of the load", {0, 100e3, "Pa"}, 3e3).within(500, 20e3),
      scatter("gain", "c, deviation of the gain", {0, 0.5, ""}, 0.02).within(0.003, 0.1),
      scatter("shift", "s, deviation of the place in each direction", {0, 0.1, "m"}, 0).within(0, 0.02),
      shape("length", "l, over which the fields change", {1e-3, 10, "m"}, 0.04).within(0.01, 0.2),
  };
  info.depends_on = {Covariate::kMount, Covariate::kRow, Covariate::kColumn, Covariate::kPressure};
  info.needs = {Evidence::kMountLabels};
  info.collinear = {"bending_gain", "bending_preload", "edge_stiffness", "session_offset", "temperature"};
  info.experiment = Experiment::kRemount;
  info.by_chance = true;
  info.detector = Detector::kMounts;
  return {info, makeEffect<Repositioning>};
}

}  // namespace fsr::simulation
