#include "regression/forest/forest_tree.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// Half of the lanes: the width of AVX2. With AVX-512, longer vectors bring no gain here.
constexpr std::size_t kHalf = kCutLanes / 2;
using Lanes = double __attribute__((vector_size(kHalf * sizeof(double))));
using Indices = std::int64_t __attribute__((vector_size(kHalf * sizeof(std::int64_t))));
#define FSR_INLINE inline __attribute__((always_inline))  // into each clone of bestOfMany()

const Lanes kNone = {0, 0, 0, 0};
const Lanes kOne = {1, 1, 1, 1};

// Values that all cuts of one node share.
struct Node {
  explicit Node(const CutProblem& p)
      : size_before(p.size[p.begin]),
        size(p.size[p.end] - size_before),
        count_before(p.count[p.begin]),
        sum_before(p.sum[p.begin]),
        count(p.count[p.end] - count_before),
        mean((p.sum[p.end] - sum_before) / count) {}

  double size_before, size, count_before, sum_before, count, mean;
};

// The best cut so far in each lane, and its gain as a fraction.
struct Best {
  Lanes gain = kNone;
  Lanes weight = kOne;
  Indices at = {};
};

// Tries the cuts at i, i + 1, ... Beyond the end of the node the right side has zero readings or fewer, so
// the minimum leaf rules these cuts out too.
FSR_INLINE void offer(const CutProblem& p, const Node& node, std::size_t i, const Indices& here, Best& best) {
  Lanes size, left, sum;
  std::memcpy(&size, p.size + i, sizeof(size));
  std::memcpy(&left, p.count + i, sizeof(left));
  std::memcpy(&sum, p.sum + i, sizeof(sum));
  left -= node.count_before;
  const Lanes right = node.count - left;
  const Lanes excess = (sum - node.sum_before) - node.mean * left;
  Lanes gain = excess * excess, weight = left * right;
  size -= node.size_before;
  const Lanes other_size = node.size - size;
  gain = (size < other_size ? size : other_size) >= kNone + p.minimum_leaf ? gain : kNone;
  weight = weight > kNone ? weight : kOne;
  if (p.codes_repeat) {
    Lanes code, code_before;
    std::memcpy(&code, p.code + i, sizeof(code));
    std::memcpy(&code_before, p.code + i - 1, sizeof(code_before));
    gain = code != code_before ? gain : kNone;
  }
  const Indices exceeds = gain * best.weight > best.gain * weight;
  best.gain = exceeds ? gain : best.gain;
  best.weight = exceeds ? weight : best.weight;
  best.at = exceeds ? here : best.at;
}

// The better of two cuts in each lane; of equal ones the lower.
FSR_INLINE void merge(const Best& other, Best& best) {
  const Lanes theirs = other.gain * best.weight, ours = best.gain * other.weight;
  const Indices exceeds = (theirs > ours) | ((theirs == ours) & (other.at < best.at));
  best.gain = exceeds ? other.gain : best.gain;
  best.weight = exceeds ? other.weight : best.weight;
  best.at = exceeds ? other.at : best.at;
}

template <typename Values>
FSR_INLINE void swapHalves(Values& v) {
  v = Values{v[2], v[3], v[0], v[1]};
}

template <typename Values>
FSR_INLINE void swapNeighbours(Values& v) {
  v = Values{v[1], v[0], v[3], v[2]};
}

// Most nodes of a tree have so few entries that trying one cut after the other is faster.
constexpr std::size_t kFew = 5;

std::size_t bestOfFew(const CutProblem& p) {
  const Node node(p);
  double best_gain = 0, best_weight = 1;
  std::size_t best = kNoCut;
  for (std::size_t i = p.begin + 1; i < p.end; ++i) {
    const double size = p.size[i] - node.size_before;
    const double left = p.count[i] - node.count_before;
    const double excess = (p.sum[i] - node.sum_before) - node.mean * left;
    const double gain = excess * excess, weight = left * (node.count - left);
    // without a branch, which would often be mispredicted
    const bool better = (std::min(size, node.size - size) >= p.minimum_leaf) &
                        (gain * best_weight > best_gain * weight) &
                        (!p.codes_repeat | (p.code[i] != p.code[i - 1]));
    best_gain = better ? gain : best_gain;
    best_weight = better ? weight : best_weight;
    best = better ? i : best;
  }
  return best;
}

FSR_EACH_VECTOR_WIDTH
std::size_t bestOfMany(const CutProblem& p) {
  const Node node(p);
  Best best, other;
  Indices here = Indices{1, 2, 3, 4} + static_cast<std::int64_t>(p.begin);
  for (std::size_t i = p.begin + 1; i < p.end; i += kCutLanes) {
    offer(p, node, i, here, best);
    here += static_cast<std::int64_t>(kHalf);
    offer(p, node, i + kHalf, here, other);
    here += static_cast<std::int64_t>(kHalf);
  }
  merge(other, best);
  other = best;
  swapHalves(other.gain), swapHalves(other.weight), swapHalves(other.at);
  merge(other, best);
  other = best;
  swapNeighbours(other.gain), swapNeighbours(other.weight), swapNeighbours(other.at);
  merge(other, best);
  return best.gain[0] > 0 ? static_cast<std::size_t>(best.at[0]) : kNoCut;
}

}  // namespace

std::size_t bestCut(const CutProblem& p) {
  return p.end - p.begin <= kFew ? bestOfFew(p) : bestOfMany(p);
}

}  // namespace fsr::regression
