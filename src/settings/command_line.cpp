#include "settings/command_line.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <locale>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/replace_file.h"
#include "settings/text.h"

namespace fsr::settings {

namespace {

constexpr int kUnusable = 2;  // exit status of wrong usage and unusable input
constexpr char kFiles[] = "files";

// The whole text as a number, or NaN.
double parsed(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = NAN;
  stream >> value;
  return stream && stream.peek() == std::istringstream::traits_type::eof() ? value : NAN;
}

[[noreturn]] void refuseValue(const std::string& name, const std::string& value, const std::string& right) {
  throw InputError("--" + name + " is \"" + value + "\", but must be " + right);
}

}  // namespace

CommandLine::CommandLine(const std::string& tool, const std::string& usage, const std::string& purpose)
    : tool_(tool), usage_(usage), app_(std::make_shared<CLI::App>(purpose, tool)) {
  app_->add_option(kFiles)->expected(-1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app_->set_help_flag("--help", "print this help and exit");
}

CommandLine& CommandLine::option(const std::string& name, const std::string& placeholder,
                                 const std::string& help) {
  app_->add_option("--" + name, help)->type_name(placeholder);
  return *this;
}

CommandLine& CommandLine::flag(const std::string& name, const std::string& help) {
  app_->add_flag("--" + name, help)
      ->disable_flag_override()
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  return *this;
}

CommandLine& CommandLine::input(const std::string& name, const std::string& placeholder,
                                const std::string& help) {
  inputs_.push_back(name);
  return option(name, placeholder, help);
}

CommandLine& CommandLine::output(const std::string& name, const std::string& placeholder,
                                 const std::string& help) {
  outputs_.push_back(name);
  return option(name, placeholder, help);
}

std::vector<std::string> CommandLine::inputPaths() const {
  std::vector<std::string> paths = files_;
  for (const std::string& name : inputs_) {
    if (has(name)) paths.push_back(text(name, ""));
  }
  return paths;
}

// Two outputs of one name would lose the first.
void CommandLine::refuseLosses() const {
  std::vector<std::string> earlier;
  for (const std::string& name : outputs_) {
    if (!has(name)) continue;
    const std::string path = text(name, "");
    requireNoInput(path, inputPaths());
    for (const std::string& other : earlier) {
      if (sameFile(path, other)) throw InputError(path + ": is given for two outputs; give two names");
    }
    earlier.push_back(path);
  }
}

void CommandLine::requireWritable(const std::string& path, const std::string& kind) const {
  requireNoInput(path, inputPaths());
  requireReplaceable(path, kind);
}

bool CommandLine::parse(int argc, const char* const* argv, std::ostream& out) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    out << help();
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + "; see " + tool_ + " --help");
  }
  files_ = app_->get_option(kFiles)->results();
  for (const std::vector<std::string>& paths : {inputs_, outputs_}) {
    for (const std::string& name : paths)
      if (has(name) && text(name, "").empty())
        throw InputError("--" + name + " is empty, but must be a path");
  }
  refuseLosses();
  return true;
}

std::string CommandLine::help() const {
  const auto head = [](const CLI::Option* option) {
    const std::string placeholder = option->get_type_name();
    return option->get_name() + (placeholder.empty() ? "" : " " + placeholder);
  };
  std::size_t width = 0;
  const auto listed = app_->get_options([](const CLI::Option* option) { return !option->get_positional(); });
  for (const CLI::Option* option : listed) width = std::max(width, head(option).size());
  std::string text = tool_ + " " + usage_ + "\n\n" + app_->get_description() + "\n\n";
  for (const CLI::Option* option : listed) {
    const std::string start = head(option);
    text += "  " + start + std::string(width - start.size() + 2, ' ') + option->get_description() + "\n";
  }
  return text;
}

bool CommandLine::has(const std::string& name) const {
  return app_->count("--" + name) != 0;
}

void CommandLine::refuse(const std::vector<std::string>& names, const std::string& why) const {
  for (const std::string& name : names)
    if (has(name)) throw InputError("--" + name + " " + why);
}

std::string CommandLine::text(const std::string& name, const std::string& fallback) const {
  return has(name) ? app_->get_option("--" + name)->results().front() : fallback;
}

std::string CommandLine::requiredText(const std::string& name) const {
  if (has(name)) return text(name, "");
  throw InputError("--" + name + " " + app_->get_option("--" + name)->get_type_name() + " is missing; see " +
                   tool_ + " --help");
}

std::string CommandLine::choice(const std::string& name, const std::vector<std::string>& choices,
                                const std::string& fallback) const {
  const std::string value = text(name, fallback);
  if (std::count(choices.begin(), choices.end(), value) == 0)
    refuseValue(name, value, "one of " + joined(choices));
  return value;
}

std::vector<std::string> CommandLine::list(const std::string& name, const std::string& fallback) const {
  std::vector<std::string> words;
  std::istringstream list(text(name, fallback));
  for (std::string word; std::getline(list, word, ',');)
    if (!word.empty()) words.push_back(word);
  return words;
}

double CommandLine::number(const std::string& name, double fallback, const Range& range) const {
  if (!has(name)) return fallback;
  const double value = parsed(text(name, ""));
  if (!range.contains(value)) refuseValue(name, text(name, ""), range.text());
  return value;
}

std::int64_t CommandLine::integer(const std::string& name, std::int64_t fallback, const Range& range) const {
  if (!has(name)) return fallback;
  const double value = parsed(text(name, ""));
  if (!range.contains(value) || value != std::floor(value)) {
    refuseValue(name, text(name, ""), "a whole number, " + range.text());
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
