#pragma once

#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace test_support {

/// How a command-line tool ended.
struct ToolRun {
  int status = -1;      ///< exit status; -1 after an InputError
  std::string printed;  ///< until then
  std::string error;    ///< the sentence of the InputError

  const std::string& said() const { return status == -1 ? error : printed; }
};

/// Runs a tool with these words behind its name, as main() does.
template <typename Tool>
ToolRun runTool(const Tool& tool, const std::string& name, const std::vector<std::string>& words) {
  std::vector<const char*> arguments = {name.c_str()};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  std::ostringstream out;
  ToolRun run;
  try {
    run.status = tool(static_cast<int>(arguments.size()), arguments.data(), out);
  } catch (const fsr::settings::InputError& error) {
    run.error = error.what();
  }
  run.printed = out.str();
  return run;
}

}  // namespace test_support
