#include "ros/messages/mesh_messages.h"

#include <cctype>

namespace fsr_ros {

namespace {

using visualization_msgs::Marker;

// The scan is drawn this far behind the sheet, in the direction of the middle taxel. Without it the two,
// which differ by hundredths of a millimetre, shine through each other in patches. About the thickness of a
// sheet [m].
constexpr double kBehind = 0.001;

geometry_msgs::Quaternion toMessage(const std::array<double, 4>& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion[0];
  message.y = quaternion[1];
  message.z = quaternion[2];
  message.w = quaternion[3];
  return message;
}

template <typename Vector>
Vector toVector(const std::array<double, 3>& position) {
  Vector message;
  message.x = position[0];
  message.y = position[1];
  message.z = position[2];
  return message;
}

Marker marker(const std_msgs::Header& header, int action) {
  Marker result;
  result.header = header;
  result.ns = "mesh";
  result.type = Marker::MESH_RESOURCE;
  result.action = action;
  result.pose.orientation.w = 1;
  return result;
}

}  // namespace

std::string fileUrl(const std::string& path) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string url = "file://";
  for (const char letter : path) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 128 && (std::isalnum(byte) != 0 || std::string("/-._~").find(letter) != std::string::npos)) {
      url += letter;
    } else {
      url += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
  }
  return url;
}

Marker toMarker(const std_msgs::Header& header, const fsr::matrix::MeshPlace& place) {
  Marker result = marker(header, Marker::ADD);
  const fsr::matrix::Pose mesh = fsr::matrix::inverse(place.matrix);
  result.pose.position = toVector<geometry_msgs::Point>(mesh.position);
  result.pose.position.z -= kBehind;
  result.pose.orientation = toMessage(mesh.quaternion);
  result.mesh_resource = fileUrl(place.file);
  result.scale.x = result.scale.y = result.scale.z = place.unit;
  result.color.r = result.color.g = result.color.b = 0.8f;
  result.color.a = 0.4f;
  return result;
}

Marker noMesh(const std_msgs::Header& header) {
  return marker(header, Marker::DELETE);
}

geometry_msgs::TransformStamped toTransform(const std_msgs::Header& header, const std::string& mesh_frame,
                                            const fsr::matrix::Pose& matrix) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = header.stamp;
  transform.header.frame_id = mesh_frame;
  transform.child_frame_id = header.frame_id;
  transform.transform.translation = toVector<geometry_msgs::Vector3>(matrix.position);
  transform.transform.rotation = toMessage(matrix.quaternion);
  return transform;
}

}  // namespace fsr_ros
