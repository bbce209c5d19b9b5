#include "session/coverage.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/view/colour_map.h"
#include "session/html_page.h"
#include "settings/number_text.h"

namespace fsr::session {

namespace {

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

Coverage coverageOf(const SessionPlan& plan, const std::vector<SessionStep>& steps,
                    const std::vector<StepState>& states) {
  Coverage coverage;
  coverage.largest_peak = largestPeak(plan);
  for (const PlannedSurface& one : plan.surfaces) {
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

namespace {

using settings::roundedText;

constexpr double kSvgCell = 22, kSvgRow = 28, kSvgMargin = 10, kSvgName = 150, kSvgBar = 10 * kSvgCell,
                 kText = 13;  // [pixels]
constexpr double kSvgUp = kSvgName + kSvgMargin, kSvgDown = kSvgUp + kSvgBar + 2 * kSvgMargin,
                 kSvgWidth = kSvgDown + kSvgBar + kSvgMargin;

// Bright = complete, as in drawCoverage().
std::string svgColour(const Share& share) {
  const view::Colour colour =
      view::colourAt(view::ColourMap::kCividis, share.accepted == share.planned ? 1 : 0.25);
  return "rgb(" + std::to_string(colour.red) + "," + std::to_string(colour.green) + "," +
         std::to_string(colour.blue) + ")";
}

std::string box(double x, double y, double width, double height, const std::string& more) {
  return "<rect x=\"" + roundedText(x) + "\" y=\"" + roundedText(y) + "\" width=\"" + roundedText(width) +
         "\" height=\"" + roundedText(height) + "\" " + more;
}

std::string label(double x, double y, const std::string& text) {
  return "<text x=\"" + roundedText(x) + "\" y=\"" + roundedText(y + kSvgCell - 6) + "\">" + escaped(text) +
         "</text>\n";
}

std::string countText(const Share& share) {
  return std::to_string(share.accepted) + " of " + std::to_string(share.planned);
}

std::string frame(double x, double y, double width, const std::string& title) {
  return box(x, y, width, kSvgCell, "fill=\"none\" stroke=\"#777\" pointer-events=\"all\"><title>") +
         escaped(title) + "</title></rect>\n";
}

double partOf(double length, const Share& share) {
  return length * share.accepted / share.planned;
}

// What is not planned has no cell.
std::string cells(double x, double y, const std::vector<Share>& bins, const std::string& what,
                  double bin_width) {
  std::string svg;
  for (std::size_t b = 0; b < bins.size(); ++b, x += kSvgCell) {
    if (bins[b].planned == 0) continue;
    const double height = partOf(kSvgCell, bins[b]);
    if (height > 0)
      svg += box(x, y + kSvgCell - height, kSvgCell, height, "fill=\"" + svgColour(bins[b]) + "\"/>");
    const auto edge = [&](std::size_t bin) {
      return roundedText(bin_width * static_cast<double>(bin) / 1e3, 4);
    };
    svg +=
        frame(x, y, kSvgCell, what + ", " + edge(b) + " to " + edge(b + 1) + " kPa: " + countText(bins[b]));
  }
  return svg;
}

std::string bar(double y, const std::string& name, const Share& share) {
  const double length = partOf(kSvgBar, share);
  return label(0, y, name) +
         (length > 0 ? box(kSvgUp, y, length, kSvgCell, "fill=\"" + svgColour(share) + "\"/>")
                     : std::string()) +
         frame(kSvgUp, y, kSvgBar, name + ": " + countText(share)) + label(kSvgDown, y, countText(share));
}

}  // namespace

std::string coverageSvg(const Coverage& coverage) {
  const double bin = coverage.largest_peak / Coverage::kBins;
  const std::string range = "0 to " + roundedText(coverage.largest_peak / 1e3, 3) + " kPa";
  double y = 0;
  std::string svg = label(kSvgUp, y, "loading, " + range) + label(kSvgDown, y, "unloading, " + range);
  for (const SurfaceCoverage& surface : coverage.surfaces) {
    y += kSvgRow;
    svg += label(0, y, surface.surface) +
           cells(kSvgUp, y, surface.loading, surface.surface + ", loading", bin) +
           cells(kSvgDown, y, surface.unloading, surface.surface + ", unloading", bin);
  }
  y += kSvgMargin;
  for (const ValueCoverage& pace : coverage.paces)
    svg += bar(y += kSvgRow, "pace " + roundedText(pace.value / 1e3, 3) + " kPa/s", pace.steps);
  for (const ValueCoverage& dwell : coverage.dwells)
    svg += bar(y += kSvgRow, "dwell " + roundedText(dwell.value, 3) + " s", dwell.steps);
  const std::string width = roundedText(kSvgWidth), height = roundedText(y + kSvgRow);
  return "<svg role=\"img\" aria-label=\"coverage\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + " " + height + "\" font-family=\"sans-serif\" font-size=\"" +
         roundedText(kText) + "\">\n" + svg + "</svg>";
}

}  // namespace fsr::session
