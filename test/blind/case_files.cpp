#include "blind/case_files.h"

#include <yaml-cpp/yaml.h>

#include <cmath>

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

void effectOf(YAML::Emitter& out, const HiddenTruth& truth, const Campaign& campaign) {
  out << YAML::BeginMap;
  out << YAML::Key << "id" << YAML::Value << truth.id;
  out << YAML::Key << "form" << YAML::Value << truth.form;
  out << YAML::Key << "strength" << YAML::Value << truth.strength;
  out << YAML::Key << "left_after_static_fit" << YAML::Value << rounded(truth.left);
  out << YAML::Key << "static_fit" << YAML::Value
      << (truth.left_after == LeftAfter::kCurveEach
              ? "one monotone curve for each taxel and surface"
              : "one monotone curve for each taxel, with gain and preload for each surface");
  out << YAML::Key << "snr" << YAML::Value << rounded(truth.snr);
  if (truth.has_state) out << YAML::Key << "carried_over" << YAML::Value << truth.carried_over;
  out << YAML::Key << "depends_on" << YAML::Value;
  flowList(out, truth.depends_on);
  out << YAML::Key << "where" << YAML::Value;
  placeOf(out, truth, campaign);
  out << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  for (const HiddenParameter& parameter : truth.parameters) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << parameter.name << YAML::Key
        << "value" << YAML::Value << rounded(parameter.value) << YAML::Key << "unit" << YAML::Value
        << parameter.unit << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
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
  out << YAML::Key << "effects" << YAML::Value;
  std::vector<std::string> asked;
  for (const EffectSpec& effect : spec.effects) {
    asked.push_back(effect.id + (effect.form.empty() ? "" : ":" + effect.form));
  }
  flowList(out, asked);
  out << YAML::EndMap;
}

// The correct verdict; "named" stands for all effects of the list.
const char* truthText(const BlindCase& blind_case) {
  if (blind_case.hidden.empty()) return "none";
  return blind_case.hidden.front().foreign ? "unknown" : "named";
}

}  // namespace

std::string keyText(const BlindCase& blind_case) {
  YAML::Emitter out;
  out.SetDoublePrecision(kDigits);
  out << YAML::BeginMap;
  out << YAML::Key << "key" << YAML::Value << kFormat;
  out << YAML::Key << "truth" << YAML::Value << truthText(blind_case);
  out << YAML::Key << "effects" << YAML::Value << YAML::BeginSeq;
  for (const HiddenTruth& truth : blind_case.hidden) effectOf(out, truth, blind_case.campaign);
  out << YAML::EndSeq;
  out << YAML::Key << "taxels" << YAML::Value << blind_case.campaign.taxels();
  out << YAML::Key << "conditions" << YAML::Value;
  std::vector<std::string> names;
  for (const fsr::matrix::Surface& surface : blind_case.campaign.surfaces) names.push_back(surface.name);
  flowList(out, names);
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

std::string publicText(const BlindCase& blind_case, const std::string& key_sha256) {
  const CaseSpec& spec = blind_case.spec;
  YAML::Emitter out;
  out.SetDoublePrecision(kDigits);
  out << YAML::BeginMap;
  out << YAML::Key << "blind_case" << YAML::Value << kFormat;
  out << YAML::Key << "key_sha256" << YAML::Value << key_sha256;
  const std::string& protocol = spec.then.empty() ? spec.protocol : spec.then;
  out << YAML::Key << "protocol" << YAML::Value << protocol;
  out << YAML::Key << "description" << YAML::Value << protocolDescription(protocol);
  out << YAML::Key << "matrix" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << "rows"
      << YAML::Value << spec.matrix.rows << YAML::Key << "columns" << YAML::Value << spec.matrix.columns
      << YAML::Key << "full_scale" << YAML::Value << kFullScale << YAML::EndMap;
  out << YAML::Key << "scan_rate" << YAML::Value << 10 << YAML::Comment("[Hz]");
  out << YAML::Key << "ambient_pressure" << YAML::Value << kAmbientPressure << YAML::Comment("[Pa]");
  out << YAML::Key << "thermometer" << YAML::Value << spec.thermometer;
  out << YAML::Key << "mount_labels" << YAML::Value << true;
  out << YAML::Key << "bags" << YAML::Value << YAML::BeginSeq;
  for (const fsr::dataset::Recording& recording : blind_case.recordings) out << recording.name;
  out << YAML::EndSeq << YAML::EndMap;
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
