#include "fsr_pressure_map/protocol/decoder.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "protocol/text_decoder.h"
#include "protocol/wire_decoder.h"
#include "settings/text.h"

namespace fsr::protocol {
namespace {

std::unique_ptr<Decoder> makeWire(PacketHandler& handler, const DecoderOptions& /*options*/) {
  return std::make_unique<WireDecoder>(handler);
}

std::unique_ptr<Decoder> makeText(PacketHandler& handler, const DecoderOptions& options) {
  return std::make_unique<TextDecoder>(handler, options);
}

}  // namespace

const std::vector<Protocol>& protocols() {
  static const std::vector<Protocol> all = {
      {"wire", "binary packets with checks, docs/wire_format.md", makeWire, true},
      {"text", "lines time,count,count,... of a sketch, docs/text_format.md", makeText, false},
  };
  return all;
}

const Protocol& protocolNamed(const std::string& name) {
  for (const Protocol& protocol : protocols()) {
    if (protocol.name == name) return protocol;
  }
  throw settings::InputError(
      "there is no protocol " + name + ": set one of " +
      settings::joinedTexts(protocols(), [](const Protocol& protocol) { return protocol.name; }));
}

}  // namespace fsr::protocol
