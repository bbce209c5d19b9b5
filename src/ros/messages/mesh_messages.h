#pragma once

#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "matrix/surface_file.h"

namespace fsr_ros {

/// The scan of a surface for the Marker display of rviz, which reads the file itself. `header`: the frame of
/// the matrix. It is see-through, because the sheet may be behind it, and 1 mm behind
/// the sheet.
visualization_msgs::Marker toMarker(const std_msgs::Header& header, const fsr::matrix::MeshPlace& place);

/// Takes the scan away again.
visualization_msgs::Marker noMesh(const std_msgs::Header& header);

/// The pose of the matrix frame, that of `header`, in the frame of the mesh.
tf2_msgs::TFMessage toTransform(const std_msgs::Header& header, const std::string& mesh_frame,
                                const fsr::matrix::Pose& matrix);

/// "file://" and an absolute path, with the characters escaped that a URL may not contain.
std::string fileUrl(const std::string& path);

}  // namespace fsr_ros
