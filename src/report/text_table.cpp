#include "report/text_table.h"

#include <algorithm>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::report {

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (const auto& cells : rows_) {
    widths.resize(std::max(widths.size(), cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) widths[c] = std::max(widths[c], cells[c].size());
  }
  std::string text;
  for (const auto& cells : rows_) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const bool left = c == 0 || std::find(left_.begin(), left_.end(), c) != left_.end();
      const std::string space(widths[c] - cells[c].size(), ' ');
      line += (c == 0 ? "" : "  ") + (left ? cells[c] + space : space + cells[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string binText(std::size_t bin) {
  return statistics::pressureBinName(bin, settings::shownUnitSize());
}

std::string linesOf(const std::vector<std::string>& sentences, const std::string& head) {
  std::string text;
  for (const std::string& sentence : sentences) text += head + sentence + '\n';
  return text;
}

}  // namespace fsr::report
