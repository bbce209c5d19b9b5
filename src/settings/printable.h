#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace fsr::settings {

/// The text with a '?' for each control character but newline and tab. Names come from files and bags of
/// others; an escape sequence in one would move the cursor or set colours on the terminal that shows it.
std::string printable(std::string_view text);

/// What is written to a stream while this exists is printable().
class PrintableOutput : private std::streambuf {
 public:
  explicit PrintableOutput(std::ostream& out);
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;
  ~PrintableOutput() override;

 private:
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int_type overflow(int_type byte) override;
  int sync() override;

  std::ostream& out_;
  std::streambuf* const target_;
};

}  // namespace fsr::settings
