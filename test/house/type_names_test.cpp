// No type name is defined twice in one namespace. Two different types of one name in one library are
// undefined behaviour: the linker keeps one of their constructors for both.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "support/source_dir.h"

namespace {

namespace fs = std::filesystem;
using Tokens = std::vector<std::string>;

const fs::path kSource = test_support::sourceDir();

bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool isName(const std::string& token) {
  return isWord(token[0]) && std::isdigit(static_cast<unsigned char>(token[0])) == 0;
}

// The end of the comment, literal or preprocessor line that begins at `at`; `at` itself where none begins
// there.
std::size_t endOfNoCode(const std::string& text, std::size_t at) {
  const auto after = [&](const std::string& end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  if (text.compare(at, 2, "//") == 0) return after("\n", at);
  if (text.compare(at, 2, "/*") == 0) return after("*/", at + 2);
  if (text.compare(at, 2, "R\"") == 0) {
    const std::size_t open = text.find('(', at);
    return after(")" + text.substr(at + 2, open - at - 2) + "\"", open);
  }
  if (text[at] == '#') {
    std::size_t end = after("\n", at);
    while (end < text.size() && text[end - 2] == '\\') end = after("\n", end);
    return end;
  }
  if (text[at] != '"' && text[at] != '\'') return at;
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != text[at]) end += text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

// Names, numbers, "::" and single signs; a string or character is one quotation mark.
Tokens tokensOf(const std::string& text) {
  Tokens tokens;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t end = endOfNoCode(text, at); end != at) {
      if (text[at] != '/' && text[at] != '#') tokens.push_back("\"");
      at = end;
    } else if (isWord(text[at])) {
      const std::size_t begin = at;
      while (at < text.size() &&
             (isWord(text[at]) || (text[at] == '\'' && isWord(text[begin]) && !isName({text[begin]}))))
        ++at;
      tokens.push_back(text.substr(begin, at - begin));
    } else if (text.compare(at, 2, "::") == 0) {
      tokens.push_back("::");
      at += 2;
    } else {
      if (std::isspace(static_cast<unsigned char>(text[at])) == 0) tokens.push_back({text[at]});
      ++at;
    }
  }
  return tokens;
}

// The type that the class, struct, union or enum keyword at `at` defines; empty where it only names one, has
// no name, belongs to a class (struct A::B) or specialises a template.
std::string definedAt(const Tokens& tokens, std::size_t at) {
  std::string name;
  while (++at < tokens.size()) {
    const std::string& token = tokens[at];
    if (token == "[" || (token == "(" && tokens[at - 1] == "alignas")) {  // [[attribute]], alignas(...)
      at = static_cast<std::size_t>(std::find(tokens.begin() + at, tokens.end(), token == "[" ? "]" : ")") -
                                    tokens.begin());
    } else if (isName(token)) {
      if (token != "final" && token != "alignas" && token != "class" && token != "struct") name = token;
    } else if (token == ":") {
      const auto end =
          std::find_if(tokens.begin() + at, tokens.end(), [](const auto& t) { return t == "{" || t == ";"; });
      return end != tokens.end() && *end == "{" ? name : "";
    } else if (token != "]") {
      return token == "{" ? name : "";
    }
  }
  return "";
}

// Types that the text defines at the scope of a namespace with a name, or outside all of them:
// "fsr::map::Region".
std::set<std::string> typesDefinedIn(const std::string& text) {
  static const std::string kNoNamespace = "{";
  const Tokens tokens = tokensOf(text);
  std::vector<std::string> scopes;  // a namespace with its "::", "" for extern "C", or kNoNamespace
  std::set<std::string> types;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const std::string& token = tokens[at];
    const bool in_namespace = std::find(scopes.begin(), scopes.end(), kNoNamespace) == scopes.end();
    if (token == "namespace" && in_namespace && (at == 0 || tokens[at - 1] != "using")) {
      std::string name;
      while (++at < tokens.size() && tokens[at] != "{" && tokens[at] != "=") {
        if (tokens[at] != "inline") name += tokens[at];
      }
      if (at < tokens.size() && tokens[at] == "{")
        scopes.push_back(name.empty() ? kNoNamespace : name + "::");
    } else if (token == "{") {
      const bool linkage = at >= 2 && tokens[at - 1] == "\"" && tokens[at - 2] == "extern";
      scopes.push_back(linkage ? "" : kNoNamespace);
    } else if (token == "}") {
      if (!scopes.empty()) scopes.pop_back();
    } else if (in_namespace &&
               (token == "class" || token == "struct" || token == "union" || token == "enum")) {
      if (const std::string name = definedAt(tokens, at); !name.empty()) {
        std::string full;
        for (const std::string& scope : scopes) full += scope;
        types.insert(full + name);
      }
      if (token == "enum" && at + 1 < tokens.size() &&
          (tokens[at + 1] == "class" || tokens[at + 1] == "struct"))
        ++at;
    }
  }
  return types;
}

std::map<std::string, std::set<fs::path>> filesOfTypes() {
  std::map<std::string, std::set<fs::path>> files;
  for (const char* top : {"include", "src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / top)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      for (const std::string& type : typesDefinedIn(text))
        files[type].insert(fs::relative(entry.path(), kSource));
    }
  }
  return files;
}

TEST(TypeNames, AreReadFromDefinitionsAtNamespaceScope) {
  const std::set<std::string> expected = {"Global", "fsr::A", "fsr::B",      "fsr::C",
                                          "fsr::D", "fsr::E", "fsr::map::F", "fsr::map::G"};
  EXPECT_EQ(typesDefinedIn(R"x(
#define BRACE {
#include <a> // struct No {
extern "C" { struct Global { int a; }; }
namespace fsr {
struct A;
class A final : public Base<int> { struct No {}; enum No2 { k }; };
enum class B : int { k };
template <class T, class No = int> struct [[nodiscard]] C { void f() { struct No {}; } };
enum D { kD = 1'000, kE = '{' };
const char* text = "struct No {", *raw = R"(struct No {)";
template <> struct C<int> { };
struct A::Inner { };
enum Opaque : int;
struct tm now(struct tm* t) { return *t; }
struct { int x; } unnamed;
union alignas(8) E { int a; };
namespace { struct No {}; }
}
using namespace fsr;
namespace short_name = fsr::map;
namespace fsr::map { class F {}; namespace { class No {}; } }
namespace fsr { inline namespace map { class G {}; } }
)x"),
            expected);
}

TEST(TypeNames, NoTypeNameTwiceInOneNamespace) {
  const auto files = filesOfTypes();
  EXPECT_GT(files.size(), 200u);  // the files are really read
  for (const auto& [type, places] : files) {
    std::string list;
    for (const fs::path& place : places) list += "\n  " + place.string();
    EXPECT_EQ(places.size(), 1u) << type << " is defined in" << list;
  }
}

}  // namespace
