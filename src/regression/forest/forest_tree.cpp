#include "regression/forest/forest_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// Integers up to this are exact in a double.
constexpr double kExactInteger = 9007199254740992.0;  // 2^53

struct Reading {
  FixedPressure pressure;
  std::uint16_t code;
  std::uint8_t curvature;
};

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() > kMostForestCurvatures) {
    throw settings::InputError("a forest on curvature is to train on " + std::to_string(values.size()) +
                               " different curvatures, but can on " + std::to_string(kMostForestCurvatures) +
                               " at most; pool them to classes");
  }
  return values;
}

// Sorts by code with one counting pass, then the few readings of each code by comparison.
std::vector<Reading> sorted(const CodeSamples& training, const std::vector<double>& curvatures) {
  std::vector<std::size_t> place(training.full_scale + 2u, 0);
  for (const std::uint16_t code : training.code) ++place[code + 1u];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Reading> readings(training.size());
  for (std::size_t i = 0; i < training.size(); ++i) {
    const auto found = curvatures.size() == 1
                           ? curvatures.begin()
                           : std::lower_bound(curvatures.begin(), curvatures.end(), training.curvature[i]);
    readings[place[training.code[i]]++] = {training.pressure[i], training.code[i],
                                           static_cast<std::uint8_t>(found - curvatures.begin())};
  }
  const auto before = [](const Reading& a, const Reading& b) {
    return std::tie(a.curvature, a.pressure) < std::tie(b.curvature, b.pressure);
  };
  std::size_t begin = 0;
  for (std::size_t code = 0; code + 1 < place.size(); begin = place[code++]) {
    std::sort(readings.begin() + static_cast<std::ptrdiff_t>(begin),
              readings.begin() + static_cast<std::ptrdiff_t>(place[code]), before);
  }
  return readings;
}

FixedPressure meanOf(const std::vector<FixedPressure>& pressure) {
  Int128 sum = 0;
  for (const FixedPressure p : pressure) sum += p;
  return static_cast<FixedPressure>(sum / static_cast<std::int64_t>(pressure.size()));
}

// Number of lowest bits to drop so that a sum of all readings is exact in a double: 0 for 10,000 readings of
// 600 kPa.
int bitsTooMany(const std::vector<FixedPressure>& pressure, FixedPressure centre) {
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  double largest = static_cast<double>(std::max(centre - *low, *high - centre));
  largest *= static_cast<double>(pressure.size());
  int bits = 0;
  for (; largest >= kExactInteger; largest /= 2) ++bits;
  return bits;
}

// Entries by number of readings.
std::vector<std::uint32_t> bySize(const std::vector<std::size_t>& begin) {
  std::vector<std::uint32_t> order(begin.size() - 1);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return begin[a + 1] - begin[a] < begin[b + 1] - begin[b];
  });
  return order;
}

}  // namespace

ForestData::ForestData(const CodeSamples& training, bool on_curvature) {
  validate(training);
  if (on_curvature && training.curvature.empty()) {
    throw settings::InputError(
        "a forest on curvature needs the curvature of each training reading, but has none");
  }
  curvatures = on_curvature ? distinct(training.curvature) : std::vector<double>{0.0};
  const FixedPressure mean = meanOf(training.pressure);
  const int dropped = bitsTooMany(training.pressure, mean);
  centre = fromFixed(mean);
  unit = std::ldexp(kFixedPressureUnit, dropped);

  const std::vector<Reading> readings = sorted(training, curvatures);
  std::vector<std::size_t> begin;  // of each entry, in `readings`
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Reading& reading = readings[i];
    if (i > 0 && code.back() == reading.code && curvature.back() == reading.curvature) continue;
    begin.push_back(i);
    code.push_back(reading.code);
    curvature.push_back(reading.curvature);
  }
  begin.push_back(readings.size());

  const std::vector<std::uint32_t> order = bySize(begin);
  const auto size = [&](std::size_t s) { return begin[order[s] + 1] - begin[order[s]]; };
  slot.resize(entries());
  pressure.reserve(readings.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    for (; last < order.size() && size(last) == size(first); ++last) {
      slot[order[last]] = static_cast<std::uint32_t>(last);
    }
    classes.push_back({last - first, size(first)});
    for (std::size_t reading = 0; reading < size(first); ++reading) {
      for (std::size_t s = first; s < last; ++s) {
        const FixedPressure excess = readings[begin[order[s]] + reading].pressure - mean;
        pressure.push_back(static_cast<double>(excess >> dropped));
      }
    }
  }
}

namespace {

constexpr std::size_t kLanes = 8;

// Sums over the drawn readings of `number` entries (lanes of the vector unit). The readings of an entry are
// `stride` apart.
template <std::size_t number>
inline __attribute__((always_inline)) void sumLanes(const std::uint8_t* times, const double* pressure,
                                                    std::size_t stride, std::size_t readings, double* count,
                                                    double* sum) {
  double counts[number] = {}, sums[number] = {};
  for (std::size_t reading = 0; reading < readings; ++reading, times += stride, pressure += stride) {
    for (std::size_t i = 0; i < number; ++i) {
      const double drawn = times[i];
      counts[i] += drawn;
      sums[i] += drawn * pressure[i];
    }
  }
  std::copy(counts, counts + number, count);
  std::copy(sums, sums + number, sum);
}

// Sums over the drawn readings of each entry of a class.
FSR_EACH_VECTOR_WIDTH
void sumDrawn(const std::uint8_t* times, const double* pressure, std::size_t entries, std::size_t readings,
              double* count, double* sum) {
  std::size_t i = 0;
  for (; i + kLanes <= entries; i += kLanes) {
    sumLanes<kLanes>(times + i, pressure + i, entries, readings, count + i, sum + i);
  }
  for (; i < entries; ++i) sumLanes<1>(times + i, pressure + i, entries, readings, count + i, sum + i);
}

FSR_EACH_VECTOR_WIDTH
void addDistinct(const std::uint8_t* times, std::size_t entries, double* distinct) {
  for (std::size_t i = 0; i < entries; ++i) distinct[i] += times[i] != 0 ? 1.0 : 0.0;
}

}  // namespace

TreeGrower::TreeGrower(const ForestData& data, std::int32_t table_size, const ForestOptions& options)
    : data_(data),
      table_size_(table_size),
      minimum_leaf_(static_cast<double>(options.minimum_leaf)),
      distinct_(options.leaf_count == LeafCount::kDistinct),
      sampling_(options.sampling),
      seed_(options.seed),
      times_drawn_(data.pressure.size()),
      slot_count_(data.entries()),
      slot_sum_(data.entries()),
      slot_distinct_(distinct_ ? data.entries() : 0),
      code_(data.entries() + kCutLanes),
      count_before_(data.entries() + kCutLanes),
      sum_before_(data.entries() + kCutLanes),
      distinct_before_(distinct_ ? data.entries() + kCutLanes : 0),
      curvature_(data.entries() + 1) {
  nodes_.reserve(2 * data.entries());  // entries are never split, so references to nodes stay valid
}

// Draws N of N readings with replacement. A reading drawn 256 times would wrap around; this happens once in
// 10^500 trees.
void TreeGrower::draw(statistics::RandomStream stream) {
  std::fill(times_drawn_.begin(), times_drawn_.end(), std::uint8_t{0});
  const std::uint64_t readings = times_drawn_.size();
  const auto take = [&](std::uint64_t bits) { ++times_drawn_[bits * readings >> 32]; };
  for (std::uint64_t i = 0; i < readings / 2; ++i) {
    const std::uint64_t bits = stream.bits(i);
    take(bits & 0xffffffffu);
    take(bits >> 32);
  }
  if (readings % 2 != 0) take(stream.bits(readings / 2) >> 32);
}

// Sums of the entries that were drawn. Returns their number.
std::size_t TreeGrower::pool() {
  std::fill(slot_distinct_.begin(), slot_distinct_.end(), 0.0);
  std::size_t reading = 0, slot = 0;
  for (const ForestData::SizeClass& size_class : data_.classes) {
    sumDrawn(&times_drawn_[reading], &data_.pressure[reading], size_class.entries, size_class.readings_each,
             &slot_count_[slot], &slot_sum_[slot]);
    for (std::size_t i = 0; i < size_class.readings_each; ++i, reading += size_class.entries) {
      if (distinct_) addDistinct(&times_drawn_[reading], size_class.entries, &slot_distinct_[slot]);
    }
    slot += size_class.entries;
  }
  double count = 0, sum = 0, distinct = 0;
  std::size_t entries = 0;
  for (std::size_t entry = 0; entry < data_.entries(); ++entry) {
    // always written, kept only if a reading was drawn: avoids a branch that would be mispredicted
    code_[entries] = data_.code[entry];
    curvature_[entries] = data_.curvature[entry];
    count_before_[entries] = count;
    sum_before_[entries] = sum;
    if (distinct_) distinct_before_[entries] = distinct;
    const double drawn = slot_count_[data_.slot[entry]];
    count += drawn;
    sum += slot_sum_[data_.slot[entry]];
    if (distinct_) distinct += slot_distinct_[data_.slot[entry]];
    entries += drawn != 0;
  }
  count_before_[entries] = count;
  sum_before_[entries] = sum;
  // values beyond the last entry must not look like a further cut
  std::vector<double>& size = sizeBefore();
  std::fill_n(size.begin() + static_cast<std::ptrdiff_t>(entries), kCutLanes, distinct_ ? distinct : count);
  return entries;
}

const std::vector<ForestLeaf>& TreeGrower::grow(std::uint64_t tree) {
  draw(statistics::randomStream(seed_, "forest", tree));
  input_stream_ = statistics::randomStream(seed_, "forest_input", tree);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  leaves_.clear();
  nodes_.clear();
  addNode(0, pool(), 0, table_size_, -kInfinity, kInfinity);
  // Level by level: neighbouring nodes in the list do not depend on each other's cut.
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!cut(nodes_[i], i)) addLeaf(nodes_[i]);
  }
  return leaves_;
}

// Fields are written in place: building a node and copying it would stall on its own stores.
void TreeGrower::addNode(std::size_t begin, std::size_t end, std::int32_t first_code, std::int32_t end_code,
                         double low, double high) {
  Node& node = nodes_.emplace_back();
  node.begin = static_cast<std::uint32_t>(begin);
  node.end = static_cast<std::uint32_t>(end);
  node.first_code = first_code;
  node.end_code = end_code;
  node.low = low;
  node.high = high;
  if (data_.curvatures.size() > 1 || mayBeCut(node)) return;  // inputs are drawn by the number of the node
  addLeaf(node);
  nodes_.pop_back();
}

void TreeGrower::addLeaf(const Node& node) {
  ForestLeaf& leaf = leaves_.emplace_back();
  leaf.first = node.first_code;
  leaf.end = node.end_code;
  leaf.low = node.low;
  leaf.high = node.high;
  leaf.readings = count_before_[node.end] - count_before_[node.begin];
  leaf.pressure = (sum_before_[node.end] - sum_before_[node.begin]) / leaf.readings;
}

bool TreeGrower::mayBeCut(const Node& node) {
  return node.end - node.begin > 1 && sizeBefore()[node.end] - sizeBefore()[node.begin] >= 2 * minimum_leaf_;
}

bool TreeGrower::cut(const Node& node, std::uint64_t number) {
  if (data_.curvatures.size() == 1) return cutCode(node);
  if (!mayBeCut(node)) return false;
  const bool code_first = input_stream_.bits(number) >> 63 != 0;
  if (code_first ? cutCode(node) : cutCurvature(node)) return true;
  if (sampling_ == InputSampling::kLeaf) return false;
  return code_first ? cutCurvature(node) : cutCode(node);
}

bool TreeGrower::cutCode(const Node& node) {
  const std::size_t at = bestCut({sizeBefore().data(), count_before_.data(), sum_before_.data(), code_.data(),
                                  data_.curvatures.size() > 1, node.begin, node.end, minimum_leaf_});
  if (at == kNoCut) return false;
  // the first code not below the midpoint
  const auto code = (static_cast<std::int32_t>(code_[at - 1] + code_[at]) + 1) / 2;
  addNode(node.begin, at, node.first_code, code, node.low, node.high);
  addNode(at, node.end, code, node.end_code, node.low, node.high);
  return true;
}

// The same search over the sums of the curvatures of the node.
bool TreeGrower::cutCurvature(const Node& node) {
  std::array<double, kMostForestCurvatures> all_size{}, all_count{}, all_sum{};
  for (std::size_t i = node.begin; i < node.end; ++i) {
    all_size[curvature_[i]] += sizeBefore()[i + 1] - sizeBefore()[i];
    all_count[curvature_[i]] += count_before_[i + 1] - count_before_[i];
    all_sum[curvature_[i]] += sum_before_[i + 1] - sum_before_[i];
  }
  std::array<double, kMostForestCurvatures + kCutLanes> size{}, count{}, sum{}, value{};
  std::array<std::uint8_t, kMostForestCurvatures> index;
  std::size_t present = 0;
  for (std::size_t k = 0; k < data_.curvatures.size(); ++k) {
    if (all_count[k] == 0) continue;
    size[present + 1] = size[present] + all_size[k];
    count[present + 1] = count[present] + all_count[k];
    sum[present + 1] = sum[present] + all_sum[k];
    value[present] = data_.curvatures[k];
    index[present++] = static_cast<std::uint8_t>(k);
  }
  const std::size_t at =
      bestCut({size.data(), count.data(), sum.data(), value.data(), false, 0, present, minimum_leaf_});
  if (at == kNoCut) return false;
  const double midway = 0.5 * (value[at - 1] + value[at]);
  const double split =
      midway > value[at - 1] ? midway : value[at];  // there is no double between neighbouring doubles
  const std::size_t middle = partition(node, index[at]);
  addNode(node.begin, middle, node.first_code, node.end_code, node.low, split);
  addNode(middle, node.end, node.first_code, node.end_code, split, node.high);
  return true;
}

// Moves the entries of the node with curvatures below `first_right` to the front. Both sides keep their
// order. Returns where the right side begins.
std::size_t TreeGrower::partition(const Node& node, std::uint8_t first_right) {
  moved_.clear();
  for (std::size_t i = node.begin; i < node.end; ++i) {
    moved_.push_back({code_[i], count_before_[i + 1] - count_before_[i], sum_before_[i + 1] - sum_before_[i],
                      sizeBefore()[i + 1] - sizeBefore()[i], curvature_[i]});
  }
  const auto right = std::stable_partition(moved_.begin(), moved_.end(),
                                           [&](const Entry& entry) { return entry.curvature < first_right; });
  for (std::size_t i = node.begin; i < node.end; ++i) {
    const Entry& entry = moved_[i - node.begin];
    code_[i] = entry.code;
    curvature_[i] = entry.curvature;
    count_before_[i + 1] = count_before_[i] + entry.count;
    sum_before_[i + 1] = sum_before_[i] + entry.sum;
    if (distinct_) distinct_before_[i + 1] = distinct_before_[i] + entry.size;
  }
  return node.begin + static_cast<std::size_t>(right - moved_.begin());
}

}  // namespace fsr::regression
