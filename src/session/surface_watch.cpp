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
  for (Bin& bin : bins_) {
    bin.scans = bin.pressure = bin.square = 0;
    std::fill(bin.counts.begin(), bin.counts.end(), 0);
    std::fill(bin.moments.begin(), bin.moments.end(), 0);
  }
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
  std::size_t mount = 0;             // index
  std::optional<std::size_t> like;   // index of a mount of the surface that it reads like
  std::optional<std::size_t> with;   // index of the mount with which it was swapped
  const char* turned = nullptr;      // how the sheet is turned
  std::vector<MountReading> mounts;  // with surface and signature as the statement says
};

std::size_t mountsOn(const std::vector<MountReading>& mounts, const std::string& surface) {
  return static_cast<std::size_t>(std::count_if(
      mounts.begin(), mounts.end(), [&](const MountReading& one) { return one.surface == surface; }));
}

Within withinSurfaces(const std::vector<MountReading>& mounts) {
  Within within;
  std::set<std::string> surfaces;
  for (const MountReading& one : mounts) surfaces.insert(one.surface);
  for (const std::string& surface : surfaces) {
    const auto n = static_cast<double>(mountsOn(mounts, surface));
    within.freedom += n - 1;
    for (std::size_t i = 0; i < mounts.front().signature.size(); ++i) {
      double sum = 0, squares = 0;
      for (const MountReading& one : mounts) {
        if (one.surface == surface) sum += one.signature[i];
      }
      for (const MountReading& one : mounts) {
        if (one.surface == surface) squares += std::pow(one.signature[i] - sum / n, 2);
      }
      within.squares += squares / static_cast<double>(mounts.front().signature.size());
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

// Everything that could be said where the last mount is the new one. What is about the new mount comes first:
// a person can still look at it.
std::vector<Statement> statementsOn(const std::vector<MountReading>& mounts) {
  std::vector<Statement> all;
  const std::size_t last = mounts.size() - 1;
  const std::string surface = mounts[last].surface;
  const auto say = [&](std::size_t mount) -> Statement& {
    all.push_back({mount, std::nullopt, std::nullopt, nullptr, mounts});
    return all.back();
  };
  const auto turn = [&](bool rows, bool columns, const char* how) {
    Statement& one = say(last);
    one.turned = how;
    one.mounts[last].signature = turned(mounts[last], rows, columns);
  };
  for (std::size_t mount = mounts.size(); mount-- > 0;) {
    if (mounts[mount].surface != surface) continue;
    std::set<std::string> others = {surface};
    for (std::size_t like = 0; like < last; ++like) {
      if (mounts[like].surface == surface) continue;
      if (others.insert(mounts[like].surface).second) {
        Statement& one = say(mount);
        one.like = like;
        one.mounts[mount].surface = mounts[like].surface;
      }
      Statement& one = say(mount);
      one.with = like;
      std::swap(one.mounts[mount].surface, one.mounts[like].surface);
    }
    if (mount == last && mounts[last].columns > 0) {
      turn(true, false, "with its rows reversed");
      turn(false, true, "with its columns reversed");
      turn(true, true, "turned by half a turn");
    }
  }
  for (std::size_t mount = mounts.size(); mount-- > 0;) {
    if (mounts[mount].surface == surface) say(mount).mounts = without(mounts, mount);
  }
  return all;
}

// Whether it says what the mount reads like, and not only that it reads like nothing known.
bool isSpecific(const Statement& statement) {
  return statement.like || statement.with || statement.turned != nullptr;
}

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

std::string nameOf(const MountReading& mount) {
  return "mount " + std::to_string(mount.mount);
}

std::string sentenceOf(const Statement& statement, const std::vector<MountReading>& mounts) {
  const MountReading& mount = mounts[statement.mount];
  std::string others;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    if (i != statement.mount && mounts[i].surface == mount.surface)
      others += (others.empty() ? "" : ", ") + nameOf(mounts[i]);
  }
  if (statement.with) {
    const MountReading& with = mounts[*statement.with];
    return nameOf(mount) + " (" + mount.surface + ") and " + nameOf(with) + " (" + with.surface +
           ") read as if they were swapped";
  }
  const std::string sentence = nameOf(mount) + " reads ";
  if (statement.like) {
    const MountReading& like = mounts[*statement.like];
    return sentence + "like " + like.surface + " (" + nameOf(like) + "), not like " + mount.surface + " (" +
           others + ")";
  }
  if (statement.turned != nullptr)
    return sentence + "like " + mount.surface + " (" + others + ") with the sheet " + statement.turned;
  return sentence + "unlike " + mount.surface + " (" + others + ")";
}

std::vector<unsigned> against(const Statement& statement, const std::vector<MountReading>& mounts) {
  std::vector<unsigned> numbers;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    const bool own = mounts[i].surface == mounts[statement.mount].surface;
    const auto& other = statement.with ? statement.with : statement.like;
    const bool like = other && mounts[i].surface == mounts[*other].surface;
    if (i != statement.mount && (own || like)) numbers.push_back(mounts[i].mount);
  }
  return numbers;
}

}  // namespace

std::optional<SurfaceDoubt> SurfaceWatch::compare(const MountReading& now) const {
  std::vector<MountReading> mounts;
  for (const MountReading& one : mounts_) {
    if (one.mount != now.mount && one.signature.size() == now.signature.size()) mounts.push_back(one);
  }
  if (now.signature.empty() || mountsOn(mounts, now.surface) == 0) return std::nullopt;
  mounts.push_back(now);
  const std::vector<Statement> statements = statementsOn(mounts);
  const double could_be_said =
      static_cast<double>(statements.size() * std::max<std::size_t>(1, comparisons_));
  SurfaceDoubt doubt;
  for (const Statement& statement : statements) {
    if (!isSpecific(statement) && doubt.chance < kFalse) break;  // these come last
    const double chance = chanceOf(statement, mounts) * could_be_said;
    if (chance >= doubt.chance * (1 - kSame)) continue;
    doubt.mount = mounts[statement.mount].mount;
    doubt.sentence = sentenceOf(statement, mounts);
    doubt.swapped.reset();
    if (statement.with) doubt.swapped = mounts[*statement.with].mount;
    doubt.against = against(statement, mounts);
    doubt.chance = chance;
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
