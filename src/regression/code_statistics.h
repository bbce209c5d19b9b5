#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::regression {

/// Pressure in fixed point, an integer number of 2^-20 Pa. Sums of integers are exact and do not depend on
/// the order.
using FixedPressure = std::int64_t;
constexpr double kFixedPressureUnit = 1.0 / 1048576.0;  // [Pa]
/// Largest absolute pressure that statistics accept: sums of 2^20 such readings do not overflow [Pa].
constexpr double kLargestPressure = 8e6;

/// Throws InputError if `pressure` [Pa] is not finite or larger than kLargestPressure.
FixedPressure toFixed(double pressure);
inline double fromFixed(FixedPressure pressure) {
  return static_cast<double>(pressure) * kFixedPressureUnit;
}

__extension__ using Int128 = __int128;  // GCC and Clang, 64-bit targets

/// Sums over all training readings of one code.
struct CodeSums {
  std::uint16_t code = 0;
  std::uint32_t count = 0;
  std::int64_t sum = 0;       ///< of FixedPressure
  Int128 sum_of_squares = 0;  ///< of FixedPressure
};

/// Sufficient statistics of each code that occurs: all that a regressor of one reading needs (linear
/// regression, GRNN), and all that its held-out error needs. Sparse, sorted by code. Merging is exact integer
/// addition, so the result is the same bit for bit in any order and on any computer.
///
/// The sum of squares of a code that occurs once follows from its sum and is not stored: 14 bytes for each
/// code, and 16 more for a code that occurs again.
class CodeStatistics {
 public:
  bool empty() const { return code_.empty(); }
  std::size_t codes() const { return code_.size(); }
  std::uint64_t samples() const;

  /// Reserves memory for `codes` codes, of which `repeated` occur more than once.
  void reserve(std::size_t codes, std::size_t repeated);
  /// Appends a code. It must be larger than all codes before it.
  void append(const CodeSums& sums);
  /// Adds the sums of `other`. Throws InputError if a sum would overflow.
  void merge(const CodeStatistics& other);

  /// Calls visit(CodeSums) for each code, ascending.
  template <typename Visit>
  void forEach(Visit visit) const {
    std::size_t repeated = 0;
    for (std::size_t i = 0; i < code_.size(); ++i) {
      const Int128 square = Int128{sum_[i]} * sum_[i];
      visit(CodeSums{code_[i], count_[i], sum_[i], count_[i] == 1 ? square : square_[repeated++]});
    }
  }

  /// One value for each code, ascending, as in the calibration file.
  const std::vector<std::uint16_t>& code() const { return code_; }
  const std::vector<std::uint32_t>& count() const { return count_; }
  const std::vector<std::int64_t>& sum() const { return sum_; }
  /// One value for each code that occurs more than once.
  const std::vector<Int128>& square() const { return square_; }

 private:
  std::vector<std::uint16_t> code_;
  std::vector<std::uint32_t> count_;
  std::vector<std::int64_t> sum_;
  std::vector<Int128> square_;
};

bool operator==(const CodeStatistics& a, const CodeStatistics& b);

/// Collects readings in any order. The work is proportional to the number of readings, not to the range of
/// the converter.
class CodeAccumulator {
 public:
  explicit CodeAccumulator(std::uint16_t full_scale);

  /// Throws InputError where the code's sum would overflow or `code` is above full scale.
  void add(std::uint16_t code, FixedPressure pressure);
  /// Returns the statistics and starts again with none.
  CodeStatistics take();

 private:
  std::vector<CodeSums> sums_;           // of every code
  std::vector<std::uint64_t> occupied_;  // one bit for every code
  std::size_t repeated_ = 0;             // codes with more than one reading
};

/// Count and sum of every code, 0 to full scale. Models are trained on this.
class CodeHistogram {
 public:
  explicit CodeHistogram(std::uint16_t full_scale) : count_(full_scale + 1u), sum_(full_scale + 1u) {}

  /// One reading. Throws InputError where the code's sum would overflow or `code` is above full scale.
  void add(std::uint16_t code, FixedPressure pressure);
  void add(const CodeStatistics& statistics);
  void subtract(const CodeStatistics& statistics);
  /// Adds the sums of `other`, which has the same full scale.
  void add(const CodeHistogram& other);

  std::uint16_t fullScale() const { return static_cast<std::uint16_t>(count_.size() - 1); }
  std::uint64_t samples() const { return samples_; }
  const std::vector<std::int64_t>& count() const { return count_; }
  const std::vector<std::int64_t>& sum() const { return sum_; }  ///< of FixedPressure

 private:
  std::vector<std::int64_t> count_;
  std::vector<std::int64_t> sum_;
  std::uint64_t samples_ = 0;
};

/// Training readings of one taxel, one by one, for regressors that need more than sums: a forest draws
/// readings at random, and a monotone curve uses the readings at each pressure. The order of the readings has
/// no effect on any model.
struct CodeSamples {
  std::uint16_t full_scale = 0;
  std::vector<std::uint16_t> code;
  std::vector<FixedPressure> pressure;  ///< one for each code
  std::vector<double> curvature;        ///< one for each code [1/m]; empty = not used by the model

  std::size_t size() const { return code.size(); }
  void add(std::uint16_t reading, FixedPressure reference) {
    code.push_back(reading);
    pressure.push_back(reference);
  }
  /// Appends the readings of `other`. Both or neither must have curvature, and full scale must be the same.
  void append(const CodeSamples& other);
};

/// Throws InputError if the vectors differ in length or a code is above full scale.
void validate(const CodeSamples& samples);

/// Both throw InputError as validate() does, and if a sum would overflow.
CodeStatistics statisticsOf(const CodeSamples& samples);
CodeHistogram histogramOf(const CodeSamples& samples);

/// Training readings of one taxel by curvature class: all readings or a part of them (some sections, a random
/// draw). Classes may be empty.
struct ClassReadings {
  std::uint16_t full_scale = 0;
  /// [classes]: sums by code, sufficient for mergeable regressors (linear, GRNN).
  std::vector<CodeHistogram> sums;
  /// [classes]: the same readings one by one, for the other regressors (forest, monotone); empty where sums
  /// suffice.
  std::vector<CodeSamples> samples;

  std::size_t classes() const { return samples.empty() ? sums.size() : samples.size(); }
  std::uint64_t readings(std::size_t curvature_class) const {
    return samples.empty() ? sums[curvature_class].samples() : samples[curvature_class].size();
  }
};

}  // namespace fsr::regression
