#pragma once

#include <cstdio>
#include <string>

namespace test_support {

/// Standard output and exit status of a shell command.
struct ProgramOutput {
  std::string text;
  int status = -1;
};

inline ProgramOutput outputOf(const std::string& command) {
  ProgramOutput output;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  char part[4096];
  for (std::size_t size; (size = fread(part, 1, sizeof part, pipe)) > 0;) output.text.append(part, size);
  output.status = pclose(pipe);
  return output;
}

/// Whether a program is installed.
inline bool hasProgram(const std::string& name) {
  return outputOf("command -v " + name).status == 0;
}

}  // namespace test_support
