#pragma once

#include <string>
#include <vector>

namespace fsr::settings {

/// Units for display; all other interfaces use Pa. kCount is for pictures of raw scans, which are not
/// pressures.
enum class PressureUnit { kKilopascal, kMillimetreOfMercury, kCount };

std::vector<std::string> pressureUnitNames();  ///< kPa, mmHg
/// Throws InputError for a name that is not among pressureUnitNames().
PressureUnit pressureUnitOf(const std::string& name);
std::string name(PressureUnit unit);
/// Size of one unit [Pa]. The conventional mmHg is 133.322387415 Pa (ISO 80000-4:2006). For kCount it is 1:
/// such a scale contains counts.
double pascals(PressureUnit unit);

/// Unit of the pressures in a program's text: kPa, until the program sets another at its start.
PressureUnit shownUnit();
void showPressuresIn(PressureUnit unit);

}  // namespace fsr::settings
