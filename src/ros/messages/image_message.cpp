#include "ros/messages/image_message.h"

#include <sensor_msgs/image_encodings.h>

namespace fsr_ros {

sensor_msgs::Image toMessage(const std_msgs::Header& header, fsr::view::Image image) {
  sensor_msgs::Image message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(image.width());
  message.height = static_cast<std::uint32_t>(image.height());
  message.encoding = sensor_msgs::image_encodings::RGB8;
  message.step = message.width * 3;
  message.data = std::move(image.bytes());
  return message;
}

}  // namespace fsr_ros
