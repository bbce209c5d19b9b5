#include "emulator/board.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fsr_pressure_map/protocol/wire.h"

namespace fsr::emulator {

namespace {

constexpr double kMicro = 1e-6;

std::uint32_t microseconds(double seconds) {
  return static_cast<std::uint32_t>(std::lround(seconds / kMicro));
}

double period(double rate) {
  return rate > 0 ? 1 / rate : 0;
}

}  // namespace

double Board::Source::due() const {
  return period > 0 ? time() + delay : std::numeric_limits<double>::infinity();
}

Board::Board(const simulation::SimulationSettings& simulation, const BoardClock& clock)
    : settings_(simulation), clock_(clock), rig_(simulation), packet_(FSR_WIRE_MAX_PACKET) {
  sources_[kIdentity].period = 1;
  sources_[kTemperature].period = 1;
  sources_[kTransducer].period = period(simulation.board.transducer_rate);
  sources_[kScan].period = period(simulation.board.scan_rate);
  // The stamp of a scan is its middle; it is sent at its end.
  sources_[kScan].delay = simulation.board.scan_duration / 2;
}

Board::Kind Board::nextKind() const {
  const auto earlier = [](const Source& a, const Source& b) { return a.due() < b.due(); };
  return static_cast<Kind>(std::min_element(sources_.begin(), sources_.end(), earlier) - sources_.begin());
}

double Board::nextDue() const {
  return sources_[nextKind()].due();
}

std::vector<std::uint8_t>& Board::next(const Pressure& pressure) {
  const Kind kind = nextKind();
  packet_.resize(FSR_WIRE_MAX_PACKET);
  packet_.resize(encode(kind, sources_[kind].time(), pressure));
  ++sources_[kind].number;
  ++sources_[kind].sequence;
  if (kind == kTrigger) sources_[kind].period = 0;  // until the next edge
  return packet_;
}

std::size_t Board::encode(Kind kind, double time, const Pressure& pressure) {
  const std::uint32_t sequence = sources_[kind].sequence;
  const auto device_time = static_cast<std::uint32_t>(deviceTime(time));
  switch (kind) {
    case kScan:
      return encodeScan(sequence, time, pressure);
    case kTransducer:
      return fsr_wire_encode_transducer(
          packet_.data(), packet_.size(), sequence, device_time,
          transducer_ == TransducerLine::kUnplugged ? 0 : rig_.transducer(time, pressure));
    case kTrigger:
      return fsr_wire_encode_trigger(packet_.data(), packet_.size(), sequence, device_time,
                                     trigger_high_ ? 1 : 0, 1);  // the clock counts us
    case kTemperature:
      return fsr_wire_encode_temperature(
          packet_.data(), packet_.size(), sequence, device_time,
          static_cast<std::int32_t>(std::lround(1000 * rig_.temperature(time, pressure))));
    default:
      return encodeIdentity(sequence, device_time);
  }
}

std::size_t Board::encodeScan(std::uint32_t sequence, double time, const Pressure& pressure) {
  fsr_wire_scan scan{};
  scan.rows = static_cast<std::uint8_t>(settings_.layout.size.rows);
  scan.columns = static_cast<std::uint8_t>(settings_.layout.size.columns);
  scan.full_scale = rig_.chain().fullScale();
  scan.duration_us = microseconds(settings_.board.scan_duration);
  counts_ = rig_.scan(time, pressure);
  for (const std::size_t taxel : lost_taxels_) counts_[taxel] = 0;
  scan.counts = counts_.data();
  return fsr_wire_encode_scan(packet_.data(), packet_.size(), sequence,
                              static_cast<std::uint32_t>(deviceTime(time)), &scan);
}

std::size_t Board::encodeIdentity(std::uint32_t sequence, std::uint32_t device_time) {
  fsr_wire_identity identity{};
  identity.serial = settings_.board.serial.c_str();
  identity.firmware = settings_.board.firmware.c_str();
  identity.model = settings_.board.model.c_str();
  identity.rows = static_cast<std::uint8_t>(settings_.layout.size.rows);
  identity.columns = static_cast<std::uint8_t>(settings_.layout.size.columns);
  identity.full_scale = rig_.chain().fullScale();
  identity.scan_period_us = microseconds(sources_[kScan].period);
  return fsr_wire_encode_identity(packet_.data(), packet_.size(), sequence, device_time, &identity);
}

void Board::loseTaxel(std::size_t taxel) {
  if (taxel < settings_.layout.size.taxels()) lost_taxels_.push_back(taxel);
}

void Board::setTransducer(TransducerLine line, double time) {
  transducer_ = line;
  Source& source = sources_[kTransducer];
  const double interval = period(settings_.board.transducer_rate);
  source.period = line == TransducerLine::kSilent ? 0 : interval;
  if (source.period == 0) return;
  // The readings that were left out are not sent late.
  const auto missed = std::ceil((time - source.start) / interval);
  source.number = std::max(source.number, static_cast<std::uint64_t>(std::max(missed, 0.0)));
}

void Board::setTrigger(bool high, double time) {
  trigger_high_ = high;
  Source& source = sources_[kTrigger];
  source.start = time;
  source.number = 0;
  source.period = 1;
}

void Board::reset(double time) {
  switched_on_ = time;
  for (Source& source : sources_) source.sequence = 0;
  sources_[kIdentity].start = time;  // it sends its identity as soon as it is on
  sources_[kIdentity].number = 0;
}

void Board::jumpClock(double seconds) {
  clock_.offset += static_cast<std::uint32_t>(std::llround(seconds / kMicro));  // wraps as the board's does
}

std::uint64_t Board::deviceTime(double time) const {
  const double elapsed = std::max(time - switched_on_, 0.0) * (1 + clock_.drift * kMicro);
  return clock_.offset + static_cast<std::uint64_t>(std::llround(elapsed / kMicro));
}

double Board::rigTime(std::uint64_t device_time) const {
  const double shown = (static_cast<double>(device_time) - clock_.offset) * kMicro;
  return switched_on_ + shown / (1 + clock_.drift * kMicro);
}

double Board::bitsPerSecond() const {
  constexpr double kBitsPerByte = 10;  // with start and stop bit
  const auto rate = [this](Kind kind) { return sources_[kind].period > 0 ? 1 / sources_[kind].period : 0.0; };
  const auto& size = settings_.layout.size;
  const auto packet = [](std::size_t payload) { return static_cast<double>(FSR_WIRE_OVERHEAD + payload); };
  return kBitsPerByte * (rate(kScan) * packet(FSR_WIRE_SCAN_PAYLOAD(size.rows, size.columns)) +
                         rate(kTransducer) * packet(FSR_WIRE_TRANSDUCER_PAYLOAD) +
                         rate(kTemperature) * packet(FSR_WIRE_TEMPERATURE_PAYLOAD) +
                         rate(kIdentity) * packet(FSR_WIRE_IDENTITY_PAYLOAD));
}

}  // namespace fsr::emulator
