#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "session/step_watch.h"
#include "statistics/samples.h"

namespace fsr::session {

/// What the taxels read without load, and how noisy it is. Memory does not grow with time.
class RestCounts {
 public:
  static constexpr unsigned kLeastScans = 20;

  void restart() { *this = {}; }
  /// A scan at rest.
  void take(const std::uint16_t* counts, std::size_t taxels);
  bool known() const { return !rest_.empty() && rest_.front().count >= kLeastScans; }
  /// How many taxels read more than noise does at rest. All of them while that is not known.
  std::size_t answering(const std::uint16_t* counts, std::size_t taxels) const;
  /// Sum over the taxels above their means at rest [counts]; NaN while that is not known.
  double excess(const std::uint16_t* counts, std::size_t taxels) const;
  /// Standard deviation of a single reading, median over the taxels [counts]. The board cuts off what is
  /// below 0, which hides up to 42 % of the deviation; it is given back. 0 while it is not known.
  double noise() const;

 private:
  std::vector<statistics::RunningMoments> rest_;  // of each taxel
  std::vector<double> last_, differences_;        // of each taxel: last scan, sum of squared differences
};

/// What the sheet says in one scan.
struct SheetAnswer {
  double time = 0;         ///< [s]
  double excess = 0;       ///< sum over the taxels above what they read at rest [counts]; NaN = not known
  bool answers = false;    ///< at least half of the taxels read more than at rest
  bool saturated = false;  ///< half of the taxels are at full scale: the sheet cannot follow
};

/// Tells a chamber that is vented at once from a transducer whose plug was pulled: in both the pressure jumps
/// within one reading, but only in the first does the sheet follow. Memory does not grow with time.
class JumpWatch {
 public:
  /// Whether the pressure more than doubled or halved between two readings, and by more than the accuracy of
  /// rest and load.
  static bool isJump(const Reading& before, const Reading& after);

  void scan(const SheetAnswer& now);
  void begin(const Reading& before, const Reading& after);
  bool open() const { return open_; }
  void drop() { open_ = false; }
  /// Whether the sheet followed the jump that is open; none while that cannot be told. `time` [s]: where no
  /// scan comes for long, the jump counts as followed. `answered`: pressure that the sheet answered before
  /// [Pa].
  std::optional<bool> followed(double time, std::optional<double> answered);
  /// Behind a jump that was not followed: whether sheet and pressure agree again.
  bool agrees(double pressure) const;

  const Reading& before() const { return before_; }
  const Reading& after() const { return after_; }

 private:
  bool follows(const SheetAnswer& first, const SheetAnswer& last, std::optional<double> answered) const;

  std::deque<SheetAnswer> recent_;
  bool open_ = false;
  Reading before_, after_;
  double loaded_ = 0;  // excess at the jump [counts]
};

/// Counts of every taxel at kLevels pressures of one loading, [levels x taxels]. Two loadings of one surface
/// by one program read the same but for noise, the sheet's memory, and how it lies on the surface.
using Signature = std::vector<double>;

/// Takes the signature of one loading from rest. The way from 10 % to 90 % of the peak is divided into equal
/// bins. In each, a straight line through the counts of a taxel gives its count in the middle of the bin, so
/// that pace and rate of the scans do not matter. Memory does not grow with time.
class LoadingSignature {
 public:
  static constexpr std::size_t kLevels = 4;

  /// Begins anew with another peak, gauge [Pa].
  void begin(double peak);
  /// A scan at a gauge pressure [Pa]. One at rest begins anew; those behind 90 % of the way do not count.
  void take(double pressure, const std::uint16_t* counts, std::size_t taxels);
  /// Empty where the loading was not seen in each bin.
  Signature result() const;

 private:
  struct Bin {
    double scans = 0, pressure = 0, square = 0;  // sums; pressure as a share of the peak
    std::vector<double> counts, moments;         // of each taxel: sums of counts, and of counts x pressure
  };
  void clear();

  double peak_ = 0;  // [Pa]
  bool over_ = false;
  std::array<Bin, kLevels> bins_;
};

/// The first loading that was recorded on a mount.
struct MountReading {
  unsigned mount = 0;       ///< its number
  std::string surface;      ///< on which the plan says that the sheet lies
  std::size_t columns = 0;  ///< of the matrix
  Signature signature;      ///< [levels x rows x columns]
};

/// Mounts that do not agree with their surfaces.
struct SurfaceDoubt {
  unsigned mount = 0;               ///< the one that does not read as it should
  std::optional<unsigned> swapped;  ///< the one with which it seems to be swapped
  std::string sentence;             ///< what it reads like, and what it does not
  std::vector<unsigned> against;    ///< the mounts with which it does not agree, and those that it reads like
  double chance = 1;  ///< of such a statement in a session where every surface is the right one, at most
};

/// Whether mounts read like the other mounts of their surface, or like those of another one.
///
/// A mount that is right differs from the others of its surface by the scatter between mounts. This scatter
/// is not known beforehand. It is estimated from the same readings: with the mount taken as one of another
/// surface (or turned round, swapped, or left out), the sum of squares within the surfaces, divided by its
/// degrees of freedom, is the scatter if that is the truth, and more if not. The squared distance of the
/// mount from the others of its own surface, divided by this scatter, has a distribution whose tail is at
/// most that of F with 1 and those degrees of freedom, however the scatters of taxels and pressures depend on
/// each other: of all sums of squares of normal values with one mean, that of a single value has the heaviest
/// tail (G. J. Székely, N. K. Bakirov, Extremal probabilities for Gaussian quadratic forms, Probability
/// Theory and Related Fields 126 (2003) 184-202).
///
/// Each statement that could have been made is allowed the same part of kFalse (Bonferroni). Nothing is said
/// while a surface has one mount only: then there is nothing that it must agree with.
class SurfaceWatch {
 public:
  /// Largest chance of any statement in a session in which every surface is the right one.
  static constexpr double kFalse = 0.01;

  /// `comparisons`: how many mounts of the session lie on a surface that came before.
  explicit SurfaceWatch(std::size_t comparisons) : comparisons_(comparisons) {}

  /// What does not agree where `now` comes to the mounts that are known; none if nothing can be told.
  std::optional<SurfaceDoubt> compare(const MountReading& now) const;
  /// Keeps a mount. One of the same number is replaced.
  void keep(const MountReading& mount);
  /// Forgets a mount, e.g. because its surface is in doubt.
  void forget(unsigned mount);

  const std::vector<MountReading>& mounts() const { return mounts_; }

 private:
  std::size_t comparisons_;
  std::vector<MountReading> mounts_;
};

}  // namespace fsr::session
