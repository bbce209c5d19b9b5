#include "conductor/coverage_svg.h"

#include "fsr_pressure_map/view/colour_map.h"
#include "report/day/html_page.h"
#include "settings/number_text.h"

namespace fsr::conductor {

namespace {

using report::escaped;
using settings::roundedText;

constexpr double kCell = 22, kRow = 28, kMargin = 10, kName = 150, kBar = 10 * kCell, kText = 13;  // [pixels]
constexpr double kUp = kName + kMargin, kDown = kUp + kBar + 2 * kMargin, kWidth = kDown + kBar + kMargin;

// Bright = complete, as in drawCoverage().
std::string colourOf(const Share& share) {
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
  return "<text x=\"" + roundedText(x) + "\" y=\"" + roundedText(y + kCell - 6) + "\">" + escaped(text) +
         "</text>\n";
}

std::string countText(const Share& share) {
  return std::to_string(share.accepted) + " of " + std::to_string(share.planned);
}

std::string frame(double x, double y, double width, const std::string& title) {
  return box(x, y, width, kCell, "fill=\"none\" stroke=\"#777\" pointer-events=\"all\"><title>") +
         escaped(title) + "</title></rect>\n";
}

double partOf(double length, const Share& share) {
  return length * share.accepted / share.planned;
}

// What is not planned has no cell.
std::string cells(double x, double y, const std::vector<Share>& bins, const std::string& what,
                  double bin_width) {
  std::string svg;
  for (std::size_t b = 0; b < bins.size(); ++b, x += kCell) {
    if (bins[b].planned == 0) continue;
    const double height = partOf(kCell, bins[b]);
    if (height > 0) svg += box(x, y + kCell - height, kCell, height, "fill=\"" + colourOf(bins[b]) + "\"/>");
    const auto edge = [&](std::size_t bin) {
      return roundedText(bin_width * static_cast<double>(bin) / 1e3, 4);
    };
    svg += frame(x, y, kCell, what + ", " + edge(b) + " to " + edge(b + 1) + " kPa: " + countText(bins[b]));
  }
  return svg;
}

std::string bar(double y, const std::string& name, const Share& share) {
  const double length = partOf(kBar, share);
  return label(0, y, name) +
         (length > 0 ? box(kUp, y, length, kCell, "fill=\"" + colourOf(share) + "\"/>") : std::string()) +
         frame(kUp, y, kBar, name + ": " + countText(share)) + label(kDown, y, countText(share));
}

}  // namespace

std::string coverageSvg(const Coverage& coverage) {
  const double bin = coverage.largest_peak / Coverage::kBins;
  const std::string range = "0 to " + roundedText(coverage.largest_peak / 1e3, 3) + " kPa";
  double y = 0;
  std::string svg = label(kUp, y, "loading, " + range) + label(kDown, y, "unloading, " + range);
  for (const SurfaceCoverage& surface : coverage.surfaces) {
    y += kRow;
    svg += label(0, y, surface.surface) + cells(kUp, y, surface.loading, surface.surface + ", loading", bin) +
           cells(kDown, y, surface.unloading, surface.surface + ", unloading", bin);
  }
  y += kMargin;
  for (const ValueCoverage& pace : coverage.paces)
    svg += bar(y += kRow, "pace " + roundedText(pace.value / 1e3, 3) + " kPa/s", pace.steps);
  for (const ValueCoverage& dwell : coverage.dwells)
    svg += bar(y += kRow, "dwell " + roundedText(dwell.value, 3) + " s", dwell.steps);
  const std::string width = roundedText(kWidth), height = roundedText(y + kRow);
  return "<svg role=\"img\" aria-label=\"coverage\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + " " + height + "\" font-family=\"sans-serif\" font-size=\"" +
         roundedText(kText) + "\">\n" + svg + "</svg>";
}

}  // namespace fsr::conductor
