#include "statistics/signed_least_squares.h"

#include <algorithm>
#include <cmath>

namespace fsr::statistics {

namespace {

// Added to each diagonal element, relative to it. Keeps nearly equal columns solvable.
constexpr double kRidge = 1e-9;
constexpr int kMostRounds = 300;

using Members = std::vector<Eigen::Index>;

Eigen::VectorXd solveMembers(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right,
                             const Members& members) {
  const auto size = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd part(size, size);
  Eigen::VectorXd side(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    side[i] = right[members[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < size; ++j) {
      part(i, j) = gram(members[static_cast<std::size_t>(i)], members[static_cast<std::size_t>(j)]);
    }
    part(i, i) *= 1 + kRidge;
    part(i, i) += 1e-300;
  }
  return part.ldlt().solve(side);
}

// Moves `now` towards `goal` as far as all signs stay permitted. Members that reach 0 are removed.
void step(Eigen::VectorXd& now, const Eigen::VectorXd& goal, Members& members,
          const std::vector<bool>& free) {
  double share = 1;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Eigen::Index i = members[k];
    const double to = goal[static_cast<Eigen::Index>(k)];
    if (!free[static_cast<std::size_t>(i)] && to <= 0 && now[i] > to)
      share = std::min(share, now[i] / (now[i] - to));
  }
  Members stay;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Eigen::Index i = members[k];
    now[i] += share * (goal[static_cast<Eigen::Index>(k)] - now[i]);
    if (free[static_cast<std::size_t>(i)] || now[i] > 1e-12) {
      stay.push_back(i);
    } else {
      now[i] = 0;
    }
  }
  members = stay;
}

bool allowed(const Eigen::VectorXd& goal, const Members& members, const std::vector<bool>& free) {
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (!free[static_cast<std::size_t>(members[k])] && goal[static_cast<Eigen::Index>(k)] <= 0) return false;
  }
  return true;
}

}  // namespace

Eigen::VectorXd solveSigned(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right,
                            const std::vector<bool>& free) {
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(right.size());
  Members members;
  for (Eigen::Index i = 0; i < right.size(); ++i) {
    if (free[static_cast<std::size_t>(i)]) members.push_back(i);
  }
  for (int round = 0; round < kMostRounds; ++round) {
    Eigen::VectorXd goal = solveMembers(gram, right, members);
    while (!members.empty() && !allowed(goal, members, free)) {
      step(solution, goal, members, free);
      goal = solveMembers(gram, right, members);
    }
    for (std::size_t k = 0; k < members.size(); ++k)
      solution[members[k]] = goal[static_cast<Eigen::Index>(k)];
    // Find the column that would gain most by entering.
    const Eigen::VectorXd slope = right - gram * solution;
    Eigen::Index best = -1;
    double most = 1e-9;
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      const double norm = std::sqrt(gram(i, i));
      if (norm <= 0 || std::count(members.begin(), members.end(), i)) continue;
      const double gain = slope[i] / norm;
      if (gain > most * std::max(1e-12, right.cwiseAbs().maxCoeff() / norm)) {
        most = gain / std::max(1e-12, right.cwiseAbs().maxCoeff() / norm);
        best = i;
      }
    }
    if (best < 0) break;
    members.push_back(best);
  }
  return solution;
}

}  // namespace fsr::statistics
