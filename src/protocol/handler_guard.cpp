#include "protocol/handler_guard.h"

#include <exception>

namespace fsr::protocol {
namespace {

// Of the exception that is being handled.
std::string reason() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown exception";
  }
}

}  // namespace

void HandlerGuard::onScan(const PacketHeader& header, const ScanPacket& scan) {
  run("handling a scan", [&] { handler_.onScan(header, scan); });
}

void HandlerGuard::onTransducer(const PacketHeader& header, std::int32_t counts) {
  run("handling a transducer reading", [&] { handler_.onTransducer(header, counts); });
}

void HandlerGuard::onTemperature(const PacketHeader& header, std::int32_t millidegrees) {
  run("handling a temperature", [&] { handler_.onTemperature(header, millidegrees); });
}

void HandlerGuard::onIdentity(const PacketHeader& header, const IdentityPacket& identity) {
  run("handling an identity", [&] { handler_.onIdentity(header, identity); });
}

void HandlerGuard::note(const char* task) {
  ++faults_;
  complaint_ = std::string(task) + " failed in this program, not on the link: " + reason();
}

}  // namespace fsr::protocol
