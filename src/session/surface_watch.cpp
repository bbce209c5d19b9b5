#include "session/sheet_watch.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <set>

#include "session/step_watch.h"

namespace fsr::session {

namespace {

constexpr double kFirst = 0.1, kLast = 0.9;  // shares of the peak
constexpr double kLevelWidth = (kLast - kFirst) / LoadingSignature::kLevels;

}  // namespace

void LoadingSignature::begin(double peak) {
  peak_ = peak;
  clear();
}

void LoadingSignature::clear() {
  over_ = false;
  bins_ = {};
}

void LoadingSignature::take(double pressure, const std::uint16_t* counts, std::size_t taxels) {
  if (!(peak_ > 0)) return;
  if (pressure <= kRestLevel) return clear();
  const double share = pressure / peak_;
  over_ = over_ || share >= kLast;
  if (over_ || share < kFirst) return;
  Bin& bin = bins_[std::min(kLevels - 1, static_cast<std::size_t>((share - kFirst) / kLevelWidth))];
  if (bin.counts.size() != taxels) {
    bin = {};
    bin.counts.assign(taxels, 0);
    bin.moments.assign(taxels, 0);
  }
  bin.scans += 1;
  bin.pressure += share;
  bin.square += share * share;
  for (std::size_t t = 0; t < taxels; ++t) {
    bin.counts[t] += counts[t];
    bin.moments[t] += counts[t] * share;
  }
}

Signature LoadingSignature::result() const {
  Signature result;
  for (std::size_t b = 0; b < kLevels; ++b) {
    const Bin& bin = bins_[b];
    if (!over_ || bin.scans < 1 || bin.counts.size() != bins_[0].counts.size()) return {};
    const double mean = bin.pressure / bin.scans;
    const double spread = bin.square - bin.pressure * mean;
    const double middle = kFirst + (static_cast<double>(b) + 0.5) * kLevelWidth;
    for (std::size_t t = 0; t < bin.counts.size(); ++t) {
      const double slope = spread > 0 ? (bin.moments[t] - mean * bin.counts[t]) / spread : 0;
      result.push_back(bin.counts[t] / bin.scans + slope * (middle - mean));
    }
  }
  return result;
}

namespace {

constexpr double kRounding = 1.0 / 12;  // variance of whole counts: no scatter is less [counts^2]
constexpr double kSame =
    1e-6;  // two statements with chances that differ by less say the same of the readings

/// Which part of each mount is explained by its surface.
struct Within {
  double squares = 0;  // mean over the signature [counts^2]
  double freedom = 0;  // degrees of it
};

/// A statement that could be made: a mount is one of another surface, or was swapped with another one, or the
/// sheet is turned, or lies on no known surface.
struct Statement {
  SurfaceDoubt doubt;
  std::size_t mount = 0;             // index
  bool specific = true;              // it says what the mount reads like
  std::vector<MountReading> mounts;  // with surface and signature as the statement says
};

Within withinSurfaces(const std::vector<MountReading>& mounts) {
  Within within;
  std::set<std::string> surfaces;
  for (const MountReading& one : mounts) surfaces.insert(one.surface);
  within.freedom = static_cast<double>(mounts.size() - surfaces.size());
  for (const std::string& surface : surfaces) {
    for (std::size_t i = 0; i < mounts.front().signature.size(); ++i) {
      std::vector<double> values;
      for (const MountReading& one : mounts) {
        if (one.surface == surface) values.push_back(one.signature[i]);
      }
      within.squares +=
          statistics::squaredDeviations(values) / static_cast<double>(mounts.front().signature.size());
    }
  }
  return within;
}

std::vector<MountReading> without(std::vector<MountReading> mounts, std::size_t index) {
  mounts.erase(mounts.begin() + static_cast<std::ptrdiff_t>(index));
  return mounts;
}

// The signature of a sheet whose taxels are counted from the other end.
Signature turned(const MountReading& mount, bool rows, bool columns) {
  const std::size_t taxels = mount.signature.size() / LoadingSignature::kLevels;
  const std::size_t width = mount.columns, height = taxels / width;
  Signature result(mount.signature.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t level = i / taxels, row = i % taxels / width, column = i % width;
    result[i] = mount.signature[level * taxels + (rows ? height - 1 - row : row) * width +
                                (columns ? width - 1 - column : column)];
  }
  return result;
}

std::string nameOf(const MountReading& mount) {
  return "mount " + std::to_string(mount.mount);
}

// Everything that could be said where the last mount is the new one. What is about the new mount comes first:
// a person can still look at it.
class Statements {
 public:
  explicit Statements(const std::vector<MountReading>& mounts) : mounts_(mounts) {
    const std::size_t last = mounts.size() - 1;
    const MountReading& now = mounts[last];
    for (std::size_t mount = mounts.size(); mount-- > 0;) {
      if (mounts[mount].surface != now.surface) continue;
      std::set<std::string> others = {now.surface};
      for (std::size_t other = 0; other < last; ++other) {
        if (mounts[other].surface == now.surface) continue;
        if (others.insert(mounts[other].surface).second) sayLike(mount, mounts[other]);
        saySwapped(mount, other);
      }
      if (mount != last || now.columns == 0) continue;
      sayTurned(last, true, false, "with its rows reversed");
      sayTurned(last, false, true, "with its columns reversed");
      sayTurned(last, true, true, "turned by half a turn");
    }
    for (std::size_t mount = mounts.size(); mount-- > 0;) {
      if (mounts[mount].surface == now.surface) sayUnlike(mount);
    }
  }

  std::vector<Statement> all;

 private:
  // `other`: a surface beside its own with which the mount is compared.
  Statement& say(std::size_t mount, const std::string& sentence, const std::string& other = "") {
    Statement statement{{mounts_[mount].mount, std::nullopt, sentence, {}, 1}, mount, true, mounts_};
    for (std::size_t i = 0; i < mounts_.size(); ++i) {
      const bool compared = mounts_[i].surface == mounts_[mount].surface || mounts_[i].surface == other;
      if (i != mount && compared) statement.doubt.against.push_back(mounts_[i].mount);
    }
    all.push_back(std::move(statement));
    return all.back();
  }
  // "flat (mount 1, mount 3)": the surface of a mount with its other mounts.
  std::string own(std::size_t mount) const {
    std::string others;
    for (std::size_t i = 0; i < mounts_.size(); ++i) {
      if (i != mount && mounts_[i].surface == mounts_[mount].surface)
        others += (others.empty() ? "" : ", ") + nameOf(mounts_[i]);
    }
    return mounts_[mount].surface + " (" + others + ")";
  }
  std::string reads(std::size_t mount) const { return nameOf(mounts_[mount]) + " reads "; }

  void sayLike(std::size_t mount, const MountReading& like) {
    say(mount, reads(mount) + "like " + like.surface + " (" + nameOf(like) + "), not like " + own(mount),
        like.surface)
        .mounts[mount]
        .surface = like.surface;
  }
  void saySwapped(std::size_t mount, std::size_t with) {
    const auto both = [this](std::size_t i) { return nameOf(mounts_[i]) + " (" + mounts_[i].surface + ")"; };
    Statement& one = say(mount, both(mount) + " and " + both(with) + " read as if they were swapped",
                         mounts_[with].surface);
    one.doubt.swapped = mounts_[with].mount;
    std::swap(one.mounts[mount].surface, one.mounts[with].surface);
  }
  void sayTurned(std::size_t mount, bool rows, bool columns, const std::string& how) {
    say(mount, reads(mount) + "like " + own(mount) + " with the sheet " + how).mounts[mount].signature =
        turned(mounts_[mount], rows, columns);
  }
  void sayUnlike(std::size_t mount) {
    Statement& one = say(mount, reads(mount) + "unlike " + own(mount));
    one.specific = false;
    one.mounts = without(mounts_, mount);
  }

  const std::vector<MountReading>& mounts_;
};

// The chance of so large a distance from the own surface, if the mount is right.
double chanceOf(const Statement& statement, const std::vector<MountReading>& mounts) {
  const double distance =
      withinSurfaces(mounts).squares - withinSurfaces(without(mounts, statement.mount)).squares;
  const Within scatter = withinSurfaces(statement.mounts);
  if (!(scatter.freedom > 0) || !(distance > 0)) return 1;
  const double variance = std::max(scatter.squares / scatter.freedom, kRounding);
  const boost::math::students_t t(scatter.freedom);
  return 2 * cdf(complement(t, std::sqrt(distance / variance)));
}

}  // namespace

std::optional<SurfaceDoubt> SurfaceWatch::compare(const MountReading& now) const {
  std::vector<MountReading> mounts;
  for (const MountReading& one : mounts_) {
    if (one.mount != now.mount && one.signature.size() == now.signature.size()) mounts.push_back(one);
  }
  const auto agrees = [&](const MountReading& one) { return one.surface == now.surface; };
  if (now.signature.empty() || std::none_of(mounts.begin(), mounts.end(), agrees)) return std::nullopt;
  mounts.push_back(now);
  std::vector<Statement> statements = Statements(mounts).all;
  const double could_be_said =
      static_cast<double>(statements.size() * std::max<std::size_t>(1, comparisons_));
  SurfaceDoubt doubt;
  for (Statement& statement : statements) {
    if (!statement.specific && doubt.chance < kFalse) break;  // these come last
    statement.doubt.chance = chanceOf(statement, mounts) * could_be_said;
    if (statement.doubt.chance < doubt.chance * (1 - kSame)) doubt = statement.doubt;
  }
  if (doubt.chance >= kFalse) return std::nullopt;
  return doubt;
}

void SurfaceWatch::keep(const MountReading& mount) {
  forget(mount.mount);
  mounts_.push_back(mount);
}

void SurfaceWatch::forget(unsigned mount) {
  const auto same = [mount](const MountReading& one) { return one.mount == mount; };
  mounts_.erase(std::remove_if(mounts_.begin(), mounts_.end(), same), mounts_.end());
}

}  // namespace fsr::session
