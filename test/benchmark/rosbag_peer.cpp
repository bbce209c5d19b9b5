// The minimum work of any reader of bags: open each bag and instantiate every scan and chamber pressure with
// rosbag. Prints the CPU time of each repetition [s]. Usage: rosbag_peer REPETITIONS BAG...

#include <fsr_pressure_map/MatrixFrame.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

std::size_t readings(const char* path) {
  std::size_t sum = 0;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (const auto scan = message.instantiate<fsr_pressure_map::MatrixFrame>()) sum += scan->counts.size();
    if (message.instantiate<sensor_msgs::FluidPressure>()) ++sum;
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  for (int repetition = 0; repetition < std::atoi(argv[1]); ++repetition) {
    std::size_t sum = 0;
    const std::clock_t start = std::clock();
    for (int bag = 2; bag < argc; ++bag) sum += readings(argv[bag]);
    std::printf("%.6f\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    if (sum == 0) return 1;
  }
  return 0;
}
