#include "ros/tools/tools.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/rescue_bag.h"
#include "settings/command_line.h"

namespace fsr_ros {

int closeBagTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line(
      "close_bag", "FILE.bag.active...",
      "Closes recordings that were not closed, because the recorder was killed or its disk was full. Each is "
      "cut behind its last whole message, gets its index and is called FILE.bag.\n"
      "Exit status: 0; 1 if a disk has no room for the index; 2 if a file cannot be closed.");
  if (!line.parse(argc, argv, out)) return 0;
  if (line.files().empty()) throw fsr::settings::InputError("give at least one file to close");
  int status = 0;
  for (const std::string& file : line.files()) {
    const RescuedBag rescued = rescueBag(file);
    if (!rescued.complaint.empty()) status = 1;
    out << (rescued.complaint.empty()
                ? rescued.file + " is closed and holds " + std::to_string(rescued.messages) + " messages"
                : rescued.complaint)
        << '\n';
  }
  return status;
}

}  // namespace fsr_ros
