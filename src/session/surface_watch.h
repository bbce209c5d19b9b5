#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fsr::session {

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
