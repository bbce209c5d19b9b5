#include "conductor/coverage_svg.h"

#include "fsr_pressure_map/view/colour_map.h"
#include "report/day/html_page.h"
#include "settings/number_text.h"

namespace fsr::conductor {

namespace {

using report::escaped;
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

}  // namespace fsr::conductor
