#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"
#include "regression/forest/forest.h"
#include "statistics/random_stream.h"

namespace fsr::regression {

/// Width of the search: arrays extend this many values beyond the end of the run.
constexpr std::size_t kCutLanes = 8;

/// Where to cut a run of entries in two. Values beyond `end` that the search loads must not be sizes between
/// those of `begin` and `end`.
struct CutProblem {
  // [end + kCutLanes] values each
  const double* size;   ///< readings as `minimum_leaf` counts them, of the entries before each
  const double* count;  ///< readings drawn, of the entries before each; may be `size` itself
  const double* sum;    ///< their pressure, of the entries before each
  const double* code;   ///< of each entry; equal codes stand together

  bool codes_repeat;  ///< whether neighbouring entries may have equal codes, which a cut must not separate
  std::size_t begin;  ///< entries begin .. end - 1, at least one
  std::size_t end;
  double minimum_leaf;  ///< size that each side must keep, at least 1
};

constexpr std::size_t kNoCut = 0;

/// The first entry of the right side of the cut that reduces the sum of squared errors most, the lowest of
/// equal ones; kNoCut if no cut reduces it or leaves enough on both sides. The reduction is
///
///     (S_left - n_left mean)^2 n / (n_left n_right);
///
/// fractions are compared by cross-multiplication, without division.
std::size_t bestCut(const CutProblem& problem);

/// Training readings in the order in which trees draw them. Readings that are equal in all inputs form one
/// entry, because no tree can separate them.
struct ForestData {
  /// Throws InputError if there are too many curvatures.
  ForestData(const CodeSamples& training, bool on_curvature);

  std::size_t entries() const { return code.size(); }

  /// Entries with the same number of readings: slots first_slot .. first_slot + entries - 1.
  struct SizeClass {
    std::size_t entries, readings_each;
  };

  double centre = 0;         ///< mean pressure [Pa]
  double unit = 0;           ///< unit of `pressure` [Pa], so small that sums of N are exact in doubles
  std::vector<double> code;  ///< of each entry, ascending; double for the vector unit
  std::vector<std::uint8_t> curvature;  ///< of each entry, index into `curvatures`
  std::vector<std::uint32_t> slot;      ///< of each entry: its rank by number of readings, then by position
  std::vector<double> curvatures;       ///< ascending [1/m]; one value where curvature is no input
  /// Sorted by size. For each class: the first reading of every entry, by slot, then the second reading of
  /// every entry, and so on, so that sums over them can be vectorised.
  std::vector<SizeClass> classes;
  std::vector<double> pressure;  ///< of each reading in that order, minus the centre [unit], integers
};

/// One leaf: codes first .. end - 1, curvatures low to below high [1/m].
struct ForestLeaf {
  std::int32_t first;
  std::int32_t end;
  double low;
  double high;
  double pressure;  ///< mean of its readings, minus the centre [unit]
  double readings;
};

/// Grows one tree after the other and reuses its memory.
class TreeGrower {
 public:
  TreeGrower(const ForestData& data, std::int32_t table_size, const ForestOptions& options);

  /// Tree number `tree` of the forest. The order of the leaves is not specified.
  const std::vector<ForestLeaf>& grow(std::uint64_t tree);

 private:
  // Entries [begin, end) of the arrays below, and the box of inputs that leads to them.
  struct Node {
    std::uint32_t begin, end;
    std::int32_t first_code, end_code;
    double low, high;
  };

  struct Entry {
    double code, count, sum, size;
    std::uint8_t curvature;
  };

  void draw(statistics::RandomStream stream);
  std::size_t pool();
  // Readings before each entry, as the minimum leaf counts them.
  std::vector<double>& sizeBefore() { return distinct_ ? distinct_before_ : count_before_; }
  // Adds a node, or a leaf if there is one input and the minimum leaf permits no cut.
  void addNode(std::size_t begin, std::size_t end, std::int32_t first_code, std::int32_t end_code, double low,
               double high);
  bool mayBeCut(const Node& node);
  // These add both sides to the nodes, or return false and change nothing.
  bool cut(const Node& node, std::uint64_t number);
  bool cutCode(const Node& node);
  bool cutCurvature(const Node& node);
  std::size_t partition(const Node& node, std::uint8_t first_right);
  void addLeaf(const Node& node);

  const ForestData& data_;
  std::int32_t table_size_;
  double minimum_leaf_;
  bool distinct_;
  InputSampling sampling_;
  std::uint64_t seed_;

  std::vector<std::uint8_t> times_drawn_;                      // of each reading
  std::vector<double> slot_count_, slot_sum_, slot_distinct_;  // of each slot: sums over the drawn readings
  // The entries that were drawn. Counts and sums [unit] are those before each entry.
  std::vector<double> code_, count_before_, sum_before_, distinct_before_;
  std::vector<std::uint8_t> curvature_;
  std::vector<Entry> moved_;
  std::vector<Node> nodes_;
  std::vector<ForestLeaf> leaves_;
  statistics::RandomStream input_stream_;
};

}  // namespace fsr::regression
