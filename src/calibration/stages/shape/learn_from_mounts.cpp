#include "calibration/stages/shape/learn_from_mounts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "calibration/stages/shape/learn_shape.h"
#include "calibration/stages/shape/read_shape.h"
#include "calibration/stages/shape/shape_check.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kLowShare = 0.05;  // of the highest pressure of training: where the sensitivity is measured
constexpr double kHighShare = 0.20;
constexpr double kLeastHistory = 1;  // keeps the file's value above 0 [Pa]
constexpr std::size_t kLeastTaxels = 4;
constexpr std::size_t kLeastSurfaces = 3;
constexpr std::size_t kLeastContrasts = 3;
constexpr double kSpreadOfOne = 1e-6;  // curvatures of one surface that differ less are one [1/m]

/// Learns the model from the mounts on surfaces of one curvature.
class ShapeTraining {
 public:
  ShapeTraining(const std::vector<MountedRest>& mounts, const Calibration& calibration)
      : mounts_(mounts), calibration_(calibration) {
    model_.missing.clear();
    model_.layout = calibration.layout;
    model_.full_scale = calibration.tables.full_scale;
  }

  /// `errors`: also those between surfaces, which take the longest.
  ShapeModel run(bool errors) {
    gatherSurfaces();
    if (groups_.size() < kLeastSurfaces) {
      model_.missing = "the bags hold a rest before the first load on " + std::to_string(groups_.size()) +
                       (groups_.size() == 1 ? " surface" : " surfaces") +
                       " of one curvature, but three are needed to learn how the sheet rests";
      return model_;
    }
    chooseTaxels();
    measureSensitivities();
    if (std::accumulate(model_.used.begin(), model_.used.end(), std::size_t{0}) < kLeastTaxels)
      model_.missing = "fewer than four taxels have a reading on every mount";
    else
      learn(errors);
    return model_;
  }

 private:
  std::size_t taxels() const { return calibration_.layout.size.taxels(); }

  double curvatureOf(std::size_t mount) const {
    return matrix::principalCurvature(mounts_[mount].surface.curvature.front());
  }

  void gatherSurfaces() {
    std::map<std::size_t, std::vector<std::size_t>> by_class;
    for (std::size_t m = 0; m < mounts_.size(); ++m) {
      if (bentAlike(mounts_[m].surface)) by_class[mounts_[m].curvature_class].push_back(m);
    }
    for (const auto& [number, members] : by_class) groups_.push_back(members);
    std::sort(groups_.begin(), groups_.end(),
              [&](const auto& a, const auto& b) { return curvatureOf(a.front()) < curvatureOf(b.front()); });
    for (const std::vector<std::size_t>& members : groups_) {
      model_.surfaces.push_back(mounts_[members.front()].surface.name);
      model_.curvature.push_back(curvatureOf(members.front()));
      model_.mounts.push_back(static_cast<std::uint32_t>(members.size()));
    }
    findDirection();
  }

  void findDirection() {
    if (groups_.empty()) return;
    bool first = true;
    for (const std::vector<std::size_t>& members : groups_) {
      const double k = curvatureOf(members.front());
      if (std::abs(k) <= dataset::kFlatCurvature) continue;
      const matrix::Curvature& bend = mounts_[members.front()].surface.curvature.front();
      const matrix::Curvature direction = {bend.x / k, bend.y / k, bend.xy / k};
      const auto differs = [](double a, double b) { return std::abs(a - b) > 0.02; };
      if (!first && (differs(direction.x, model_.direction.x) || differs(direction.y, model_.direction.y) ||
                     differs(direction.xy, model_.direction.xy)))
        model_.one_direction = false;
      model_.direction = direction;
      first = false;
    }
  }

  // Taxels with a model and a reading on every mount.
  void chooseTaxels() {
    model_.used.assign(taxels(), 1);
    for (std::size_t t = 0; t < taxels(); ++t) {
      if (calibration_.no_model[t] != 0) model_.used[t] = 0;
      for (const auto& members : groups_) {
        for (const std::size_t m : members) {
          if (std::isnan(mounts_[m].rest.reading[t])) model_.used[t] = 0;
        }
      }
    }
  }

  void learn(bool errors) {
    const std::vector<SurfaceRests> rests = surfaceRests();
    for (const SurfaceRests& surface : rests) model_.zero_share.push_back(surface.zero_share);
    std::vector<matrix::Position> places;
    for (std::size_t t = 0; t < taxels(); ++t) {
      if (model_.used[t] != 0) places.push_back(model_.layout.position({t}));
    }
    model_.scatter = learnScatter(rests, places);
    if (model_.scatter.contrasts < kLeastContrasts) {
      model_.missing =
          "the scatter between mounts is not known: " + std::to_string(model_.scatter.contrasts) +
          " further mounts of a surface can be used, but three are needed; mount surfaces again";
      for (std::size_t g = 0; g < rests.size(); ++g) {
        if (rests[g].zero_share > kMostZeros && rests[g].pressure.rows() > 1)
          model_.missing += "; not used: " + model_.surfaces[g] + ", where " +
                            settings::percentText(rests[g].zero_share) + " of the readings at rest are 0";
      }
      return;
    }
    learnHistory();
    model_.law = learnShapeLaw(model_);
    model_.error_between = errors ? errorsBetween() : std::vector<double>(groups_.size() - 1, kNotKnown);
  }

  const regression::CodeTable& tableOf(std::size_t taxel, std::size_t group) const {
    const auto& classes = calibration_.tables.classes;
    std::size_t nearest = 0;
    for (std::size_t c = 1; c < classes.size(); ++c) {
      if (std::abs(classes[c].at(taxel) - model_.curvature[group]) <
          std::abs(classes[nearest].at(taxel) - model_.curvature[group]))
        nearest = c;
    }
    return calibration_.tables.table(taxel, nearest);
  }

  // How much the reading grows for each pascal, share of full scale: straight between two pressures in the
  // lower part of the training, above those at which readings are cut and below those at which they saturate.
  double sensitivity(std::size_t taxel, std::size_t group) const {
    const regression::CodeTable& table = tableOf(taxel, group);
    const double highest = calibration_.trained.pressure.high;
    const auto codeAt = [&](double pressure) {
      std::size_t code = table.lowest;
      while (code < table.highest && !(double(table.pressure[code]) >= pressure)) ++code;
      return code;
    };
    const std::size_t low = codeAt(kLowShare * highest), high = codeAt(kHighShare * highest);
    const double rise = double(table.pressure[high]) - double(table.pressure[low]);
    return rise > 0 ? double(high - low) / model_.full_scale / rise : 0.0;
  }

  // Scales of the taxels, and how strongly a mount acts on each surface.
  void measureSensitivities() {
    model_.scale.assign(taxels(), 0.0);
    std::vector<double> ratios(groups_.size(), 0.0);
    double count = 0;
    for (std::size_t t = 0; t < taxels(); ++t) {
      if (model_.used[t] == 0) continue;
      std::vector<double> own;
      for (std::size_t g = 0; g < groups_.size(); ++g) own.push_back(sensitivity(t, g));
      const double mean = std::accumulate(own.begin(), own.end(), 0.0) / double(own.size());
      model_.used[t] = mean > 0 ? 1 : 0;
      if (model_.used[t] == 0) continue;
      model_.scale[t] = 1 / mean;
      for (std::size_t g = 0; g < groups_.size(); ++g) ratios[g] += own[g] / mean;
      count += 1;
    }
    for (const double ratio : ratios)
      model_.gain.push_back(count > 0 ? std::clamp(ratio / count, 0.1, 10.0) : 1.0);
  }

  std::vector<SurfaceRests> surfaceRests() {
    const auto count = std::accumulate(model_.used.begin(), model_.used.end(), std::size_t{0});
    std::vector<SurfaceRests> rests;
    model_.rest.assign(groups_.size() * taxels(), 0.0);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::vector<std::size_t>& members = groups_[g];
      SurfaceRests surface;
      surface.pressure.resize(Eigen::Index(members.size()), Eigen::Index(count));
      surface.gain = model_.gain[g];
      for (std::size_t m = 0; m < members.size(); ++m) {
        const RestReading& rest = mounts_[members[m]].rest;
        Eigen::Index column = 0;
        for (std::size_t t = 0; t < taxels(); ++t) {
          if (model_.used[t] == 0) continue;
          const double pressure = scaledPressure(model_, t, rest.reading[t]);
          surface.pressure(Eigen::Index(m), column++) = pressure;
          surface.zero_share += double(rest.zero[t]) / double(members.size() * count);
          model_.rest[g * taxels() + t] += pressure / double(members.size());
        }
      }
      rests.push_back(std::move(surface));
    }
    return rests;
  }

  // What the loads of each mount leave behind, of the taxels that take part [Pa].
  std::vector<std::vector<double>> changesByLoad() const {
    std::vector<std::vector<double>> changes;
    for (const std::vector<std::size_t>& members : groups_) {
      for (const std::size_t m : members) {
        if (mounts_[m].left_behind.empty()) continue;
        std::vector<double> change;
        for (std::size_t t = 0; t < taxels(); ++t) {
          const double counts = mounts_[m].left_behind[t];
          change.push_back(model_.used[t] == 0 || std::isnan(counts) ? 0.0
                                                                     : scaledPressure(model_, t, counts));
        }
        changes.push_back(std::move(change));
      }
    }
    return changes;
  }

  // The strength of what a load leaves behind, its pattern, and what the pattern does not explain.
  void learnHistory() {
    const double used = std::accumulate(model_.used.begin(), model_.used.end(), 0.0);
    model_.history.assign(taxels(), 1.0);
    model_.scatter.history = kLeastHistory;
    const std::vector<std::vector<double>> changes = changesByLoad();
    if (changes.empty()) return;
    std::vector<double> strengths;
    double squares = 0;
    for (const std::vector<double>& change : changes) {
      strengths.push_back(std::accumulate(change.begin(), change.end(), 0.0) / used);
      squares += strengths.back() * strengths.back();
    }
    if (!(squares > 0)) return;
    for (std::size_t t = 0; t < taxels(); ++t) {
      double product = 0;
      for (std::size_t c = 0; c < changes.size(); ++c) product += strengths[c] * changes[c][t];
      if (model_.used[t] != 0) model_.history[t] = product / squares;
    }
    double rest = 0;
    for (std::size_t c = 0; c < changes.size(); ++c) {
      for (std::size_t t = 0; t < taxels(); ++t) {
        if (model_.used[t] != 0) rest += std::pow(changes[c][t] - strengths[c] * model_.history[t], 2);
      }
    }
    model_.scatter.history = std::max(kLeastHistory, std::sqrt(squares / double(changes.size())));
    model_.scatter.white = std::hypot(model_.scatter.white, std::sqrt(rest / used / double(changes.size())));
  }

  // The root mean square of the errors on an inner surface that the model does not know; NaN = not known.
  double errorWithout(std::size_t group) const {
    const ShapeModel without = withoutSurface(model_, group);
    const ShapeReader reader(without);
    double squares = 0;
    try {
      for (const std::size_t m : groups_[group])
        squares += std::pow(reader.estimate(mounts_[m].rest).curvature - model_.curvature[group], 2);
    } catch (const settings::InputError&) {
      return kNotKnown;
    }
    return std::sqrt(squares / double(groups_[group].size()));
  }

  // The larger of the errors on the two surfaces at the ends of each gap.
  std::vector<double> errorsBetween() const {
    std::vector<double> on_surface(groups_.size(), kNotKnown), between;
    for (std::size_t g = 1; g + 1 < groups_.size(); ++g) on_surface[g] = errorWithout(g);
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g)
      between.push_back(std::fmax(on_surface[g], on_surface[g + 1]));
    return between;
  }

  const std::vector<MountedRest>& mounts_;
  const Calibration& calibration_;
  ShapeModel model_;
  std::vector<std::vector<std::size_t>> groups_;  // mounts of each surface, by ascending curvature
};

}  // namespace

bool bentAlike(const matrix::Surface& surface) {
  std::vector<double> curvatures;
  for (const matrix::Curvature& c : surface.curvature) curvatures.push_back(matrix::principalCurvature(c));
  const auto [low, high] = std::minmax_element(curvatures.begin(), curvatures.end());
  return surface.known() && *high - *low <= kSpreadOfOne;
}

ShapeModel learnShape(const std::vector<MountedRest>& mounts, const Calibration& calibration,
                      bool errors_between) {
  return ShapeTraining(mounts, calibration).run(errors_between);
}

namespace {

// Why mounts of the bags do not count: "; without a rest before the first load: b.bag, flat, mount 2".
std::string withoutRest(const std::vector<dataset::Recording>& recordings, const Sessions& sessions) {
  constexpr std::size_t kNamed = 4;
  const std::vector<std::string> names = mountsWithoutRest(recordings, sessions);
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, names.size()); ++i)
    text += (i == 0 ? "; without a rest before the first load: " : "; ") + names[i];
  return names.size() > kNamed ? text + "; and " + std::to_string(names.size() - kNamed) + " more" : text;
}

}  // namespace

void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions, unsigned threads,
                Calibration& calibration) {
  const std::vector<MountedRest> mounts = mountedRests(recordings, sessions);
  calibration.shape = learnShape(mounts, calibration);
  if (!calibration.shape.missing.empty()) calibration.shape.missing += withoutRest(recordings, sessions);
  for (const MisplacedMount& misplaced : findMisplacedMounts(mounts, calibration, threads)) {
    const MountedRest& mount = mounts[misplaced.mount];
    const double declared = matrix::principalCurvature(mount.surface.curvature.front());
    calibration.warnings.push_back(
        mount.name + ": " + restText(misplaced.estimate) + ", but its surface is " + bendText(declared) +
        ": a surface that is declared wrongly spoils the calibration; correct it, or leave "
        "the bag out");
  }
}

}  // namespace fsr::calibration
