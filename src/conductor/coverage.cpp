#include "conductor/coverage.h"

#include <algorithm>
#include <cmath>

#include "settings/number_text.h"

namespace fsr::conductor {

using session_plan::SessionStep;
using session_plan::StepKind;

namespace {

// The largest principal curvature of a surface, with its sign [1/m].
double bendOf(const matrix::Surface& surface) {
  double largest = 0;
  for (const matrix::Curvature& one : surface.curvature) {
    const double principal = principalCurvature(one);
    if (std::abs(principal) > std::abs(largest)) largest = principal;
  }
  return largest;
}

void add(Share& share, bool accepted) {
  ++share.planned;
  share.accepted += accepted ? 1 : 0;
}

void addValue(std::vector<ValueCoverage>& values, double value, bool accepted) {
  const auto same = [value](const ValueCoverage& one) { return one.value == value; };
  auto found = std::find_if(values.begin(), values.end(), same);
  if (found == values.end()) found = values.insert(values.end(), {value, {}});
  add(found->steps, accepted);
}

void addPasses(SurfaceCoverage& surface, const SessionStep& step, double largest, bool accepted) {
  for (std::size_t bin = 0; bin < Coverage::kBins; ++bin) {
    const double middle = (static_cast<double>(bin) + 0.5) / Coverage::kBins * largest;
    if (middle < step.low || middle > step.peak) continue;
    add(surface.loading[bin], accepted);
    if (step.kind != StepKind::kHold) add(surface.unloading[bin], accepted);
  }
}

bool isLoad(const SessionStep& step) {
  return step.kind == StepKind::kCycle || step.kind == StepKind::kLoop || step.kind == StepKind::kHold;
}

}  // namespace

Coverage coverageOf(const session_plan::SessionPlan& plan, const std::vector<SessionStep>& steps,
                    const std::vector<StepState>& states) {
  Coverage coverage;
  coverage.largest_peak = largestPeak(plan);
  for (const session_plan::PlannedSurface& one : plan.surfaces) {
    coverage.surfaces.push_back({one.surface.name, bendOf(one.surface), std::vector<Share>(Coverage::kBins),
                                 std::vector<Share>(Coverage::kBins)});
  }
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (!isLoad(steps[s])) continue;
    const bool accepted = states[s] == StepState::kAccepted;
    for (SurfaceCoverage& surface : coverage.surfaces) {
      if (surface.surface == steps[s].surface) addPasses(surface, steps[s], coverage.largest_peak, accepted);
    }
    addValue(coverage.paces, steps[s].fill_rate, accepted);
    if (steps[s].kind != StepKind::kLoop) addValue(coverage.dwells, steps[s].dwell_peak, accepted);
  }
  const auto less = [](const ValueCoverage& a, const ValueCoverage& b) { return a.value < b.value; };
  std::sort(coverage.paces.begin(), coverage.paces.end(), less);
  std::sort(coverage.dwells.begin(), coverage.dwells.end(), less);
  std::stable_sort(coverage.surfaces.begin(), coverage.surfaces.end(),
                   [](const auto& a, const auto& b) { return a.curvature < b.curvature; });
  return coverage;
}

namespace {

using view::Colour;
using view::Image;
using view::Pixel;

constexpr int kCell = 16, kRow = 20, kMargin = 8, kName = 130, kBar = 10 * kCell;  // [pixels]
constexpr int kWidth = kName + 2 * kBar + 4 * kMargin;
constexpr Colour kPaper{255, 255, 255}, kInk{0, 0, 0}, kFrame{120, 120, 120};

// Bright = complete.
Colour colourOf(const Share& share) {
  return view::colourAt(view::ColourMap::kCividis, share.accepted == share.planned ? 1 : 0.25);
}

// The part of `length` that was accepted [pixels].
int partOf(int length, const Share& share) {
  return length * static_cast<int>(share.accepted) / static_cast<int>(share.planned);
}

void frame(Image& image, Pixel corner, int width, int height) {
  const Pixel end{corner.x + width - 1, corner.y + height - 1};
  image.line(corner, {end.x, corner.y}, kFrame);
  image.line({corner.x, end.y}, end, kFrame);
  image.line(corner, {corner.x, end.y}, kFrame);
  image.line({end.x, corner.y}, end, kFrame);
}

void drawCells(Image& image, Pixel corner, const std::vector<Share>& bins) {
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const Pixel cell{corner.x + static_cast<int>(b) * kCell, corner.y};
    if (bins[b].planned == 0) continue;
    const int height = partOf(kCell, bins[b]);
    image.fill({cell.x, cell.y + kCell - height}, kCell, height, colourOf(bins[b]));
    frame(image, cell, kCell, kCell);
  }
}

void drawBar(Image& image, int y, const std::string& label, const Share& share) {
  const int left = kName + 2 * kMargin;
  image.text({kMargin, y}, label, kInk);
  image.fill({left, y}, partOf(kBar, share), kCell, colourOf(share));
  frame(image, {left, y}, kBar, kCell);
  image.text({left + kBar + kMargin, y},
             std::to_string(share.accepted) + " of " + std::to_string(share.planned), kInk);
}

}  // namespace

view::Image drawCoverage(const Coverage& coverage, const std::vector<std::string>& lines) {
  const std::size_t rows =
      lines.size() + 1 + coverage.surfaces.size() + coverage.paces.size() + coverage.dwells.size();
  Image image(kWidth, static_cast<int>(rows) * kRow + 3 * kMargin, kPaper);
  const int up = kName + 2 * kMargin, down = up + kBar + kMargin;
  int y = kMargin;
  for (const std::string& line : lines) {
    image.text({kMargin, y}, line, kInk);
    y += kRow;
  }
  const std::string range = "0 to " + settings::roundedText(coverage.largest_peak / 1e3, 3) + " kPa";
  image.text({up, y}, "loading, " + range, kInk);
  image.text({down, y}, "unloading", kInk);
  for (const SurfaceCoverage& surface : coverage.surfaces) {
    y += kRow;
    image.text({kMargin, y}, surface.surface.substr(0, 18), kInk);
    drawCells(image, {up, y}, surface.loading);
    drawCells(image, {down, y}, surface.unloading);
  }
  y += kMargin;
  for (const ValueCoverage& pace : coverage.paces)
    drawBar(image, y += kRow, "pace " + settings::roundedText(pace.value / 1e3, 3) + " kPa/s", pace.steps);
  for (const ValueCoverage& dwell : coverage.dwells)
    drawBar(image, y += kRow, "dwell " + settings::roundedText(dwell.value, 3) + " s", dwell.steps);
  return image;
}

}  // namespace fsr::conductor
