#include "blind/case_files.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <vector>

#include "settings/settings.h"

namespace blind {

namespace {

constexpr int kFormat = 1;
constexpr int kDigits = 12;  // enough for a followed key to give the same counts, or nearly

double rounded(double value, int digits = 5) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return std::round(value * scale) / scale;
}

template <typename Value>
void put(YAML::Emitter& out, const char* key, const Value& value) {
  out << YAML::Key << key << YAML::Value << value;
}

void put(YAML::Emitter& out, const char* key, double value) {
  out << YAML::Key << key << YAML::Value << rounded(value);
}

template <typename Values>
void flowList(YAML::Emitter& out, const Values& values) {
  out << YAML::Flow << YAML::BeginSeq;
  for (const auto& value : values) out << value;
  out << YAML::EndSeq;
}

void placeOf(YAML::Emitter& out, const HiddenTruth& truth, const Campaign& campaign) {
  out << YAML::BeginMap << YAML::Key << "taxels" << YAML::Value;
  if (truth.taxels.size() == campaign.taxels()) {
    out << "all";
  } else {
    flowList(out, truth.taxels);
  }
  out << YAML::Key << "conditions" << YAML::Value;
  std::vector<std::string> names;
  for (const std::size_t surface : truth.surfaces) names.push_back(campaign.surfaces[surface].name);
  if (names.size() == campaign.surfaces.size()) {
    out << "all";
  } else {
    flowList(out, names);
  }
  out << YAML::Key << "pressure" << YAML::Value << YAML::Flow << YAML::BeginSeq << truth.pressures.first
      << truth.pressures.second << YAML::EndSeq;
  out << YAML::Key << "direction" << YAML::Value << truth.direction;
  out << YAML::Key << "time" << YAML::Value;
  if (truth.times.empty()) {
    out << "all";
  } else {
    out << YAML::Flow << YAML::BeginSeq;
    for (const auto& [from, to] : truth.times) {
      out << YAML::Flow << YAML::BeginSeq << rounded(from, 6) << rounded(to, 6) << YAML::EndSeq;
    }
    out << YAML::EndSeq;
  }
  out << YAML::EndMap;
}

void askedEffects(YAML::Emitter& out, const CaseSpec& spec) {
  std::vector<std::string> asked;
  for (const EffectSpec& effect : spec.effects) {
    asked.push_back(effect.id + (effect.form.empty() ? "" : ":" + effect.form));
  }
  out << YAML::Key << "effects" << YAML::Value;
  flowList(out, asked);
}

void specOf(YAML::Emitter& out, const CaseSpec& spec) {
  out << YAML::BeginMap;
  out << YAML::Key << "seed" << YAML::Value << spec.seed;
  out << YAML::Key << "protocol" << YAML::Value << spec.protocol;
  if (!spec.then.empty()) out << YAML::Key << "then" << YAML::Value << spec.then;
  out << YAML::Key << "snr" << YAML::Value << spec.snr;
  out << YAML::Key << "rows" << YAML::Value << spec.matrix.rows;
  out << YAML::Key << "columns" << YAML::Value << spec.matrix.columns;
  out << YAML::Key << "surfaces" << YAML::Value << spec.size.surfaces;
  out << YAML::Key << "cycles" << YAML::Value << spec.size.cycles;
  out << YAML::Key << "thermometer" << YAML::Value << spec.thermometer;
  out << YAML::Key << "local" << YAML::Value << spec.local;
  askedEffects(out, spec);
  out << YAML::EndMap;
}

// The correct verdict; "named" stands for all effects of the list.
const char* truthText(const BlindCase& blind_case) {
  if (blind_case.hidden.empty()) return "none";
  return blind_case.hidden.front().foreign ? "unknown" : "named";
}

// The name that the package's simulation has for a parameter; empty where the forms have nothing in common
// but the effect.
std::string libraryParameter(const std::string& id, const std::string& parameter) {
  static const std::map<std::string, std::string> names = {{"time_skew.mean_delay", "delay"},
                                                           {"mains_pickup.mains", "frequency"},
                                                           {"mains_pickup.time_per_taxel", "taxel_time"},
                                                           {"temperature.slope", "coefficient"},
                                                           {"temperature.lag", "lag"},
                                                           {"drift.time_constant", "time_constant"}};
  const auto found = names.find(id + "." + parameter);
  return found == names.end() ? "" : found->second;
}

// `digits` of the strength.
void hiddenEffect(YAML::Emitter& out, const HiddenTruth& truth, const Campaign& campaign, int digits) {
  out << YAML::BeginMap;
  put(out, "id", truth.id);
  put(out, "form", truth.form);
  put(out, "set", std::string(1, truth.set));
  out << YAML::Key << "strength" << YAML::Value << rounded(truth.strength, digits);
  put(out, "left_after_static_fit", truth.left);
  put(out, "static_fit",
      truth.left_after == LeftAfter::kCurveEach ? "curve_of_taxel_and_surface" : "curve_of_taxel");
  put(out, "snr", truth.snr);
  put(out, "kpa_at_map", truth.kpa_at_map);
  put(out, "size_reached", truth.size_reached);
  out << YAML::Key << "carried_over" << YAML::Value;
  if (truth.has_state) {
    out << truth.carried_over;
  } else {
    out << YAML::Null;
  }
  out << YAML::Key << "depends_on" << YAML::Value;
  flowList(out, truth.depends_on);
  out << YAML::Key << "where" << YAML::Value;
  placeOf(out, truth, campaign);
  out << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  for (const HiddenParameter& parameter : truth.parameters) {
    out << YAML::Flow << YAML::BeginMap;
    put(out, "name", parameter.name);
    put(out, "value", parameter.value);
    put(out, "unit", parameter.unit);
    const std::string known = libraryParameter(truth.id, parameter.name);
    out << YAML::Key << "library_parameter" << YAML::Value;
    if (known.empty()) {
      out << YAML::Null;
    } else {
      out << known;
    }
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
}

void identifiability(YAML::Emitter& out, const Identifiability& identifiable) {
  out << YAML::BeginMap << YAML::Key << "effects" << YAML::Value << YAML::BeginSeq;
  for (const Told& told : identifiable.effects) {
    out << YAML::BeginMap;
    put(out, "id", told.id);
    put(out, "hidden", told.hidden);
    put(out, "could_be_told", told.could_be_told);
    out << YAML::Key << "reason" << YAML::Value;
    if (told.reason.empty()) {
      out << YAML::Null;
    } else {
      out << told.reason;
    }
    out << YAML::Key << "confused_with" << YAML::Value;
    flowList(out, told.confused_with);
    put(out, "nats", told.nats);
    put(out, "own_forms", told.own_forms);
    out << YAML::Key << "beyond_rival" << YAML::Value << YAML::Flow << YAML::BeginMap;
    for (const auto& [rival, left] : told.beyond) {
      out << YAML::Key << rival << YAML::Value << YAML::Flow << YAML::BeginSeq << rounded(left.first, 3)
          << rounded(left.second, 3) << YAML::EndSeq;
    }
    out << YAML::EndMap << YAML::EndMap;
  }
  out << YAML::EndSeq;
  put(out, "nats_needed", kNats);
  put(out, "share_needed", kLeftShare);
  put(out, "note",
      "nats: expected log-likelihood above the static fit; beyond_rival: nats and share of the squares that "
      "each rival "
      "leaves; effects that are not hidden are judged at the size of the hidden one");
  out << YAML::EndMap;
}

void sheetOf(YAML::Emitter& out, const BlindCase& made) {
  const RigPlan& plan = *made.plan;
  out << YAML::BeginMap;
  put(out, "rows", plan.matrix.rows);
  put(out, "columns", plan.matrix.columns);
  put(out, "pitch", plan.pitch);
  put(out, "bits", plan.bits);
  put(out, "full_scale", made.full_scale);
  put(out, "scan_rate", plan.scan_rate);
  put(out, "static_law", made.static_law);
  put(out, "preload", made.preload_law);
  put(out, "gain", made.gain_law);
  out << YAML::EndMap;
}

void noiseOf(YAML::Emitter& out, const BlindCase& made) {
  out << YAML::BeginMap;
  out << YAML::Key << "rms" << YAML::Value << made.noise;
  put(out, "through_the_reference", made.reference_noise);
  put(out, "colour", made.noise_colour);
  put(out, "cycle_gain", made.cycle_gain);
  out << YAML::EndMap;
}

void protocolOf(YAML::Emitter& out, const BlindCase& made) {
  const RigPlan& plan = *made.plan;
  out << YAML::BeginMap;
  put(out, "surfaces", plan.radii.size());
  put(out, "mounts", plan.visits.size());
  put(out, "mounts_of_a_surface", plan.mounts);
  put(out, "cycles", plan.cycles);
  put(out, "scans", made.campaign.scans());
  put(out, "lost_scans", made.lost_scans);
  put(out, "peak_pa", plan.peak);
  out << YAML::Key << "reach" << YAML::Value;
  std::vector<double> reach;
  for (const double share : plan.reach) reach.push_back(rounded(share, 4));
  flowList(out, reach);
  put(out, "fastest_ramp", plan.fastest);
  put(out, "slowest_ramp", plan.slowest);
  put(out, "one_pace", plan.onePace());
  put(out, "filling", plan.exponential ? "exponential" : "straight");
  put(out, "thermometer", plan.thermometer);
  put(out, "room_drift", plan.room.drift);
  put(out, "room_shape", plan.room.shape);
  put(out, "bags", made.bags.size());
  put(out, "bags_cut", plan.cut.kind);
  out << YAML::Key << "reference" << YAML::Value << YAML::Flow << YAML::BeginMap;
  put(out, "rate", plan.reference.rate);
  put(out, "averaged", plan.reference.averaged);
  put(out, "noise_pa", plan.reference.noise * plan.peak);
  put(out, "offset_pa", plan.reference.offset * plan.peak);
  put(out, "slope", plan.reference.slope);
  put(out, "bits", plan.reference.bits);
  out << YAML::EndMap << YAML::EndMap;
}

void namedSpecOf(YAML::Emitter& out, const CaseSpec& spec) {
  out << YAML::BeginMap;
  put(out, "name", spec.name);
  put(out, "protocol_class", spec.protocol_class.empty() ? std::string("drawn") : spec.protocol_class);
  put(out, "most_readings", spec.most_readings);
  out << YAML::Key << "snr" << YAML::Value;
  if (spec.kpa || spec.effects.empty()) {
    out << YAML::Null;
  } else {
    out << spec.snr;
  }
  out << YAML::Key << "kpa" << YAML::Value;
  if (spec.kpa) {
    out << *spec.kpa;
  } else {
    out << YAML::Null;
  }
  put(out, "local", spec.local);
  askedEffects(out, spec);
  out << YAML::EndMap;
}

void conditionsOf(YAML::Emitter& out, const Campaign& campaign) {
  std::vector<std::string> names;
  for (const fsr::matrix::Surface& surface : campaign.surfaces) names.push_back(surface.name);
  out << YAML::Key << "conditions" << YAML::Value;
  flowList(out, names);
}

// Schema 2; README.md in this folder explains the fields.
std::string namedKeyText(const BlindCase& made) {
  bool sealed = false;
  for (const HiddenTruth& truth : made.hidden) sealed = sealed || truth.set == 'B';
  YAML::Emitter out;
  out.SetDoublePrecision(kDigits);
  out << YAML::BeginMap;
  put(out, "schema", 2);
  put(out, "case", made.spec.name);
  put(out, "truth", truthText(made));
  put(out, "set", sealed ? "B" : "A");
  put(out, "protocol_class", made.plan->protocol_class);
  out << YAML::Key << "effects" << YAML::Value << YAML::BeginSeq;
  for (const HiddenTruth& truth : made.hidden) hiddenEffect(out, truth, made.campaign, 5);
  out << YAML::EndSeq << YAML::Key << "identifiable" << YAML::Value;
  identifiability(out, made.identifiable);
  put(out, "taxels", made.campaign.taxels());
  conditionsOf(out, made.campaign);
  out << YAML::Key << "sheet" << YAML::Value;
  sheetOf(out, made);
  out << YAML::Key << "noise" << YAML::Value;
  noiseOf(out, made);
  out << YAML::Key << "protocol" << YAML::Value;
  protocolOf(out, made);
  out << YAML::Key << "spec" << YAML::Value;
  namedSpecOf(out, made.spec);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace

std::string keyText(const BlindCase& blind_case) {
  if (blind_case.plan) return namedKeyText(blind_case);
  YAML::Emitter out;
  out.SetDoublePrecision(kDigits);
  out << YAML::BeginMap;
  out << YAML::Key << "key" << YAML::Value << kFormat;
  out << YAML::Key << "truth" << YAML::Value << truthText(blind_case);
  out << YAML::Key << "effects" << YAML::Value << YAML::BeginSeq;
  for (const HiddenTruth& truth : blind_case.hidden) hiddenEffect(out, truth, blind_case.campaign, kDigits);
  out << YAML::EndSeq;
  out << YAML::Key << "taxels" << YAML::Value << blind_case.campaign.taxels();
  conditionsOf(out, blind_case.campaign);
  out << YAML::Key << "noise" << YAML::Value << YAML::BeginMap << YAML::Key << "rms" << YAML::Value
      << blind_case.noise << YAML::Key << "through_the_reference" << YAML::Value
      << rounded(blind_case.reference_noise) << YAML::Key << "colour" << YAML::Value
      << blind_case.noise_colour << YAML::EndMap;
  out << YAML::Key << "sheet" << YAML::Value << YAML::BeginMap << YAML::Key << "static_law" << YAML::Value
      << blind_case.static_law << YAML::Key << "preload" << YAML::Value << blind_case.preload_law << YAML::Key
      << "gain" << YAML::Value << blind_case.gain_law << YAML::EndMap;
  out << YAML::Key << "spec" << YAML::Value;
  specOf(out, blind_case.spec);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

CaseSpec specFromKey(const std::string& path) {
  const fsr::settings::Settings key = fsr::settings::Settings::fromFile(path);
  const fsr::settings::Settings made = key.section("spec");
  const fsr::settings::Range any;
  CaseSpec spec;
  spec.seed = static_cast<std::uint64_t>(made.integer("seed", any));
  spec.protocol = made.text("protocol");
  spec.snr = made.number("snr", {0, 100, ""});
  spec.matrix.rows = static_cast<std::uint16_t>(made.integer("rows", {1, 64, ""}));
  spec.matrix.columns = static_cast<std::uint16_t>(made.integer("columns", {1, 64, ""}));
  spec.size.surfaces = static_cast<std::size_t>(made.integer("surfaces", {1, 6, ""}));
  spec.size.cycles = made.number("cycles", {0, 10, ""});
  spec.thermometer = made.flag("thermometer", true);
  spec.local = made.flag("local", true);
  spec.noise = key.section("noise").number("rms", {0, 1, ""});
  for (const fsr::settings::Settings& effect : key.sections("effects")) {
    spec.effects.push_back({effect.text("id"), effect.text("form"), effect.number("strength", {0, 10, ""})});
  }
  return spec;
}

}  // namespace blind
