#include "view/taxel_look.h"

#include <algorithm>

#include "settings/number_text.h"

namespace fsr::view {

namespace {

constexpr std::uint16_t kBeyondTraining = map::taxel_flag::kReadingExtrapolated |
                                          map::taxel_flag::kCurvatureExtrapolated |
                                          map::taxel_flag::kTemperatureExtrapolated;

// "12 %": 1 to 99, because neither none nor all are meant.
std::string partText(double share) {
  return settings::percentText(std::clamp(share, 0.01, 0.99), 0);
}

}  // namespace

TaxelLook lookOf(float pressure, std::uint16_t flags) {
  if (!map::hasReading(pressure, flags)) return TaxelLook::kNoReading;
  if ((flags & map::taxel_flag::kSaturated) != 0) return TaxelLook::kSaturated;
  // A code below the lowest of training is extrapolated, too, but kBelowRange says more: the pressure is
  // small.
  if ((flags & map::taxel_flag::kBelowRange) != 0 && (flags & map::taxel_flag::kCurvatureExtrapolated) == 0) {
    return TaxelLook::kBelowRange;
  }
  return (flags & kBeyondTraining) != 0 ? TaxelLook::kExtrapolated : TaxelLook::kGood;
}

const std::vector<TaxelLook>& markedLooks() {
  static const std::vector<TaxelLook> looks = {TaxelLook::kExtrapolated, TaxelLook::kSaturated,
                                               TaxelLook::kNoReading};
  return looks;
}

std::string name(TaxelLook look) {
  switch (look) {
    case TaxelLook::kBelowRange:
      return "below range";
    case TaxelLook::kExtrapolated:
      return "extrapolated";
    case TaxelLook::kSaturated:
      return "saturated";
    case TaxelLook::kNoReading:
      return "no reading";
    case TaxelLook::kGood:
      break;
  }
  return "";
}

std::string settlingWord(double share) {
  if (share <= 0) return "";
  return share < 1 ? "settling: " + partText(share) + " of taxels" : "settling";
}

std::string settlingText(double share) {
  if (share <= 0) return "";
  return "history not settled" + (share < 1 ? " on " + partText(share) + " of taxels" : "");
}

const std::vector<Stroke>& mark(TaxelLook look) {
  static const std::vector<Stroke> none;
  static const std::vector<Stroke> diagonals = {{{-0.3, 0.1}, {0.1, -0.3}}, {{-0.1, 0.3}, {0.3, -0.1}}};
  static const std::vector<Stroke> square = {{{-0.28, -0.28}, {0.28, -0.28}},
                                             {{0.28, -0.28}, {0.28, 0.28}},
                                             {{0.28, 0.28}, {-0.28, 0.28}},
                                             {{-0.28, 0.28}, {-0.28, -0.28}}};
  static const std::vector<Stroke> cross = {{{-0.3, -0.3}, {0.3, 0.3}}, {{-0.3, 0.3}, {0.3, -0.3}}};
  switch (look) {
    case TaxelLook::kExtrapolated:
      return diagonals;
    case TaxelLook::kSaturated:
      return square;
    case TaxelLook::kNoReading:
      return cross;
    case TaxelLook::kBelowRange:
    case TaxelLook::kGood:
      break;
  }
  return none;
}

Colour markColour(Colour under) {
  // Luma as in Rec. ITU-R BT.601.
  const double luma = 0.299 * under.red + 0.587 * under.green + 0.114 * under.blue;
  return luma < 128.5 ? Colour{255, 255, 255} : Colour{0, 0, 0};
}

}  // namespace fsr::view
