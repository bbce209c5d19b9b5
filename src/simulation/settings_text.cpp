#include "simulation/settings_text.h"

#include <algorithm>
#include <sstream>

#include "settings/text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

std::string onOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string commented(const std::string& head) {
  std::istringstream lines(head);
  std::string result, line;
  while (std::getline(lines, line)) result += "# " + line + "\n";
  return result;
}

std::string list(const matrix::Surface& surface, double matrix::Curvature::*component) {
  std::string result;
  for (const matrix::Curvature& curvature : surface.curvature) {
    result += (result.empty() ? "" : ", ") + settings::numberText(curvature.*component);
  }
  return surface.curvature.size() == 1 ? result : "[" + result + "]";
}

std::string text(const matrix::Surface& surface) {
  std::string result = "surface: " + settings::quotedText(surface.name);
  const char* form = surface.curvature.size() == 1 ? "two_planes" : "taxels";
  result += std::string(", ") + form + ": {x: " + list(surface, &matrix::Curvature::x) +
            ", y: " + list(surface, &matrix::Curvature::y) +
            ", xy: " + list(surface, &matrix::Curvature::xy) + "}";
  if (!surface.deviation.empty()) result += ", deviation: " + settings::numberText(surface.deviation.front());
  return result;
}

std::string text(const LoadPattern& pattern) {
  const std::string place = "x: " + settings::numberText(pattern.centre.x) +
                            ", y: " + settings::numberText(pattern.centre.y) + ", ";
  if (pattern.kind == LoadPattern::Kind::kUniform) return "";
  return pattern.kind == LoadPattern::Kind::kDisc
             ? ", load: {disc: {" + place + "radius: " + settings::numberText(pattern.radius) + "}}"
             : ", load: {edge: {" + place + "angle: " + settings::numberText(pattern.angle) + "}}";
}

std::string text(const Station& station) {
  std::string result = "  - {" + text(station.surface) + text(station.load) +
                       ", pause: " + settings::numberText(station.pause) + ",\n     program: [";
  for (std::size_t i = 0; i < station.program.size(); ++i) {
    result += (i == 0 ? "{" : ",\n               {") + programText(station.program[i]) + "}";
  }
  return result + "]}\n";
}

std::string text(const SimulatedBoard& board) {
  return "board: {serial: " + settings::quotedText(board.serial) +
         ", firmware: " + settings::quotedText(board.firmware) +
         ", model: " + settings::quotedText(board.model) +
         ",\n        scan_rate: " + settings::numberText(board.scan_rate) +
         ", scan_duration: " + settings::numberText(board.scan_duration) +
         ", transducer_rate: " + settings::numberText(board.transducer_rate) + "}\n";
}

std::string text(const ChamberClimate& climate) {
  std::string room;
  for (const TemperaturePoint& point : climate.room) {
    room += (room.empty() ? "" : ", ") + ("{time: " + settings::numberText(point.time)) +
            ", temperature: " + settings::numberText(point.temperature) + "}";
  }
  return "climate:\n" + (room.empty() ? "" : "  room: [" + room + "]\n") +
         "  heating: " + settings::numberText(climate.heating) +
         "\n  cooling: " + settings::numberText(climate.cooling) + "\n";
}

std::string text(const EnabledEffect& effect, const EffectInfo& info, const ValueRemarks& remarks) {
  std::string result = "  " + effect.id + ":\n";
  for (const EffectParameter& parameter : info.parameters) {
    const std::string& unit = parameter.permitted.unit;
    result += "    " + parameter.name + ": " + settings::numberText(effect.values.at(parameter.name)) +
              "  # " + (unit.empty() ? "" : "[" + unit + "] ") + parameter.meaning;
    const auto remark = remarks.find(effect.id + "." + parameter.name);
    result += (remark == remarks.end() ? "" : "; " + onOneLine(remark->second)) + "\n";
  }
  std::string taxels, surfaces;
  for (const std::size_t taxel : effect.only_taxels)
    taxels += (taxels.empty() ? "" : ", ") + std::to_string(taxel);
  for (const std::string& surface : effect.only_surfaces)
    surfaces += (surfaces.empty() ? "" : ", ") + settings::quotedText(surface);
  if (!taxels.empty()) result += "    only_taxels: [" + taxels + "]\n";
  if (!surfaces.empty()) result += "    only_surfaces: [" + surfaces + "]\n";
  if (!effect.carried_over)
    result += "    carried_over: false  # its memory begins anew with each mounting\n";
  for (const FaultSpell& spell : effect.spells) {
    result += (&spell == &effect.spells.front() ? "    spells: [" : ",\n             ") +
              std::to_string(spell.taxel) + ", " + settings::numberText(spell.from) + ", " +
              settings::numberText(spell.to) + ", " + settings::numberText(spell.reading);
  }
  const bool line = info.level == EffectLevel::kRow || info.level == EffectLevel::kColumn;
  if (!effect.spells.empty())
    result += line ? "]  # line, from, to [s], share lost\n" : "]  # taxel, from, to [s], reading [counts]\n";
  return result;
}

}  // namespace

std::string simulationText(const SimulationSettings& settings, const std::string& head,
                           const ValueRemarks& remarks) {
  const matrix::Layout& layout = settings.layout;
  const Transducer& transducer = settings.transducer;
  std::string result = commented(head) + "simulation: " + settings::quotedText(settings.name) +
                       "\nseed: " + std::to_string(settings.seed) +
                       "\nstart: " + settings::numberText(settings.start) +
                       "\nmatrix: {rows: " + std::to_string(layout.size.rows) +
                       ", columns: " + std::to_string(layout.size.columns) +
                       ", pitch_x: " + settings::numberText(layout.pitch_x) +
                       ", pitch_y: " + settings::numberText(layout.pitch_y) + "}\n" + text(settings.board) +
                       "chamber: " + protocolText(settings.chamber) + "\nsession:\n";
  for (const Station& station : settings.session) result += text(station);
  result += text(settings.climate) + "transducer: {low: " + settings::numberText(transducer.low) +
            ", high: " + settings::numberText(transducer.high) +
            ", full_counts: " + std::to_string(transducer.full_counts) + "}\neffects:\n";
  for (const EnabledEffect& effect : settings.effects) {
    result += text(effect, libraryOf(settings).info(effect.id), remarks);
  }
  if (!settings.taxel_curves_file.empty()) {
    result += "taxel_curves: " + settings::quotedText(settings.taxel_curves_file) + "\n";
  }
  return result;
}

}  // namespace fsr::simulation
