// The command-line tools on any file: each ends with a status or with one sentence (InputError). The first
// byte chooses the tool. runTool() would catch anything else, too, but then the sentence would not name the
// file.
#include <rosconsole/macros_generated.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <sstream>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "fuzz/fuzz_file.h"
#include "ros/tools/tools.h"

namespace {

int exportAll(int argc, const char* const* argv, std::ostream& out) {
  return fsr_ros::exportTool(argc, argv, out, fsr::exports::scanFormats());
}

struct Use {
  int (*tool)(int, const char* const*, std::ostream&);
  std::vector<std::string> options;
  bool writes;
};

const std::array<Use, 8>& uses() {
  static const std::array<Use, 8> all = {
      {{fsr_ros::checkBagTool, {}, false},
       {fsr_ros::checkBagTool, {"--use", "socket"}, false},
       {fsr_ros::scrubTool, {}, true},
       {exportAll, {"--to", "csv"}, true},
       {exportAll, {"--to", "hdf5"}, true},
       {exportAll, {"--to", "tekscan"}, true},
       {fsr_ros::trainTool, {"--no-scores", "--threads", "1"}, true},
       {fsr_ros::csvToBagTool, {"--columns", "time=1,reading=2,reference=3", "--skip-bad-rows"}, true}}};
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  static const std::string folder = "/dev/shm/fsr_tools_fuzz_" + std::to_string(getpid());
  std::filesystem::create_directory(folder);
  const Use& use = uses()[bytes[0] % uses().size()];
  const fuzz::MemoryFile file(bytes + 1, size - 1);
  std::vector<std::string> words = {"tool", file.path()};
  words.insert(words.end(), use.options.begin(), use.options.end());
  if (use.writes) words.insert(words.end(), {"--output", folder + "/out"});
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  std::ostringstream out;
  try {
    use.tool(static_cast<int>(arguments.size()), arguments.data(), out);
  } catch (const fsr::settings::InputError&) {
  }
  for (const auto& left : std::filesystem::directory_iterator(folder)) {
    fuzz::require(left.path().filename() == "out");  // no temporary file stays
  }
  std::filesystem::remove_all(folder);
  return 0;
}
