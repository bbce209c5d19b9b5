#include "blind/blind_case.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "blind/rig.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {

namespace {

// Realistic noise of a sheet and its read-out [share of full scale].
constexpr double kLeastNoise = 6e-4, kMostNoise = 12e-3;
// A residual below this after the static fit is the error of the fit: the effect does not show.
constexpr double kShows = 2e-4;
// Largest strength of a hidden effect in a case with a name; more would be another sensor.
constexpr double kLargestStrength = 10;
// Readings of a case with a name stay below this share of full scale: a clipped reading is a saturation.
constexpr double kRail = 0.985;
constexpr std::int64_t kEpoch = 1717401600000000000;  // 2024-06-03 08:00:00 UTC [ns]

std::size_t stride(const Campaign& campaign) {
  return 1 + campaign.taxels() / 15;
}

const HiddenForm& formFor(const EffectSpec& effect, std::uint64_t seed) {
  if (!effect.form.empty()) return findForm(effect.id, effect.form);
  const std::vector<const HiddenForm*> forms = openFormsOf(effect.id);
  if (forms.empty()) return findForm(effect.id, "");  // throws, with a list of all forms
  return *forms[Random(seed, "form of " + effect.id).below(forms.size())];
}

// A rectangle of taxels; each side is at least a quarter and at most half of the matrix.
std::vector<bool> corner(const fsr::matrix::Layout& layout, Random& random) {
  const auto side = [&](std::size_t length) {
    const double share = random.uniform(0.35, 0.6);
    return std::max<std::size_t>(1,
                                 static_cast<std::size_t>(std::lround(share * static_cast<double>(length))));
  };
  const std::size_t rows = side(layout.size.rows), columns = side(layout.size.columns);
  const std::size_t top = random.below(layout.size.rows - rows + 1);
  const std::size_t left = random.below(layout.size.columns - columns + 1);
  std::vector<bool> inside;
  for (std::size_t i = 0; i < layout.size.taxels(); ++i) {
    const std::size_t row = layout.row({i}), column = layout.column({i});
    inside.push_back(row >= top && row < top + rows && column >= left && column < left + columns);
  }
  return inside;
}

// Half of the effects that can be limited are limited to a corner of the sheet or to the bent surfaces.
Placed place(const EffectSpec& effect, const CaseSpec& spec, const Campaign& campaign) {
  Placed placed;
  placed.form = &formFor(effect, spec.seed);
  placed.seed = spec.seed;
  placed.taxels.assign(campaign.taxels(), true);
  placed.surfaces.assign(campaign.surfaces.size(), true);
  Random random(spec.seed, "place of " + effect.id);
  placed.carried_over = random.chance(0.5);
  const double where = random.uniform();
  if (!placed.form->may_be_local || !spec.local) return placed;
  if (where < 0.25) placed.taxels = corner(campaign.layout, random);
  if (where > 0.75) placed.surfaces[0] = placed.surfaces.size() == 1;
  return placed;
}

void requireSense(const CaseSpec& spec) {
  if (!spec.name.empty()) {
    for (const EffectSpec& effect : spec.effects) formFor(effect, spec.seed);
    if (spec.kpa && !(*spec.kpa > 0)) throw fsr::settings::InputError("kpa: must be more than 0");
    if (!(spec.snr >= 0)) throw fsr::settings::InputError("snr: must be 0 or more");
    return;
  }
  if (spec.matrix.rows == 0 || spec.matrix.columns == 0)
    throw fsr::settings::InputError("matrix: must have taxels");
  if (spec.size.surfaces < 1 || spec.size.surfaces > 6)
    throw fsr::settings::InputError("surfaces: must be 1 to 6");
  if (!(spec.snr >= 0)) throw fsr::settings::InputError("snr: must be 0 or more");
  for (const EffectSpec& effect : spec.effects) {
    const HiddenForm& form = formFor(effect, spec.seed);
    if (form.needs_remounts && !remounts(spec.protocol)) {
      throw fsr::settings::InputError(
          "effect " + form.id + " does not show under protocol " + spec.protocol +
          ", which mounts every surface once; take paper_remounted or random_order");
    }
  }
}

HiddenTruth truthOf(const Active& active, double strength, const Rig& rig, const Campaign& campaign) {
  const HiddenForm& form = *active.placed->form;
  const Signature left = rig.signature(active, 1);
  const bool is_static = form.left_after == LeftAfter::kCurveShared;
  const Signature where = is_static ? rig.difference(active) : left;
  HiddenTruth truth;
  truth.id = form.id;
  truth.form = form.form;
  truth.set = form.set;
  truth.foreign = form.foreign;
  truth.has_state = form.has_state;
  truth.carried_over = active.placed->carried_over;
  truth.strength = strength;
  truth.left = left.rms();
  truth.left_after = form.left_after;
  truth.parameters = active.hidden->parameters();
  for (HiddenParameter& parameter : truth.parameters) {
    if (parameter.unit.rfind("Pa", 0) == 0) parameter.value *= campaign.pascal;
  }
  truth.kpa_at_map = 1e-3 * rig.errorAtMap(active, stride(campaign));
  truth.depends_on = form.depends_on;
  truth.taxels = where.taxels();
  truth.surfaces = where.surfaces();
  truth.pressures = {campaign.pascal * where.pressures().first, campaign.pascal * where.pressures().second};
  truth.direction = where.direction();
  for (const auto& [from, to] : active.hidden->times()) {
    truth.times.emplace_back(from - campaign.time.front(), to - campaign.time.front());
  }
  return truth;
}

std::vector<std::string> protocolsOf(const CaseSpec& spec) {
  if (spec.then.empty()) return {spec.protocol};
  return {spec.protocol, spec.then};
}

std::optional<RigPlan> planOf(const CaseSpec& spec) {
  if (spec.name.empty()) return {};
  if (spec.plan) return spec.plan;
  return drawPlan(spec.seed, spec.protocol_class, spec.most_readings);
}

Campaign campaignOf(const CaseSpec& spec, const std::optional<RigPlan>& plan) {
  if (plan) return runCampaign(*plan, spec.seed);
  return runCampaign({spec.matrix, 0.010, 0.010}, protocolsOf(spec), spec.size, spec.seed);
}

// Generates one case step by step; each step needs the ones before it.
class Maker {
 public:
  explicit Maker(const CaseSpec& spec)
      : plan_(planOf(spec)),
        campaign_(campaignOf(spec, plan_)),
        sheet_(campaign_, spec.seed, plan_ ? Laws::kAll : Laws::kFirst),
        rig_(campaign_, sheet_),
        noise_(campaign_, spec.seed, plan_ ? 0.6 : 0.3),
        reference_(spec.seed) {
    made_.spec = spec;
    made_.plan = plan_;
    if (!plan_) return;
    made_.full_scale = static_cast<std::uint16_t>((1 << plan_->bits) - 1);
    channel_.emplace(*plan_, campaign_, spec.seed);
    made_.reference_noise = referenceNoise();
  }

  BlindCase make() {
    if (made_.spec.snr > 0 || made_.spec.kpa) {
      for (const EffectSpec& effect : made_.spec.effects)
        placed_.push_back(place(effect, made_.spec, campaign_));
    }
    hide();
    readOut();
    describe();
    return std::move(made_);
  }

 private:
  void hide();
  void hideInPlan();
  double leastNoise() const;
  double belowTheRail(const Placed& placed, double strength) const;
  void cutIntoBags(const std::vector<std::vector<std::uint16_t>>& counts);
  CaseBag bagOf(const std::vector<std::pair<std::size_t, std::size_t>>& pieces,
                const std::vector<std::vector<std::uint16_t>>& counts, const std::vector<bool>& lost);
  void judge(std::vector<Trace> noise, double scale);
  double wantedNoise(const std::vector<double>& usual) const;
  void readOut();
  double referenceNoise() const;
  double scaleOfNoise(const std::vector<Trace>& noise) const;
  std::vector<std::vector<std::uint16_t>> convert(const std::vector<Trace>& noise, double scale);
  void record(const std::vector<std::vector<std::uint16_t>>& counts);
  void describe();

  BlindCase made_;
  std::optional<RigPlan> plan_;
  Campaign campaign_;
  Sheet sheet_;
  Rig rig_;
  Noise noise_;
  ReferenceError reference_;
  std::optional<ReferenceChannel> channel_;
  std::vector<Placed> placed_;
  std::vector<Active> active_;
  double noise_wanted_ = 0;  // [share of full scale]
};

// Effects have their usual size and the noise is scaled to match. Where that noise would be unrealistic, the
// size of the effects is changed instead.
double Maker::wantedNoise(const std::vector<double>& usual) const {
  if (made_.spec.noise) return *made_.spec.noise;
  if (usual.empty()) return Random(made_.spec.seed, "noise level").logUniform(1e-3, kMostNoise);
  const double smallest = *std::min_element(usual.begin(), usual.end());
  return std::clamp(smallest / made_.spec.snr, kLeastNoise, kMostNoise);
}

double Maker::leastNoise() const {
  const double step = 1.0 / made_.full_scale;
  return std::max(kLeastNoise,
                  1.5 * std::sqrt(step * step / 12 + made_.reference_noise * made_.reference_noise));
}

// The strength, or the largest one at which no reading is clipped.
double Maker::belowTheRail(const Placed& placed, double strength) const {
  for (int round = 0; round < 20; ++round) {
    const Active active = rig_.activate(placed, strength);
    double highest = 0;
    for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += stride(campaign_)) {
      const Trace reading = rig_.reading(taxel, {active});
      highest = std::max(highest, *std::max_element(reading.begin(), reading.end()));
    }
    if (highest < kRail) break;
    strength *= 0.8;
  }
  return strength;
}

// Nothing is refused here: the protocol must not depend on what is hidden. An effect that does not show has
// its usual strength, and the key says so.
void Maker::hideInPlan() {
  const double least = leastNoise(), most = std::max(kMostNoise, 2 * least);
  noise_wanted_ = made_.spec.noise
                      ? *made_.spec.noise
                      : Random(made_.spec.seed, "noise level").logUniform(std::max(1e-3, least), most);
  std::vector<double> usual;
  for (const Placed& placed : placed_) {
    usual.push_back(rig_.signature(rig_.activate(placed, 1), stride(campaign_)).rms());
  }
  const double smallest = usual.empty() ? 0 : *std::min_element(usual.begin(), usual.end());
  const bool by_snr = !made_.spec.kpa && smallest >= kShows && !made_.spec.noise;
  if (by_snr) noise_wanted_ = std::clamp(smallest / made_.spec.snr, least, most);
  double log_left = 0, number = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const auto given = made_.spec.effects[i].strength;
    double strength = given ? *given : 1.0;
    if (!given && usual[i] >= kShows) {
      strength = made_.spec.kpa
                     ? rig_.strengthForError(placed_[i], 1e3 * *made_.spec.kpa, kLargestStrength)
                     : rig_.strengthFor(placed_[i], made_.spec.snr * noise_wanted_, kLargestStrength);
    }
    strength = belowTheRail(placed_[i], strength);
    active_.push_back(rig_.activate(placed_[i], strength));
    made_.hidden.push_back(truthOf(active_[i], strength, rig_, campaign_));
    const HiddenTruth& truth = made_.hidden.back();
    if (truth.left >= kShows) {
      log_left += std::log(truth.left);
      number += 1;
    }
  }
  // The noise follows what is really left, within what a sheet and its read-out may have.
  if (by_snr && number > 0) {
    noise_wanted_ = std::clamp(std::exp(log_left / number) / made_.spec.snr, least, most);
  }
}

void Maker::hide() {
  if (plan_) {
    hideInPlan();
    return;
  }
  std::vector<double> usual;
  for (const Placed& placed : placed_) {
    usual.push_back(rig_.signature(rig_.activate(placed, 1), stride(campaign_)).rms());
    if (usual.back() < kShows) {
      throw fsr::settings::InputError("effect " + placed.form->id + ":" + placed.form->form +
                                      " does not show under protocol " + made_.spec.protocol +
                                      "; take another one");
    }
  }
  noise_wanted_ = wantedNoise(usual);
  double log_left = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const auto given = made_.spec.effects[i].strength;
    const double strength = given ? *given : rig_.strengthFor(placed_[i], made_.spec.snr * noise_wanted_);
    active_.push_back(rig_.activate(placed_[i], strength));
    made_.hidden.push_back(truthOf(active_[i], strength, rig_, campaign_));
    log_left += std::log(std::max(1e-9, made_.hidden.back().left));
  }
  // The noise is scaled to what is really left, so the ratio holds by construction.
  if (!placed_.empty() && !made_.spec.noise) {
    noise_wanted_ = std::exp(log_left / static_cast<double>(placed_.size())) / made_.spec.snr;
  }
}

// The reference's noise as it appears in the readings after a fit against the reference.
double Maker::referenceNoise() const {
  if (plan_) {
    double squares = 0, number = 0;
    for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += stride(campaign_)) {
      const Trace slope = rig_.slope(taxel);
      for (std::size_t scan = 0; scan < campaign_.scans(); ++scan) {
        squares += std::pow(slope[scan] * channel_->error()[scan], 2);
        number += 1;
      }
    }
    return std::sqrt(squares / number);
  }
  Random random(made_.spec.seed, "reference noise seen");
  double squares = 0, number = 0;
  for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += stride(campaign_)) {
    for (std::size_t scan = 0; scan < campaign_.scans(); scan += 7) {
      const std::size_t surface = campaign_.visits[campaign_.visit[scan]].surface;
      const double pressure = campaign_.pressure[scan], preload = sheet_.preload(taxel, surface);
      const double off = reference_.measured(pressure, random) - pressure - reference_.systematic(pressure);
      const double rise =
          sheet_.rise(taxel, pressure + off + preload) - sheet_.rise(taxel, pressure + preload);
      squares += std::pow(sheet_.gain(taxel, surface) * rise, 2);
      number += 1;
    }
  }
  return std::sqrt(squares / number);
}

double Maker::scaleOfNoise(const std::vector<Trace>& noise) const {
  double squares = 0;
  for (const Trace& trace : noise)
    squares += std::inner_product(trace.begin(), trace.end(), trace.begin(), 0.0);
  const double variance = squares / static_cast<double>(noise.size() * campaign_.scans());
  const double rounding = 1.0 / 12 / (1.0 * made_.full_scale * made_.full_scale);
  const double wanted =
      noise_wanted_ * noise_wanted_ - rounding - made_.reference_noise * made_.reference_noise;
  if (wanted <= 0) {
    throw fsr::settings::InputError(
        "snr: " + std::to_string(made_.spec.snr) +
        " cannot be reached, the converter's step alone is more noise; take a smaller one");
  }
  return std::sqrt(wanted / variance);
}

std::vector<std::vector<std::uint16_t>> Maker::convert(const std::vector<Trace>& noise, double scale) {
  std::vector<std::vector<std::uint16_t>> counts(noise.size());
  double squares = 0;
  for (std::size_t taxel = 0; taxel < noise.size(); ++taxel) {
    for (std::size_t scan = 0; scan < campaign_.scans(); ++scan) {
      const double clean = made_.clean[taxel][scan];
      const double reading = std::round(made_.full_scale * (clean + scale * noise[taxel][scan]));
      const double count = std::clamp(reading, 0.0, 1.0 * made_.full_scale);
      counts[taxel].push_back(static_cast<std::uint16_t>(count));
      squares += std::pow(count / made_.full_scale - clean, 2);
    }
  }
  const double electric = squares / static_cast<double>(noise.size() * campaign_.scans());
  made_.noise = std::sqrt(electric + made_.reference_noise * made_.reference_noise);
  return counts;
}

void Maker::readOut() {
  std::vector<Trace> noise;
  for (std::size_t taxel = 0; taxel < campaign_.taxels(); ++taxel) {
    made_.base.push_back(rig_.reading(taxel, {}));
    made_.clean.push_back(active_.empty() ? made_.base.back() : rig_.reading(taxel, active_));
    noise.push_back(noise_.ofTaxel(taxel, made_.clean.back()));
    const Trace factor = rig_.noiseFactor(taxel, active_);
    for (std::size_t scan = 0; scan < factor.size(); ++scan) noise.back()[scan] *= factor[scan];
  }
  made_.reference_noise = referenceNoise();
  const double scale = scaleOfNoise(noise);
  const auto counts = convert(noise, scale);
  if (plan_) {
    cutIntoBags(counts);
    made_.cycle_gain = 2 * scale * noise_.cycleGain();
    if (made_.spec.judged) judge(std::move(noise), scale);
  } else {
    record(counts);
  }
}

void Maker::record(const std::vector<std::vector<std::uint16_t>>& counts) {
  Random random(made_.spec.seed, "reference noise " + made_.spec.protocol + made_.spec.then);
  std::uint32_t mount = 0;
  for (const Visit& visit : campaign_.visits) {
    fsr::dataset::Recording recording;
    fsr::matrix::Surface surface = campaign_.surfaces[visit.surface];
    surface.mount = ++mount;
    if (!made_.spec.then.empty() && mount <= campaign_.first_visits) continue;
    recording.name = std::to_string(mount) + "_" + surface.name + ".bag";
    recording.sensor = {"blind_matrix", "BLIND-1", "1.0", "printed matrix", "pdms", "transducer 0.1 %"};
    recording.layout = campaign_.layout;
    recording.full_scale = made_.full_scale;
    recording.conditions = {surface};
    recording.start_ns = kEpoch + std::llround(visit.start * 1e9);
    for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
      recording.time.push_back(campaign_.time[scan] - visit.start);
      recording.pressure.push_back(reference_.measured(campaign_.pressure[scan], random));
      if (made_.spec.thermometer) recording.temperature.push_back(campaign_.thermometer[scan]);
      for (const auto& taxel : counts) recording.counts.push_back(taxel[scan]);
    }
    recording.condition.assign(recording.scans(), 0);
    made_.recordings.push_back(std::move(recording));
  }
}

// Random runs of scans that never reach the bag.
std::vector<bool> lostScans(const CutPlan& cut, std::size_t scans, std::uint64_t seed) {
  std::vector<bool> lost(scans, false);
  if (cut.lost <= 0) return lost;
  Random random(seed, "lost scans");
  const double runs = cut.lost * static_cast<double>(scans) / (0.5 + 0.5 * static_cast<double>(cut.longest));
  for (std::size_t run = 0; run < static_cast<std::size_t>(std::ceil(runs)); ++run) {
    const std::size_t first = random.below(scans), length = 1 + random.below(cut.longest);
    for (std::size_t scan = first; scan < std::min(scans, first + length); ++scan) lost[scan] = true;
  }
  return lost;
}

CaseBag Maker::bagOf(const std::vector<std::pair<std::size_t, std::size_t>>& pieces,
                     const std::vector<std::vector<std::uint16_t>>& counts, const std::vector<bool>& lost) {
  CaseBag bag;
  fsr::dataset::Recording& recording = bag.recording;
  recording.sensor = {"blind_matrix", "BLIND-1", "1.0", "printed matrix", "", ""};
  recording.layout = campaign_.layout;
  recording.full_scale = made_.full_scale;
  const auto stamp = [](double time) { return kEpoch + std::llround(time * 1e9); };
  for (const auto& [first, last] : pieces) {
    const std::uint32_t v = campaign_.visit[first];
    const Visit& visit = campaign_.visits[v];
    fsr::matrix::Surface surface = campaign_.surfaces[visit.surface];
    surface.mount = v + 1;
    recording.conditions.push_back(surface);
    for (std::size_t scan = first; scan < last; ++scan) {
      if (lost[scan]) continue;
      const double time = campaign_.time[scan];
      if (recording.time.empty()) recording.start_ns = stamp(time);
      recording.time.push_back(static_cast<double>(stamp(time) - recording.start_ns) * 1e-9);
      recording.pressure.push_back(channel_->atScans()[scan]);
      if (plan_->thermometer) recording.temperature.push_back(campaign_.thermometer[scan]);
      recording.condition.push_back(static_cast<std::uint32_t>(recording.conditions.size() - 1));
      for (const auto& taxel : counts) recording.counts.push_back(taxel[scan]);
      bag.sequence.push_back(static_cast<std::uint32_t>(scan));
    }
    // The recorders start and stop with the bag: one more sample on either side of the piece.
    const double from = campaign_.time[first] - 1.3 / plan_->reference.rate;
    const double to = campaign_.time[last - 1] + 1.3 / plan_->reference.rate;
    for (const Sample& sample : channel_->samples(v)) {
      if (sample.time >= from && sample.time <= to)
        bag.reference.emplace_back(stamp(sample.time), sample.value);
    }
    const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(plan_->scan_rate)));
    for (std::size_t scan = first; plan_->thermometer && scan < last; scan += step) {
      bag.thermometer.emplace_back(stamp(campaign_.time[scan]), campaign_.thermometer[scan]);
    }
  }
  const bool one = recording.conditions.size() == 1;
  recording.name = std::to_string(made_.bags.size() + 1) + "_" +
                   (one ? recording.conditions[0].name : std::string("session")) + ".bag";
  return bag;
}

void Maker::cutIntoBags(const std::vector<std::vector<std::uint16_t>>& counts) {
  Random random(made_.spec.seed, "bags");
  const std::vector<bool> lost = lostScans(plan_->cut, campaign_.scans(), made_.spec.seed);
  made_.lost_scans = static_cast<std::size_t>(std::count(lost.begin(), lost.end(), true));
  using Pieces = std::vector<std::pair<std::size_t, std::size_t>>;
  std::vector<Pieces> bags;
  for (const Visit& visit : campaign_.visits) {
    const bool joins = plan_->cut.kind == "joined" && !bags.empty() && random.chance(0.7);
    const bool splits =
        plan_->cut.kind == "odd_places" && visit.last - visit.first > 400 && random.chance(0.6);
    if (!joins) bags.emplace_back();
    if (!splits) {
      bags.back().emplace_back(visit.first, visit.last);
      continue;
    }
    const double share = random.uniform(0.15, 0.85);
    const auto length = static_cast<double>(visit.last - visit.first);
    const std::size_t cut = visit.first + static_cast<std::size_t>(share * length);
    bags.back().emplace_back(visit.first, cut);
    bags.push_back({{cut, visit.last}});
  }
  for (const Pieces& pieces : bags) made_.bags.push_back(bagOf(pieces, counts, lost));
}

void Maker::judge(std::vector<Trace> noise, double scale) {
  for (std::size_t taxel = 0; taxel < noise.size(); ++taxel) {
    for (std::size_t scan = 0; scan < campaign_.scans(); ++scan) {
      double& value = noise[taxel][scan];
      value = scale * (value - noise_.cycleGainAt(scan, made_.clean[taxel][scan]));
    }
  }
  const double left =
      made_.hidden.empty() ? made_.noise : std::max(made_.hidden.front().left, 0.25 * made_.noise);
  std::vector<double> strengths;
  for (const HiddenTruth& truth : made_.hidden) strengths.push_back(truth.strength);
  made_.identifiable = identify({campaign_, sheet_, rig_, *plan_, made_.spec.seed, active_, strengths, noise,
                                 channel_->error(), made_.cycle_gain, left});
}

void Maker::describe() {
  for (HiddenTruth& truth : made_.hidden) {
    truth.snr = truth.left / made_.noise;
    if (!plan_) continue;
    const double size = made_.spec.kpa ? truth.kpa_at_map / *made_.spec.kpa : truth.snr / made_.spec.snr;
    truth.size_reached = std::abs(size - 1) < 0.05;
  }
  made_.static_law = sheet_.staticLaw();
  made_.preload_law = sheet_.preloadLaw();
  made_.gain_law = sheet_.gainLaw();
  made_.noise_colour = noise_.colour();
  made_.campaign = campaign_;
}

}  // namespace

void makeSmall(CaseSpec& spec) {
  spec.matrix = {3, 4};
  spec.size = {3, 0.5};
}

BlindCase makeCase(const CaseSpec& spec) {
  CaseSpec seeded = spec;
  if (!spec.name.empty()) seeded.seed = hashOf(spec.name);
  requireSense(seeded);
  return Maker(seeded).make();
}

}  // namespace blind
