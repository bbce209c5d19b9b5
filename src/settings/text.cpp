#include "settings/text.h"

#include <charconv>
#include <cmath>

namespace fsr::settings {

namespace {

bool isControl(unsigned char byte) {
  return (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f;
}

// Terminals also obey U+0080 to U+009F, e.g. U+009B for ESC [. In UTF-8 they are C2 80 to C2 9F.
bool isLateControl(std::string_view text) {
  return text.size() > 1 && text[0] == '\xC2' && (static_cast<unsigned char>(text[1]) & 0xE0) == 0x80;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (; !text.empty(); text.remove_prefix(1)) {
    const bool late = isLateControl(text);
    result += late || isControl(static_cast<unsigned char>(text.front())) ? '?' : text.front();
    if (late) text.remove_prefix(1);
  }
  return result;
}

PrintableOutput::PrintableOutput(std::ostream& out) : out_(out), target_(out.rdbuf(this)) {}

PrintableOutput::~PrintableOutput() {
  out_.rdbuf(target_);
}

// A name is written by one call, so that no character is cut.
std::streamsize PrintableOutput::xsputn(const char* text, std::streamsize size) {
  const std::string clean = printable({text, static_cast<std::size_t>(size)});
  const auto length = static_cast<std::streamsize>(clean.size());
  return target_->sputn(clean.data(), length) == length ? size : 0;
}

PrintableOutput::int_type PrintableOutput::overflow(int_type byte) {
  if (traits_type::eq_int_type(byte, traits_type::eof())) return traits_type::not_eof(byte);
  const char one = traits_type::to_char_type(byte);
  return xsputn(&one, 1) == 1 ? byte : traits_type::eof();
}

int PrintableOutput::sync() {
  return target_->pubsync();
}

std::string numberText(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
  const double size = std::abs(value);
  const bool plain = value == 0 || (size >= 1e-5 && size < 1e12);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, format).ptr;
  return {text, end};
}

std::string quotedText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return '"' + result + '"';
}

}  // namespace fsr::settings
