#include "blind/hidden.h"

#include <algorithm>

#include "blind/hidden/forms.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {

namespace {

std::vector<HiddenForm> collect() {
  std::vector<HiddenForm> all;
  for (const auto& forms :
       {hysteresisForms(), creepForms(), timeSkewForms(), sealLeakForms(), mainsPickupForms(),
        repositioningForms(), stuckTaxelForms(), deadTaxelForms(), lineFaultForms(), temperatureForms(),
        wearForms(), driftForms(), breakInForms(), saturationForms(), foreignForms()}) {
    all.insert(all.end(), forms.begin(), forms.end());
  }
  return all;
}

}  // namespace

const std::vector<HiddenForm>& hiddenForms() {
  static const std::vector<HiddenForm> forms = collect();
  return forms;
}

std::vector<const HiddenForm*> formsOf(const std::string& id) {
  std::vector<const HiddenForm*> found;
  for (const HiddenForm& form : hiddenForms()) {
    if (form.id == id) found.push_back(&form);
  }
  return found;
}

std::vector<const HiddenForm*> openFormsOf(const std::string& id) {
  std::vector<const HiddenForm*> found;
  for (const HiddenForm* form : formsOf(id)) {
    if (form->set == 'A') found.push_back(form);
  }
  return found;
}

std::vector<std::string> hiddenIds() {
  std::vector<std::string> ids;
  for (const HiddenForm& form : hiddenForms()) {
    if (std::find(ids.begin(), ids.end(), form.id) == ids.end()) ids.push_back(form.id);
  }
  return ids;
}

const HiddenForm& findForm(const std::string& id, const std::string& form) {
  std::string known;
  for (const HiddenForm& candidate : hiddenForms()) {
    if (candidate.id == id && candidate.form == form) return candidate;
    known += (known.empty() ? "" : ", ") + candidate.id + ":" + candidate.form;
  }
  throw fsr::settings::InputError("effect is '" + id + ":" + form + "', but must be one of " + known);
}

std::vector<double> taxelScatter(const HiddenSetup& setup, const std::string& purpose, double deviation) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < setup.campaign.taxels(); ++i) {
    factors.push_back(1 + deviation * std::clamp(Random(setup.seed, purpose, i).normal(), -2.5, 2.5));
  }
  return factors;
}

}  // namespace blind
