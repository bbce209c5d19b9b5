#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::regression {

/// Pressure as sums take it: an integer number of 2^-20 Pa, so that addition is exact and its order
/// does not matter.
using FixedPressure = std::int64_t;
constexpr double kFixedPressureUnit = 1.0 / 1048576.0;  // [Pa]
/// Largest pressure that statistics accept, either sign: sums of 2^20 such readings still fit [Pa].
constexpr double kLargestPressure = 8e6;

/// Throws InputError where `pressure` [Pa] is not finite or beyond kLargestPressure.
FixedPressure toFixed(double pressure);
inline double fromFixed(FixedPressure pressure) {
  return static_cast<double>(pressure) * kFixedPressureUnit;
}

__extension__ using Int128 = __int128;  // GCC and Clang, 64-bit targets

/// What is known of all training readings of one code.
struct CodeSums {
  std::uint16_t code = 0;
  std::uint32_t count = 0;
  std::int64_t sum = 0;       ///< of FixedPressure
  Int128 sum_of_squares = 0;  ///< of FixedPressure
};

/// The sufficient statistics of each code that occurs: all that a regressor of one reading needs
/// (linear regression, GRNN) and all that its held-out error needs. Sparse, sorted by code. Merging
/// is exact integer addition: any order, any machine, the same bits.
///
/// Of a code that occurs once the sum of squares follows from the sum, so only the others keep one:
/// 14 bytes for each code and 16 more where it repeats.
class CodeStatistics {
 public:
  bool empty() const { return code_.empty(); }
  std::size_t codes() const { return code_.size(); }
  std::uint64_t samples() const;

  /// Makes room for so many codes, `repeated` of which occur more than once.
  void reserve(std::size_t codes, std::size_t repeated);
  /// Appends a code larger than all before it.
  void append(const CodeSums& sums);
  /// Adds another's sums. Throws InputError where a sum would overflow.
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

  /// One value for each code, ascending: as files keep them.
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

/// Collects readings in any order; the work of a cell is proportional to its readings, not to the
/// converter's range.
class CodeAccumulator {
 public:
  explicit CodeAccumulator(std::uint16_t full_scale);

  /// Throws InputError where the code's sum would overflow or `code` is above full scale.
  void add(std::uint16_t code, FixedPressure pressure);
  /// Hands the statistics out and starts afresh.
  CodeStatistics take();

 private:
  std::vector<CodeSums> sums_;           // of every code
  std::vector<std::uint64_t> occupied_;  // one bit for every code
  std::size_t repeated_ = 0;             // codes with more than one reading
};

/// Counts and sums of every code, 0 .. full scale: what models train on.
class CodeHistogram {
 public:
  explicit CodeHistogram(std::uint16_t full_scale) : count_(full_scale + 1u), sum_(full_scale + 1u) {}

  /// One reading. Throws InputError where the code's sum would overflow or `code` is above full scale.
  void add(std::uint16_t code, FixedPressure pressure);
  void add(const CodeStatistics& statistics);
  void subtract(const CodeStatistics& statistics);
  /// Another's sums, of the same full scale.
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

}  // namespace fsr::regression
