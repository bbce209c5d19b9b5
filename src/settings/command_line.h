#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/range.h"

namespace CLI {
class App;
}

namespace fsr::settings {

/// The options of a tool: `tool FILE... --option VALUE --flag`. Options are declared first, so that the help
/// and error messages know all of them. `--option=VALUE` is accepted too, as are options before, between and
/// after the files. `--` ends the options. Errors throw InputError, which names the option, the value and
/// what would be right.
///
/// No output may be one of the inputs: parse() refuses it, however the two are spelled.
class CommandLine {
 public:
  /// `usage`: text behind the tool's name in its help, e.g. "BAG... --output FILE".
  CommandLine(const std::string& tool, const std::string& usage, const std::string& purpose);

  CommandLine& option(const std::string& name, const std::string& placeholder, const std::string& help);
  CommandLine& flag(const std::string& name, const std::string& help);
  /// An option that names a file to read. The files without an option are read, too.
  CommandLine& input(const std::string& name, const std::string& placeholder, const std::string& help);
  /// An option that names a file or folder to write.
  CommandLine& output(const std::string& name, const std::string& placeholder, const std::string& help);

  /// False where the user asked for help, which is then printed to `out`.
  bool parse(int argc, const char* const* argv, std::ostream& out);
  std::string help() const;

  const std::vector<std::string>& files() const { return files_; }
  /// Throws InputError where writing to `path`, e.g. a file in a folder of results, would destroy an input,
  /// or where requireReplaceable() refuses it for a file of this `kind`.
  void requireWritable(const std::string& path, const std::string& kind = "") const;
  bool has(const std::string& name) const;
  /// Throws InputError "--NAME " + `why` for the first of these options that is given.
  void refuse(const std::vector<std::string>& names, const std::string& why) const;
  std::string text(const std::string& name, const std::string& fallback) const;
  /// Throws InputError where the option is missing.
  std::string requiredText(const std::string& name) const;
  /// One of `choices`.
  std::string choice(const std::string& name, const std::vector<std::string>& choices,
                     const std::string& fallback) const;
  /// The words of "A,B,...", without empty ones.
  std::vector<std::string> list(const std::string& name, const std::string& fallback = "") const;
  double number(const std::string& name, double fallback, const Range& range) const;
  std::int64_t integer(const std::string& name, std::int64_t fallback, const Range& range) const;

 private:
  std::vector<std::string> inputPaths() const;
  void refuseLosses() const;

  std::string tool_, usage_;
  std::shared_ptr<CLI::App> app_;  // knows all options
  std::vector<std::string> inputs_, outputs_;
  std::vector<std::string> files_;
};

/// Returns the exit status of a tool: that of run(), or 2 where it throws an exception, whose sentence
/// (sentenceOf()) is printed. What run() writes to std::cout is made printable().
int runTool(const std::string& tool, const std::function<int()>& run);

}  // namespace fsr::settings
