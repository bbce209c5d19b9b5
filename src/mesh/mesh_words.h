#pragma once

#include <string_view>

#include "mesh/mesh.h"

namespace fsr::mesh {

/// The words of a text, divided by blanks and ends of lines. The text is part of a std::string, so that a
/// null or a blank follows each word.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next();
  /// Throws InputError where the next word is no number. It may be nan or inf.
  double number();
  Point point() {
    const double x = number(), y = number();
    return {x, y, number()};
  }
  /// What follows the last word.
  std::string_view& rest() { return text_; }

 private:
  std::string_view text_;
};

/// The first line of a text, without its end; `text` is then what follows.
std::string_view takeLine(std::string_view& text);

/// Throws InputError unless the whole word is a number.
double numberOf(std::string_view word);

}  // namespace fsr::mesh
