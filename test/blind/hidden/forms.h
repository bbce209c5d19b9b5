#pragma once

#include <vector>

#include "blind/hidden.h"

namespace blind {

std::vector<HiddenForm> hysteresisForms();
std::vector<HiddenForm> creepForms();
std::vector<HiddenForm> timeSkewForms();
std::vector<HiddenForm> sealLeakForms();
std::vector<HiddenForm> mainsPickupForms();
std::vector<HiddenForm> repositioningForms();
std::vector<HiddenForm> deadTaxelForms();
std::vector<HiddenForm> stuckTaxelForms();
std::vector<HiddenForm> lineFaultForms();
std::vector<HiddenForm> temperatureForms();
std::vector<HiddenForm> wearForms();
std::vector<HiddenForm> driftForms();
std::vector<HiddenForm> breakInForms();
std::vector<HiddenForm> saturationForms();
std::vector<HiddenForm> foreignForms();

}  // namespace blind
