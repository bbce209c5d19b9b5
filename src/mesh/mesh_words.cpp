#include "mesh/mesh_words.h"

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::mesh {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";
constexpr std::size_t kShown = 40;  // of a wrong word [bytes]

// The word in quotes, without bytes that a terminal cannot show.
std::string quoted(std::string_view word) {
  std::string text(word.substr(0, kShown));
  std::replace_if(
      text.begin(), text.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return '"' + text + '"';
}

}  // namespace

std::string_view Words::next() {
  text_.remove_prefix(std::min(text_.find_first_not_of(kBlanks), text_.size()));
  const std::string_view word = text_.substr(0, text_.find_first_of(kBlanks));
  text_.remove_prefix(word.size());
  return word;
}

double Words::number() {
  return numberOf(next());
}

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

double numberOf(std::string_view word) {
  if (word.empty()) throw settings::InputError("ends where a number must be; it may have been cut off");
  static const locale_t kPoint = newlocale(LC_ALL_MASK, "C", nullptr);  // a decimal comma is no number
  char* end = nullptr;
  const double value = strtod_l(word.data(), &end, kPoint);
  if (end != word.data() + word.size())
    throw settings::InputError("has " + quoted(word) + " where a number must be");
  return value;
}

}  // namespace fsr::mesh
