#include "session/coverage.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/view/colour_map.h"
#include "session/html_page.h"
#include "settings/number_text.h"

namespace fsr::session {

Coverage coverageOf(const SessionPlan& plan, const std::vector<SessionStep>& steps,
                    const std::vector<StepState>& states) {
  Coverage coverage;
  coverage.largest_peak = largestPeak(plan);
  const std::vector<Share> none(Coverage::kBins);
  for (const PlannedSurface& one : plan.surfaces)
    coverage.surfaces.push_back({one.surface.name, bendOf(one.surface), none, none});
  std::stable_sort(coverage.surfaces.begin(), coverage.surfaces.end(),
                   [](const auto& a, const auto& b) { return a.curvature < b.curvature; });
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const SessionStep& step = steps[s];
    if (!step.recorded || !step.loads()) continue;
    const auto add = [accepted = states[s] == StepState::kAccepted](Share& share) {
      ++share.planned;
      share.accepted += accepted ? 1 : 0;
    };
    for (SurfaceCoverage& surface : coverage.surfaces) {
      if (surface.surface != step.surface) continue;
      for (std::size_t bin = 0; bin < Coverage::kBins; ++bin) {
        const double middle = (static_cast<double>(bin) + 0.5) / Coverage::kBins * coverage.largest_peak;
        if (middle < step.low || middle > step.peak) continue;
        add(surface.loading[bin]);
        if (step.kind != StepKind::kHold) add(surface.unloading[bin]);
      }
    }
    add(coverage.paces[step.fill_rate]);
    if (step.kind != StepKind::kLoop) add(coverage.dwells[step.dwell_peak]);
  }
  return coverage;
}

namespace {

using settings::roundedText;
using view::Pixel;

constexpr int kCell = 16, kRow = 20, kMargin = 8, kName = 130, kBar = Coverage::kBins * kCell;  // [pixels]
constexpr int kLeft = kName + 2 * kMargin, kRight = kLeft + kBar + kMargin, kWidth = kRight + kBar + kMargin;
constexpr view::Colour kPaper{255, 255, 255}, kInk{0, 0, 0}, kFrame{120, 120, 120};
constexpr double kSvgScale = 1.4;  // of the pixels above

struct Label {
  Pixel corner;
  std::string text;
};

/// A cell, which fills from below, or a bar, which fills from the left.
struct Box {
  Pixel corner;
  int width;
  Share share;
  bool upright;
  std::string title;
};

struct Rectangle {
  Pixel corner;
  int width, height;
};

// The accepted part.
Rectangle filled(const Box& box) {
  const auto part = [&](int length) {
    return length * static_cast<int>(box.share.accepted) / static_cast<int>(box.share.planned);
  };
  if (!box.upright) return {box.corner, part(box.width), kCell};
  return {{box.corner.x, box.corner.y + kCell - part(kCell)}, box.width, part(kCell)};
}

// Bright = complete.
view::Colour colourOf(const Share& share) {
  return view::colourAt(view::ColourMap::kCividis, share.accepted == share.planned ? 1 : 0.25);
}

std::string countText(const Share& share) {
  return std::to_string(share.accepted) + " of " + std::to_string(share.planned);
}

/// Where everything stands, in the picture and in the page.
class Layout {
 public:
  Layout(const Coverage& coverage, const std::vector<std::string>& lines) : coverage_(coverage) {
    for (const std::string& line : lines) {
      labels.push_back({{kMargin, y_}, line});
      y_ += kRow;
    }
    labels.push_back({{kLeft, y_}, "loading, 0 to " + kilopascals(coverage.largest_peak) + " kPa"});
    labels.push_back({{kRight, y_}, "unloading"});
    for (const SurfaceCoverage& one : coverage.surfaces) {
      y_ += kRow;
      labels.push_back({{kMargin, y_}, one.surface.substr(0, 18)});
      addCells(kLeft, one.loading, one.surface + ", loading, ");
      addCells(kRight, one.unloading, one.surface + ", unloading, ");
    }
    y_ += kMargin;
    for (const auto& [pace, steps] : coverage.paces) addBar("pace " + kilopascals(pace) + " kPa/s", steps);
    for (const auto& [dwell, steps] : coverage.dwells) addBar("dwell " + roundedText(dwell, 3) + " s", steps);
  }

  int height() const { return y_ + kRow + kMargin; }

  std::vector<Label> labels;
  std::vector<Box> boxes;

 private:
  static std::string kilopascals(double pressure) { return roundedText(pressure / 1e3, 3); }
  // What is not planned has no cell.
  void addCells(int x, const std::vector<Share>& bins, const std::string& what) {
    const double bin = coverage_.largest_peak / Coverage::kBins;
    for (std::size_t b = 0; b < bins.size(); ++b) {
      const auto from = static_cast<double>(b);
      if (bins[b].planned > 0)
        boxes.push_back({{x + static_cast<int>(b) * kCell, y_},
                         kCell,
                         bins[b],
                         true,
                         what + kilopascals(bin * from) + " to " + kilopascals(bin * (from + 1)) +
                             " kPa: " + countText(bins[b])});
    }
  }
  void addBar(const std::string& name, const Share& share) {
    y_ += kRow;
    labels.push_back({{kMargin, y_}, name});
    boxes.push_back({{kLeft, y_}, kBar, share, false, name + ": " + countText(share)});
    labels.push_back({{kRight, y_}, countText(share)});
  }

  const Coverage& coverage_;
  int y_ = kMargin;
};

void frame(view::Image& image, const Box& box) {
  const Pixel corner = box.corner, end{corner.x + box.width - 1, corner.y + kCell - 1};
  image.line(corner, {end.x, corner.y}, kFrame);
  image.line({corner.x, end.y}, end, kFrame);
  image.line(corner, {corner.x, end.y}, kFrame);
  image.line({end.x, corner.y}, end, kFrame);
}

std::string svgRectangle(const Rectangle& at, const std::string& more) {
  return "<rect x=\"" + std::to_string(at.corner.x) + "\" y=\"" + std::to_string(at.corner.y) +
         "\" width=\"" + std::to_string(at.width) + "\" height=\"" + std::to_string(at.height) + "\" " + more;
}

std::string svgColour(const view::Colour& colour) {
  return "rgb(" + std::to_string(colour.red) + "," + std::to_string(colour.green) + "," +
         std::to_string(colour.blue) + ")";
}

}  // namespace

view::Image drawCoverage(const Coverage& coverage, const std::vector<std::string>& lines) {
  const Layout layout(coverage, lines);
  view::Image image(kWidth, layout.height(), kPaper);
  for (const Box& box : layout.boxes) {
    const Rectangle part = filled(box);
    image.fill(part.corner, part.width, part.height, colourOf(box.share));
    frame(image, box);
  }
  for (const Label& label : layout.labels) image.text(label.corner, label.text, kInk);
  return image;
}

std::string coverageSvg(const Coverage& coverage) {
  const Layout layout(coverage, {});
  std::string svg = "<svg role=\"img\" aria-label=\"coverage\" width=\"" + roundedText(kSvgScale * kWidth) +
                    "\" height=\"" + roundedText(kSvgScale * layout.height()) + "\" viewBox=\"0 0 " +
                    std::to_string(kWidth) + " " + std::to_string(layout.height()) +
                    "\" font-family=\"sans-serif\" font-size=\"10\">\n";
  for (const Box& box : layout.boxes) {
    svg += svgRectangle(filled(box), "fill=\"" + svgColour(colourOf(box.share)) + "\"/>");
    svg += svgRectangle({box.corner, box.width, kCell},
                        "fill=\"none\" stroke=\"#777\" pointer-events=\"all\"><title>") +
           escaped(box.title) + "</title></rect>\n";
  }
  for (const Label& label : layout.labels)
    svg += "<text x=\"" + std::to_string(label.corner.x) + "\" y=\"" +
           std::to_string(label.corner.y + kCell - 4) + "\">" + escaped(label.text) + "</text>\n";
  return svg + "</svg>";
}

}  // namespace fsr::session
