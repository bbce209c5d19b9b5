#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

std::string name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNone:
      return "none";
    case Verdict::kUnknown:
      return "unknown";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kWrongForm:
      return "wrong_form";
    case Verdict::kNamed:
      return "named";
    case Verdict::kNotIdentifiable:
      return "not_identifiable";
  }
  return "";
}

}  // namespace fsr::discrepancy
