#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"

namespace test_support {

/// Keeps the packets of a decoder as text, one line for each packet, so that tests compare lists of lines.
class PacketRecorder : public fsr::protocol::PacketHandler {
 public:
  std::vector<std::string> lines;

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    std::ostringstream text;
    text << scan.size.rows << "x" << scan.size.columns << " full " << scan.full_scale << " took "
         << scan.duration << " counts";
    for (std::size_t i = 0; i < scan.size.taxels(); ++i) text << ' ' << scan.counts[i];
    add("scan", header, text.str());
  }
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override {
    add("transducer", header, std::to_string(counts));
  }
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t millidegrees) override {
    add("temperature", header, std::to_string(millidegrees));
  }
  void onIdentity(const fsr::protocol::PacketHeader& header,
                  const fsr::protocol::IdentityPacket& identity) override {
    std::ostringstream text;
    text << identity.serial << '/' << identity.firmware << '/' << identity.model << ' ' << identity.size.rows
         << "x" << identity.size.columns << " full " << identity.full_scale << " every "
         << identity.scan_period;
    add("identity", header, text.str());
  }
  void onTrigger(const fsr::protocol::PacketHeader& header,
                 const fsr::protocol::TriggerPacket& trigger) override {
    add("trigger", header,
        std::string(trigger.high ? "rising" : "falling") + " +- " + std::to_string(trigger.deviation));
  }

 private:
  void add(const std::string& type, const fsr::protocol::PacketHeader& header, const std::string& content) {
    lines.push_back(type + " #" + std::to_string(header.sequence) + " @" +
                    std::to_string(header.device_time) + " " + content);
  }
};

}  // namespace test_support
