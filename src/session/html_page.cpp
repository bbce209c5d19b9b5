#include "session/html_page.h"

#include <boost/algorithm/string/replace.hpp>
#include <cctype>
#include <utility>

#include "settings/text.h"

namespace fsr::session {

namespace {

// On paper, tables keep their rows together and nothing is cut at the right edge.
constexpr char kStyle[] = R"(
body { font: 15px/1.45 sans-serif; color: #222; max-width: 64em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.2em; margin-top: 2em; border-bottom: 1px solid #ccc; }
h3 { font-size: 1em; margin-bottom: 0.3em; }
table { border-collapse: collapse; margin: 1em 0; font-size: 0.9em; }
caption { text-align: left; color: #555; padding-bottom: 0.3em; }
th, td { padding: 0.2em 0.7em; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1em 0; } svg { max-width: 100%; height: auto; } figcaption { color: #555; font-size: 0.9em; }
pre { background: #f6f6f6; padding: 0.6em; font-size: 0.75em; white-space: pre-wrap; overflow-wrap: anywhere; }
.box { background: #f1f5f9; border-left: 4px solid #0072b2; padding: 0.2em 1em; }
.refused { background: #fdf3ec; border-left: 4px solid #d55e00; padding: 0.6em 1em; }
@media print { body { font-size: 11px; margin: 0; max-width: none; } tr, figure { break-inside: avoid; }
  h2, h3 { break-after: avoid; } }
)";

bool isNumber(const std::string& cell) {
  if (cell == "-") return true;
  const std::size_t first = cell.empty() || (cell[0] != '-' && cell[0] != '+') ? 0 : 1;
  return cell.size() > first && std::isdigit(static_cast<unsigned char>(cell[first])) != 0 &&
         cell.find_first_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos;
}

}  // namespace

std::string escaped(const std::string& text) {
  constexpr std::pair<const char*, const char*> kEntities[] = {
      {"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}};
  std::string html = settings::printable(text);
  for (const auto& [character, entity] : kEntities) boost::replace_all(html, character, entity);
  return html;
}

HtmlPage::HtmlPage(const std::string& title)
    : text_("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(title) +
            "</title><style>" + kStyle + "</style></head><body>\n<h1>" + escaped(title) + "</h1>\n") {}

void HtmlPage::element(const std::string& name, const std::string& text) {
  text_ += "<" + name + ">" + escaped(text) + "</" + name + ">\n";
}

void HtmlPage::box(const std::vector<std::string>& sentences) {
  text_ += "<div class=\"box\">\n";
  for (const std::string& sentence : sentences) element("p", sentence);
  text_ += "</div>\n";
}

void HtmlPage::refusal(const std::string& text) {
  text_ += "<p class=\"refused\">" + escaped(text) + "</p>\n";
}

void HtmlPage::list(const std::vector<std::string>& items) {
  text_ += "<ul>\n";
  for (const std::string& item : items) element("li", item);
  text_ += "</ul>\n";
}

void HtmlPage::table(const std::string& caption, const std::vector<std::string>& headings,
                     const std::vector<std::vector<std::string>>& rows) {
  text_ += "<table>";
  if (!caption.empty()) element("caption", caption);
  text_ += "<thead><tr>";
  for (const std::string& heading : headings) text_ += "<th>" + escaped(heading) + "</th>";
  text_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    text_ += "<tr>";
    for (const std::string& cell : row)
      text_ += (isNumber(cell) ? "<td class=\"number\">" : "<td>") + escaped(cell) + "</td>";
    text_ += "</tr>\n";
  }
  text_ += "</tbody></table>\n";
}

void HtmlPage::fold(const std::string& title) {
  text_ += "<details>";
  element("summary", title);
}

void HtmlPage::endFold() {
  text_ += "</details>\n";
}

void HtmlPage::figure(const std::string& svg, const std::string& caption) {
  text_ += "<figure>" + svg;
  element("figcaption", caption);
  text_ += "</figure>\n";
}

std::string HtmlPage::text() const {
  return text_ + "</body></html>\n";
}

}  // namespace fsr::session
