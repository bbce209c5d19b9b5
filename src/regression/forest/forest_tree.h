#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_samples.h"
#include "regression/forest/forest.h"
#include "statistics/random_stream.h"

namespace fsr::regression {

/// Training readings as trees draw them. Readings that agree in all inputs form one entry: no tree can
/// part them.
struct ForestData {
  /// Throws InputError where there are too many curvatures.
  ForestData(const CodeSamples& training, bool on_curvature);

  std::size_t entries() const { return code.size(); }

  /// Entries with the same number of readings: slots first_slot .. first_slot + entries - 1.
  struct SizeClass {
    std::size_t entries, readings_each;
  };

  double centre = 0;                    ///< mean pressure [Pa]
  double unit = 0;                      ///< of `pressure` [Pa]: so small that sums of N are exact in doubles
  std::vector<double> code;             ///< of each entry, ascending; double for the vector unit
  std::vector<std::uint8_t> curvature;  ///< of each entry, index into `curvatures`
  std::vector<std::uint32_t> slot;      ///< of each entry: its place by number of readings, then as here
  std::vector<double> curvatures;       ///< ascending [1/m]; one value where curvature is no input
  /// By size. Of each class come the first reading of every entry, by slot, then the second of every
  /// entry ...: sums over them run along the vector unit.
  std::vector<SizeClass> classes;
  std::vector<double> pressure;  ///< of each reading in that order, less the centre [unit], integers
};

/// One leaf: codes first .. end - 1, curvatures low to below high [1/m].
struct ForestLeaf {
  std::int32_t first;
  std::int32_t end;
  double low;
  double high;
  double pressure;  ///< mean of its readings, less the centre [unit]
  double readings;
};

/// Grows trees one after the other, keeping its memory.
class TreeGrower {
 public:
  TreeGrower(const ForestData& data, std::int32_t table_size, const ForestOptions& options);

  /// Tree number `tree` of the forest. Leaves come in no order.
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
  // To the nodes; of one input to the leaves where the minimum leaf lets nothing be cut.
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
  std::vector<double> slot_count_, slot_sum_, slot_distinct_;  // of each slot, what was drawn of it
  // The entries that were drawn; of counts and sums [unit] those before each entry.
  std::vector<double> code_, count_before_, sum_before_, distinct_before_;
  std::vector<std::uint8_t> curvature_;
  std::vector<Entry> moved_;
  std::vector<Node> nodes_;
  std::vector<ForestLeaf> leaves_;
  statistics::RandomStream input_stream_;
};

}  // namespace fsr::regression
