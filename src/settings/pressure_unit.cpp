#include "fsr_pressure_map/settings/pressure_unit.h"

#include <atomic>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

namespace {

std::atomic<PressureUnit> shown_unit{PressureUnit::kKilopascal};

}  // namespace

std::vector<std::string> pressureUnitNames() {
  return {"kPa", "mmHg"};
}

PressureUnit pressureUnitOf(const std::string& name) {
  if (name == "kPa") return PressureUnit::kKilopascal;
  if (name == "mmHg") return PressureUnit::kMillimetreOfMercury;
  throw InputError("unit is \"" + name + "\", but must be kPa or mmHg");
}

std::string name(PressureUnit unit) {
  switch (unit) {
    case PressureUnit::kKilopascal:
      return "kPa";
    case PressureUnit::kMillimetreOfMercury:
      return "mmHg";
    case PressureUnit::kCount:
      break;
  }
  return "counts";
}

double pascals(PressureUnit unit) {
  switch (unit) {
    case PressureUnit::kKilopascal:
      return 1000;
    case PressureUnit::kMillimetreOfMercury:
      return 133.322387415;
    case PressureUnit::kCount:
      break;
  }
  return 1;
}

PressureUnit shownUnit() {
  return shown_unit;
}

void showPressuresIn(PressureUnit unit) {
  shown_unit = unit;
}

}  // namespace fsr::settings
