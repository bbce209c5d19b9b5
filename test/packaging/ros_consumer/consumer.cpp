// consumer: converts a map to a message and back, and asks for a bag that does not exist.

#include <fsr_pressure_map/ros/bag_reader.h>
#include <fsr_pressure_map/ros/pressure_map_message.h>
#include <fsr_pressure_map/settings/input_error.h>

#include <iostream>
#include <string>

int main() {
  fsr::map::PressureMap map;
  map.layout.size = {1, 2};
  map.pressure = {1e3F, 2e3F};
  map.deviation = {1.0F, 2.0F};
  map.flags = {0, 0};
  fsr_pressure_map::PressureMap message;
  fsr_ros::fillMessage(map, message);
  if (fsr_ros::toPressureMap(message).pressure != map.pressure) return 1;
  try {
    std::cout << fsr_ros::readBag("no_such.bag").scans() << " scans\n";
  } catch (const fsr::settings::InputError& error) {
    std::cout << error.what() << '\n';
    return std::string(error.what()) == "no_such.bag: there is no such file" ? 0 : 1;
  }
  return 1;
}
