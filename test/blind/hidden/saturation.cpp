// High readings are too low because the read-out saturates. A static curve for each surface absorbs the
// effect; what reveals it is that all surfaces bend at the same code.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class Saturation : public Hidden {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    const double knee = kneeOf(taxel);
    for (double& value : reading) {
      if (value > knee) value -= strength_ * lost(value - knee);
    }
  }

 protected:
  explicit Saturation(const HiddenSetup& setup)
      : random_(setup.seed, "saturation"),
        knee_(random_.uniform(0.45, 0.55)),
        strength_(std::min(1.0, setup.strength)) {
    parameters_ = {{"knee", knee_, "share of full scale"}, {"strength", strength_, "1"}};
  }
  virtual double kneeOf(std::size_t) const { return knee_; }
  virtual double lost(double over) const = 0;  // loss of a reading that is `over` above the knee

  Random random_;
  double knee_, strength_;
};

// The supply of the amplifier drops with its load.
class RailSag : public Saturation {
 public:
  explicit RailSag(const HiddenSetup& setup) : Saturation(setup) {}

 private:
  double lost(double over) const override { return over * over / (over + 0.3); }
};

// A soft limit that no reading exceeds.
class SoftRail : public Saturation {
 public:
  explicit SoftRail(const HiddenSetup& setup) : Saturation(setup), room_(random_.uniform(0.2, 0.3)) {
    parameters_.push_back({"room", room_, "share of full scale"});
  }

 private:
  double lost(double over) const override { return over - room_ * std::tanh(over / room_); }
  double room_;  // range above the knee [share of full scale]
};

// A hard limit, at a different level for each row's amplifier.
class RowClip : public Saturation {
 public:
  explicit RowClip(const HiddenSetup& setup) : Saturation(setup), layout_(setup.campaign.layout) {
    for (std::size_t row = 0; row < layout_.size.rows; ++row)
      row_knee_.push_back(knee_ + random_.uniform(0.08, 0.14));
  }

 private:
  double kneeOf(std::size_t taxel) const override { return row_knee_[layout_.row({taxel})]; }
  double lost(double over) const override { return 0.9 * over; }
  fsr::matrix::Layout layout_;
  std::vector<double> row_knee_;
};

// The smooth knee of a solid-state amplifier: x / (1 + x^(2 p))^(1 / (2 p)).
// Source: C. Rapp, Effects of HPA-nonlinearity on a 4-DPSK/OFDM-signal, 2nd European Conf. on Satellite
// Communications (1991) 179.
class Rapp : public Saturation {
 public:
  explicit Rapp(const HiddenSetup& setup)
      : Saturation(setup), room_(random_.uniform(0.2, 0.35)), smooth_(random_.uniform(0.7, 2)) {
    parameters_.push_back({"room", room_, "share of full scale"});
    parameters_.push_back({"smoothness", smooth_, "1"});
  }

 private:
  double lost(double over) const override {
    const double x = over / room_;
    return over - over / std::pow(1 + std::pow(x, 2 * smooth_), 1 / (2 * smooth_));
  }
  double room_, smooth_;
};

// A protection diode at the input: what is over the knee grows with its logarithm only.
// Source: W. Shockley, The theory of p-n junctions in semiconductors, Bell Syst. Tech. J. 28 (1949) 435.
class Diode : public Saturation {
 public:
  explicit Diode(const HiddenSetup& setup) : Saturation(setup), scale_(random_.uniform(0.08, 0.2)) {
    parameters_.push_back({"scale", scale_, "share of full scale"});
  }

 private:
  double lost(double over) const override { return over - scale_ * std::log1p(over / scale_); }
  double scale_;
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"saturation", name, {"code"}, make};
  form.left_after = LeftAfter::kCurveShared;
  return form;
}

}  // namespace

std::vector<HiddenForm> saturationForms() {
  return {form("rail_sag", makeHidden<RailSag>), form("soft_rail", makeHidden<SoftRail>),
          form("row_clip", makeHidden<RowClip>), form("rapp", makeHidden<Rapp>),
          inSetB(form("diode", makeHidden<Diode>))};
}

}  // namespace blind
