#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "settings/number_text.h"

namespace fsr::report {

using settings::inShownUnit;

/// A table for the terminal, with two spaces between columns. The first column is aligned to the left, the
/// others to the right. Each is as wide as its longest cell.
class TextTable {
 public:
  /// `headings`: empty = none. `left`: further columns that are aligned to the left.
  explicit TextTable(const std::vector<std::string>& headings, const std::vector<std::size_t>& left = {})
      : left_(left) {
    if (!headings.empty()) row(headings);
  }
  /// A row may have fewer cells than there are headings.
  void row(const std::vector<std::string>& cells) { rows_.push_back(cells); }
  std::string text() const;

 private:
  std::vector<std::size_t> left_;
  std::vector<std::vector<std::string>> rows_;
};

/// A pressure bin in the unit that is shown, without the unit: "50-100".
std::string binText(std::size_t bin);

/// Each sentence on a line of its own, with `head` before it.
std::string linesOf(const std::vector<std::string>& sentences, const std::string& head);

}  // namespace fsr::report
