#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

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

/// The texts `textOf(item)` of the items with `between` between them.
template <typename Items, typename TextOf>
std::string joinedTexts(const Items& items, TextOf textOf, const std::string& between = ", ") {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : between) + std::string(textOf(item));
  return text;
}

/// The items with `between` between them.
template <typename Items>
std::string joined(const Items& items, const std::string& between = ", ") {
  return joinedTexts(
      items, [](const std::string& item) { return item; }, between);
}

/// The shortest decimal text that a YAML or JSON reader converts back to the same number; `.inf` and `.nan`
/// as in YAML.
std::string numberText(double value);

/// A text in double quotes, escaped for YAML.
std::string quotedText(const std::string& text);

}  // namespace fsr::settings
