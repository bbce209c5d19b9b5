#include "fsr_pressure_map/dataset/condition_classes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::dataset {

namespace {

// A condition that is to be put into a class.
struct Member {
  CurvatureClass condition;
  std::uint64_t scans = 0;
  std::size_t index = 0;  // among all conditions
};

// One value where all taxels agree.
std::vector<double> principalCurvatures(const matrix::Surface& surface) {
  std::vector<double> curvature;
  for (const matrix::Curvature& tensor : surface.curvature)
    curvature.push_back(matrix::principalCurvature(tensor));
  const auto differs = [&](double value) { return value != curvature.front(); };
  if (std::none_of(curvature.begin(), curvature.end(), differs)) curvature.resize(1);
  return curvature;
}

// Sorts by curvature, and conditions of the same curvature by descending number of scans. The key does not
// depend on the order of the recordings.
bool precedes(const Member& a, const Member& b) {
  return std::tie(a.condition.curvature, b.scans, a.condition.surface) <
         std::tie(b.condition.curvature, a.scans, b.condition.surface);
}

bool agree(const CurvatureClass& a, const CurvatureClass& b, PooledBy by) {
  if (by == PooledBy::kName) return a.surface == b.surface;
  const std::size_t values = std::max(a.curvature.size(), b.curvature.size());
  for (std::size_t taxel = 0; taxel < values; ++taxel) {
    if (std::abs(a.at(taxel) - b.at(taxel)) > kSameClassCurvature) return false;
  }
  return true;
}

// The first of each group has the lowest curvature; every member must agree with it.
std::vector<std::vector<Member>> group(const std::vector<Member>& members, PooledBy by) {
  std::vector<std::vector<Member>> groups;
  for (const Member& member : members) {
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const std::vector<Member>& candidates) {
      return agree(candidates.front().condition, member.condition, by);
    });
    if (found != groups.end()) {
      found->push_back(member);
    } else {
      groups.push_back({member});
    }
  }
  return groups;
}

}  // namespace

bool isFlat(const CurvatureClass& curvature_class) {
  const auto flat = [](double curvature) { return std::abs(curvature) <= kFlatCurvature; };
  return std::all_of(curvature_class.curvature.begin(), curvature_class.curvature.end(), flat);
}

PooledConditions poolConditions(const std::vector<RecordedCondition>& conditions, PooledBy by) {
  std::vector<Member> members;
  for (const RecordedCondition& recorded : conditions) {
    members.push_back({recorded.condition, recorded.scans, members.size()});
  }
  std::stable_sort(members.begin(), members.end(), precedes);
  auto groups = group(members, by);
  const auto most_scans = [](const Member& a, const Member& b) { return a.scans < b.scans; };
  for (auto& candidates : groups) {  // first the member that gives the class its name
    std::iter_swap(candidates.begin(), std::max_element(candidates.begin(), candidates.end(), most_scans));
  }
  std::sort(groups.begin(), groups.end(),
            [](const auto& a, const auto& b) { return precedes(a.front(), b.front()); });

  PooledConditions pooled{{}, std::vector<std::size_t>(conditions.size())};
  for (const auto& candidates : groups) {
    for (const Member& member : candidates) pooled.class_of[member.index] = pooled.classes.size();
    pooled.classes.push_back(candidates.front().condition);
  }
  return pooled;
}

std::vector<RecordedCondition> conditionsOf(const Recording& recording) {
  std::vector<RecordedCondition> conditions;
  for (const matrix::Surface& surface : recording.conditions) {
    if (!surface.known()) {
      throw settings::InputError(recording.name +
                                 ": no curvature is recorded, but training needs the topic curvature");
    }
    conditions.push_back({{surface.name, principalCurvatures(surface)}, 0});
  }
  for (const std::uint32_t condition : recording.condition) ++conditions[condition].scans;
  return conditions;
}

ConditionClasses poolConditions(const std::vector<Recording>& recordings, PooledBy by) {
  std::vector<RecordedCondition> conditions;
  for (const Recording& recording : recordings) {
    const std::vector<RecordedCondition> own = conditionsOf(recording);
    const auto nameless = [](const RecordedCondition& recorded) {
      return recorded.condition.surface.empty();
    };
    if (by == PooledBy::kName && std::any_of(own.begin(), own.end(), nameless)) {
      throw settings::InputError(recording.name +
                                 ": a surface has no name, but to be pooled by name each needs one");
    }
    conditions.insert(conditions.end(), own.begin(), own.end());
  }
  const PooledConditions pooled = poolConditions(conditions, by);
  ConditionClasses classes{pooled.classes, {}};
  auto next = pooled.class_of.begin();
  for (const Recording& recording : recordings) {
    const auto end = next + static_cast<std::ptrdiff_t>(recording.conditions.size());
    classes.class_of.emplace_back(next, end);
    next = end;
  }
  return classes;
}

}  // namespace fsr::dataset
