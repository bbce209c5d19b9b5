#include "fsr_pressure_map/simulation/simulation_settings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "fsr_pressure_map/simulation/chamber.h"
#include "matrix/surface_file.h"
#include "simulation/effects/effect_library.h"
#include "simulation/settings_text.h"
#include "simulation/taxel_curves.h"

namespace fsr::simulation {

namespace {

matrix::Layout readLayout(const settings::Settings& settings, matrix::Layout layout) {
  const settings::Range side{1, matrix::kMaxMatrixSide, ""};
  const settings::Range pitch{1e-4, 1, "m"};
  layout.size.rows = static_cast<std::uint16_t>(settings.integer("rows", side, layout.size.rows));
  layout.size.columns = static_cast<std::uint16_t>(settings.integer("columns", side, layout.size.columns));
  layout.pitch_x = settings.number("pitch_x", pitch, layout.pitch_x);
  layout.pitch_y = settings.number("pitch_y", pitch, layout.pitch_y);
  return layout;
}

SimulatedBoard readBoard(const settings::Settings& settings) {
  SimulatedBoard board;
  board.serial = settings.text("serial", board.serial);
  board.firmware = settings.text("firmware", board.firmware);
  board.model = settings.text("model", board.model);
  board.scan_rate = settings.number("scan_rate", {0.01, 10000, "Hz"}, board.scan_rate);
  board.scan_duration = settings.number("scan_duration", {0, 10, "s"}, board.scan_duration);
  board.transducer_rate = settings.number("transducer_rate", {0, 10000, "Hz"}, board.transducer_rate);
  validate(board, settings.origin() + ": board");
  return board;
}

Transducer readTransducer(const settings::Settings& settings) {
  const settings::Range pressure{-110e3, 100e6, "Pa gauge"};
  Transducer transducer;
  transducer.low = settings.number("low", pressure, transducer.low);
  transducer.high = settings.number("high", pressure, transducer.high);
  transducer.full_counts = static_cast<std::int32_t>(
      settings.integer("full_counts", {1, 1 << 24, "counts"}, transducer.full_counts));
  if (transducer.high <= transducer.low) throw settings.error("high", "must be above low");
  return transducer;
}

matrix::Surface surfaceOf(const settings::Settings& settings, matrix::MatrixSize size) {
  if (matrix::hasSurfaceForm(settings)) return matrix::readSurface(settings, size);
  const auto beside = std::filesystem::path(settings.origin()).parent_path() / "../surfaces";
  return matrix::readSurfaceFile((beside / (settings.text("surface") + ".yaml")).lexically_normal(), size);
}

Station readStation(const settings::Settings& settings, const Station& usual, matrix::MatrixSize size) {
  Station station = usual;
  station.surface = surfaceOf(settings, size);
  station.surface.mount = usual.surface.mount;
  station.pause = settings.number("pause", {0, 1e7, "s"}, station.pause);
  if (settings.has("load")) station.load = readLoadPattern(settings.section("load"));
  if (settings.has("program")) station.program = readChamberProgram(settings.sections("program"));
  return station;
}

std::vector<Station> readSession(const settings::Settings& settings, const SimulationSettings& simulation) {
  Station usual{{"flat", 1, {matrix::Curvature{}}, {}}, {}, Station{}.pause, {simulation.chamber}};
  if (settings.has("program")) usual.program = readChamberProgram(settings.sections("program"));
  if (!settings.has("session")) return {usual};
  std::vector<Station> session;
  for (const settings::Settings& station : settings.sections("session")) {
    session.push_back(readStation(station, usual, simulation.layout.size));
    ++usual.surface.mount;
  }
  if (session.empty()) throw settings.error("session", "must contain at least one surface");
  return session;
}

EffectValues readValues(const settings::Settings& settings, const EffectInfo& info) {
  EffectValues values;
  for (const EffectParameter& parameter : info.parameters) {
    values[parameter.name] = settings.number(parameter.name, parameter.permitted, parameter.usual);
  }
  return values;
}

std::vector<FaultSpell> readSpells(const settings::Settings& settings, const EffectInfo& info,
                                   matrix::MatrixSize size) {
  const std::vector<double> numbers = settings.numbers("spells", {-1, kForever, ""});
  const bool line = info.level == EffectLevel::kRow || info.level == EffectLevel::kColumn;
  if (info.kind != EffectKind::kDetector || !(line || info.level == EffectLevel::kTaxel))
    throw settings.error("spells", "only dead_taxel, stuck_taxel, row_fault and column_fault have spells");
  const std::size_t places = info.level == EffectLevel::kRow      ? size.rows
                             : info.level == EffectLevel::kColumn ? size.columns
                                                                  : size.taxels();
  std::vector<FaultSpell> spells;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4)
    spells.push_back({static_cast<std::size_t>(numbers[i]), numbers[i + 1], numbers[i + 2], numbers[i + 3]});
  const bool sound =
      numbers.size() % 4 == 0 && std::all_of(spells.begin(), spells.end(), [&](const FaultSpell& s) {
        return s.taxel < places && s.from <= s.to && (!line || (s.reading >= 0 && s.reading <= 1));
      });
  if (!sound)
    throw settings.error("spells", std::string("must be four numbers for each spell: ") +
                                       (line ? "line, from, to [s], share of the conductance that is lost"
                                             : "taxel, from, to [s], reading [counts]"));
  return spells;
}

EnabledEffect readEffect(const settings::Settings& settings, const EffectInfo& info,
                         matrix::MatrixSize size) {
  EnabledEffect effect{info.id, readValues(settings, info)};
  if (settings.has("only_taxels")) {
    const double last = static_cast<double>(size.taxels()) - 1;
    for (const double taxel : settings.numbers("only_taxels", {0, last, ""}))
      effect.only_taxels.push_back(static_cast<std::size_t>(taxel));
  }
  if (settings.has("spells")) effect.spells = readSpells(settings, info, size);
  if (settings.has("only_surfaces")) effect.only_surfaces = settings.texts("only_surfaces");
  effect.carried_over = settings.flag("carried_over", true);
  return effect;
}

void refuseOtherEffects(const settings::Settings& effects, const EffectLibrary& library) {
  for (const std::string& id : effects.keys()) {
    const EffectEntry* entry = library.find(id);
    if (entry && entry->make) continue;
    if (entry) throw effects.error(id, "it cannot be simulated: a gas chamber cannot show it");
    if (id == "clock_rate") {
      throw effects.error(id, "it is a part of time_skew now; write `time_skew: {delay: 0, rate: ...}`");
    }
    std::string known;
    for (const std::string& other : library.ids()) known += (known.empty() ? "" : ", ") + other;
    throw effects.error(id, "no effect has that name; the effects are " + known);
  }
}

std::vector<EnabledEffect> readEffects(const settings::Settings& effects, const EffectLibrary& library,
                                       matrix::MatrixSize size) {
  refuseOtherEffects(effects, library);
  std::vector<EnabledEffect> enabled;
  for (const EffectEntry& entry : library.entries()) {
    if (effects.has(entry.info.id)) {
      enabled.push_back(readEffect(effects.section(entry.info.id), entry.info, size));
    } else if (entry.info.required) {
      throw effects.error(entry.info.id, "no sensor is without it; write `" + entry.info.id + ": {}`");
    }
  }
  return enabled;
}

void readCurves(const settings::Settings& settings, SimulationSettings& simulation) {
  simulation.taxel_curves_file = settings.text("taxel_curves");
  const auto path = std::filesystem::path(settings.origin()).parent_path() / simulation.taxel_curves_file;
  simulation.taxel_curves = std::make_shared<const TaxelCurves>(readTaxelCurves(path));
}

}  // namespace

void validate(const SimulatedBoard& board, const std::string& origin) {
  if (board.scan_duration <= 1 / board.scan_rate) return;
  std::ostringstream sentence;
  sentence << origin << ".scan_duration is " << board.scan_duration << " s, but at a scan_rate of "
           << board.scan_rate << " Hz must be at most " << 1 / board.scan_rate << " s";
  throw settings::InputError(sentence.str());
}

const EnabledEffect* SimulationSettings::effect(const std::string& id) const {
  const auto found = std::find_if(effects.begin(), effects.end(),
                                  [&](const EnabledEffect& effect) { return effect.id == id; });
  return found == effects.end() ? nullptr : &*found;
}

std::uint16_t SimulationSettings::fullScale() const {
  return static_cast<std::uint16_t>(converterOf(*this).values.at("full_scale"));
}

SimulationSettings readSimulation(const settings::Settings& settings,
                                  std::shared_ptr<const EffectLibrary> library) {
  SimulationSettings simulation;
  simulation.library = std::move(library);
  simulation.origin = settings.origin();
  simulation.name = settings.text("simulation");
  simulation.seed = static_cast<std::uint64_t>(settings.integer("seed", {0, 9e15, ""}, 1));
  if (settings.has("matrix")) simulation.layout = readLayout(settings.section("matrix"), simulation.layout);
  if (settings.has("board")) simulation.board = readBoard(settings.section("board"));
  if (settings.has("chamber")) simulation.chamber = readChamberProtocol(settings.section("chamber"));
  simulation.session = readSession(settings, simulation);
  simulation.start = settings.number("start", {1, 4e9, "s since 1970"}, simulation.start);
  if (settings.has("climate")) simulation.climate = readChamberClimate(settings.section("climate"));
  if (settings.has("transducer")) simulation.transducer = readTransducer(settings.section("transducer"));
  simulation.effects =
      readEffects(settings.section("effects"), libraryOf(simulation), simulation.layout.size);
  if (settings.has("taxel_curves")) readCurves(settings, simulation);
  settings.refuseUnknown();
  return simulation;
}

SimulationSettings readSimulationFile(const std::string& path) {
  return readSimulation(settings::Settings::fromFile(path));
}

namespace {

constexpr int kPointsASide = 16;  // of each cell, to tell how much of it is loaded

bool loaded(const LoadPattern& pattern, double x, double y) {
  const double right = x - pattern.centre.x, up = y - pattern.centre.y;
  if (pattern.kind == LoadPattern::Kind::kDisc) return std::hypot(right, up) <= pattern.radius;
  return right * std::cos(pattern.angle) + up * std::sin(pattern.angle) >= 0;
}

double share(const LoadPattern& pattern, const matrix::Layout& layout, matrix::Position cell) {
  int inside = 0;
  for (int i = 0; i < kPointsASide; ++i) {
    for (int k = 0; k < kPointsASide; ++k) {
      const double x = cell.x + layout.pitch_x * ((i + 0.5) / kPointsASide - 0.5);
      const double y = cell.y + layout.pitch_y * ((k + 0.5) / kPointsASide - 0.5);
      inside += int{loaded(pattern, x, y)};
    }
  }
  return inside / double{kPointsASide * kPointsASide};
}

}  // namespace

LoadPattern readLoadPattern(const settings::Settings& settings) {
  const settings::Range place{-10, 10, "m"};
  LoadPattern pattern;
  const bool disc = settings.has("disc");
  if (disc == settings.has("edge")) {
    throw settings.error(disc ? "edge" : "disc", "give exactly one of disc and edge");
  }
  pattern.kind = disc ? LoadPattern::Kind::kDisc : LoadPattern::Kind::kEdge;
  const settings::Settings form = settings.section(disc ? "disc" : "edge");
  pattern.centre = {form.number("x", place, 0), form.number("y", place, 0)};
  if (disc) {
    pattern.radius = form.number("radius", {1e-4, 10, "m"});
  } else {
    pattern.angle = form.number("angle", {-2 * M_PI, 2 * M_PI, "rad"}, 0);
  }
  return pattern;
}

std::vector<double> loadShares(const LoadPattern& pattern, const matrix::Layout& layout) {
  std::vector<double> shares(layout.size.taxels(), 1.0);
  if (pattern.kind == LoadPattern::Kind::kUniform) return shares;
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = share(pattern, layout, layout.position({i}));
  return shares;
}

}  // namespace fsr::simulation
