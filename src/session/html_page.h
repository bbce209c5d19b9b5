#pragma once

#include <string>
#include <vector>

namespace fsr::session {

/// The text as HTML: printable(), and & < > " ' are escaped.
std::string escaped(const std::string& text);

/// Writes one HTML file that needs no network: no script, no link, its style inside. All texts are escaped
/// here.
class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title);

  /// "h2", "h3", "p", or "pre": text in lines, as a program prints it.
  void element(const std::string& name, const std::string& text);
  /// A paragraph in a box that catches the eye.
  void box(const std::vector<std::string>& sentences);
  /// Why a part is missing.
  void refusal(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// Cells that begin with a digit, or with a sign and a digit, or are "-", are right-aligned.
  void table(const std::string& caption, const std::vector<std::string>& headings,
             const std::vector<std::vector<std::string>>& rows);
  /// What follows is hidden behind its title until endFold().
  void fold(const std::string& title);
  void endFold();
  /// A drawing that is SVG already, with its caption.
  void figure(const std::string& svg, const std::string& caption);

  /// The whole page.
  std::string text() const;

 private:
  std::string text_;
};

}  // namespace fsr::session
