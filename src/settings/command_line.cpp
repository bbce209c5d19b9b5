#include "settings/command_line.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <iostream>
#include <locale>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/printable.h"
#include "settings/replace_file.h"

namespace fsr::settings {

namespace {

constexpr int kUnusable = 2;  // exit status of wrong usage and unusable input

// The whole text as a number, or NaN.
double parsed(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = NAN;
  stream >> value;
  return stream && stream.peek() == std::istringstream::traits_type::eof() ? value : NAN;
}

[[noreturn]] void refuse(const std::string& name, const std::string& value, const std::string& right) {
  throw InputError("--" + name + " is \"" + value + "\", but must be " + right);
}

}  // namespace

CommandLine::CommandLine(const std::string& tool, const std::string& usage, const std::string& purpose)
    : tool_(tool), usage_(usage), purpose_(purpose) {
  flag("help", "print this help and exit");
}

CommandLine& CommandLine::option(const std::string& name, const std::string& placeholder,
                                 const std::string& help) {
  return declare(name, {placeholder, help});
}

CommandLine& CommandLine::input(const std::string& name, const std::string& placeholder,
                                const std::string& help) {
  return declare(name, {placeholder, help, Use::kInput});
}

CommandLine& CommandLine::output(const std::string& name, const std::string& placeholder,
                                 const std::string& help) {
  return declare(name, {placeholder, help, Use::kOutput});
}

CommandLine& CommandLine::declare(const std::string& name, const Declared& option) {
  order_.push_back(name);
  declared_[name] = option;
  return *this;
}

CommandLine& CommandLine::flag(const std::string& name, const std::string& help) {
  return option(name, "", help);
}

void CommandLine::take(const std::string& name, const std::string* value) {
  const auto found = declared_.find(name);
  if (found == declared_.end()) {
    throw InputError("--" + name + " is not an option of " + tool_ + "; see " + tool_ + " --help");
  }
  if (values_.count(name) != 0) throw InputError("--" + name + " is given twice; keep one");
  const bool is_flag = found->second.placeholder.empty();
  if (is_flag && value != nullptr) throw InputError("--" + name + " takes no value");
  if (!is_flag && value == nullptr)
    throw InputError("--" + name + " needs a value: " + found->second.placeholder);
  if (found->second.use != Use::kValue && value->empty())
    throw InputError("--" + name + " is empty, but must be a path: " + found->second.placeholder);
  values_[name] = is_flag ? "" : *value;
}

std::vector<std::string> CommandLine::paths(Use use) const {
  std::vector<std::string> paths;
  if (use == Use::kInput) paths = files_;
  for (const std::string& name : order_) {
    if (declared_.at(name).use == use && has(name)) paths.push_back(values_.at(name));
  }
  return paths;
}

// Two outputs of one name would lose the first.
void CommandLine::refuseLosses() const {
  const std::vector<std::string> outputs = paths(Use::kOutput);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    requireNoInput(outputs[i], paths(Use::kInput));
    for (std::size_t k = 0; k < i; ++k) {
      if (sameFile(outputs[i], outputs[k]))
        throw InputError(outputs[i] + ": is given for two outputs; give two names");
    }
  }
}

void CommandLine::requireWritable(const std::string& path, const std::string& kind) const {
  requireNoInput(path, paths(Use::kInput));
  requireReplaceable(path, kind);
}

bool CommandLine::parse(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  bool options = true;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!options || word.rfind("--", 0) != 0) {
      files_.push_back(word);
    } else if (word == "--") {
      options = false;
    } else if (const std::size_t equals = word.find('='); equals != std::string::npos) {
      const std::string value = word.substr(equals + 1);
      take(word.substr(2, equals - 2), &value);
    } else {
      const std::string name = word.substr(2);
      const auto found = declared_.find(name);
      const bool wants_value = found != declared_.end() && !found->second.placeholder.empty();
      take(name, wants_value && i + 1 < words.size() ? &words[++i] : nullptr);
    }
  }
  if (has("help")) return false;
  refuseLosses();
  return true;
}

std::string CommandLine::help() const {
  std::size_t width = 0;
  const auto head = [this](const std::string& name) {
    const std::string& placeholder = declared_.at(name).placeholder;
    return "--" + name + (placeholder.empty() ? "" : " " + placeholder);
  };
  for (const std::string& name : order_) width = std::max(width, head(name).size());
  std::string text = tool_ + " " + usage_ + "\n\n" + purpose_ + "\n\n";
  for (const std::string& name : order_) {
    const std::string start = head(name);
    text += "  " + start + std::string(width - start.size() + 2, ' ') + declared_.at(name).help + "\n";
  }
  return text;
}

bool CommandLine::has(const std::string& name) const {
  return values_.count(name) != 0;
}

std::string CommandLine::text(const std::string& name, const std::string& fallback) const {
  const auto found = values_.find(name);
  return found == values_.end() ? fallback : found->second;
}

std::string CommandLine::requiredText(const std::string& name) const {
  if (!has(name)) {
    throw InputError("--" + name + " " + declared_.at(name).placeholder + " is missing; see " + tool_ +
                     " --help");
  }
  return values_.at(name);
}

double CommandLine::number(const std::string& name, double fallback, const Range& range) const {
  if (!has(name)) return fallback;
  const double value = parsed(values_.at(name));
  if (!range.contains(value)) refuse(name, values_.at(name), range.text());
  return value;
}

std::int64_t CommandLine::integer(const std::string& name, std::int64_t fallback, const Range& range) const {
  if (!has(name)) return fallback;
  const double value = parsed(values_.at(name));
  if (!range.contains(value) || value != std::floor(value)) {
    refuse(name, values_.at(name), "a whole number, " + range.text());
  }
  return static_cast<std::int64_t>(value);
}

namespace {

// A tool allocates and frees thousands of vectors of tens of kilobytes. Returning each to the system, which
// clears its pages again, takes a sixth of the time of training.
void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // [bytes], the largest value that glibc accepts
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int runTool(const std::string& tool, const std::function<int()>& run) {
  keepFreedMemory();
  const PrintableOutput out(std::cout);
  try {
    return inSentences(run);
  } catch (const InputError& error) {
    std::cerr << tool << ": " << printable(error.what()) << std::endl;
    return kUnusable;
  }
}

}  // namespace fsr::settings
