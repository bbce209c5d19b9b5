#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/parameters.h"
#include "settings/foreign_error.h"
#include "settings/text.h"

namespace fsr_ros {

/// Advertises a service without arguments: `action` does it and returns a sentence, see answer().
ros::ServiceServer advertiseTrigger(ros::NodeHandle& node, const std::string& name,
                                    const std::function<std::string()>& action);

/// Calls `make` until it does not throw, once a second, because a file or parameter can be put right
/// meanwhile. `say` gets the sentence of each failure. Callbacks are called between two attempts. False where
/// ROS is shut down before.
bool makeUntilRight(const std::function<void()>& make, const std::function<void(const std::string&)>& say);

/// Runs the action of a service and puts its sentence into the reply. If the action throws an exception, the
/// reply has success = false and the reason; the call itself does not fail. Both are logged. Returns
/// true, the return value of the service callback.
template <typename Response, typename Action>
bool answer(Response& response, Action action) {
  try {
    response.message = fsr::settings::printable(fsr::settings::inSentences(action));
    response.success = true;
    ROS_INFO_STREAM(response.message);
  } catch (const fsr::settings::InputError& error) {
    response.message = fsr::settings::printable(error.what());
    response.success = false;
    ROS_WARN_STREAM(response.message);
  }
  return true;
}

// The servers of nodes that do everything in callbacks. Each lives as long as what is returned. Each throws
// fsr::InputError for parameters that cannot be used.

/// Status of /diagnostics whose keys are the namespaces of the sheets round one limb.
constexpr char kSheetsTask[] = "sheets";

using Server = std::shared_ptr<void>;
using MakeServer = Server (*)(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Converts each scan on `raw` to a map on `pressure_map`, using `curvature`, `temperature` and
/// `matrix_info`. Publishes `calibration_info` (latched and repeated each second) and diagnostics. Compares
/// the surface with the sheet at rest: by itself with `chamber_pressure` and at each event doff on `events`.
/// Parameters: CalibrationSettings.
///
/// Services: `~load_calibration`, `~reload`, `~set_mask`, `~tare`, `~clear_tare`, `~check_surface`,
/// `~estimate_surface`. Each reply says what was done. The services and the first load run in a separate
/// thread, so that no scan waits for a file. If the file in `~calibration` does not exist or cannot be read,
/// the node tries again when the file changes.
Server makeCalibrationServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Publishes the surface under the matrix on `curvature`, latched and repeated each second of ROS time, so
/// that every part of a bag contains it. The service `~set_surface` changes the surface. Where the surface
/// file names a scan, the scan is published on `mesh` (MeshPublisher).
///
/// Parameters: `~surface` (name of a file in `~surfaces`, or path of a surface file; empty = unknown until
/// the service is called), `~surfaces` (folder of surface files), `~mount`, `~rows` and `~columns` (surface
/// files with one value for each taxel must fit them), `~frame_id` (of the matrix), `~mesh_frame` (of scans,
/// or of the limb; empty = no transform), `~around` [degrees] and `~along` [m] (place on the limb without a
/// scan, see matrix::onLimb()),
/// `~surface_file` (keeps what ~set_surface said, for a node that died; see SurfaceMemory).
Server makeCurvatureServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Reads a board and publishes `raw`, `chamber_pressure`, `temperature`, `events` (edges at its trigger
/// input), `matrix_info` (latched and repeated each second) and diagnostics. The service `~set_enabled`
/// closes and opens the port. Parameters: DriverSettings.
///
/// Packets are published from the thread of the link as they come, as shared pointers, so that nodelets of
/// one manager receive them without a copy. Everything else runs in the callback queue of the node.
///
/// In simulated time the host time is the last value of /clock. Stamps are then rig time, as evenly spaced as
/// the board made the scans, and early by about half a tick of /clock (see fsr::protocol::DeviceClock).
/// If the port does not exist, the driver waits for it.
Server makeDriver(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Combines the statistics of several sheets round one limb. Sums the topics in `~sheets` (separated by
/// spaces or commas) by region name, and publishes `limb_statistics` for every message of any sheet. A sheet
/// without a message for `~stale_after` [s] is left out of the sums, and every alarm that is not ALARM
/// becomes UNKNOWN. Diagnostics report silent sheets, and two whose boards have one serial number.
Server makeLimbServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// The emulated rig as a node: a board behind a serial port, in a pressure chamber that is controlled by
/// services.
///
/// Topic `~status` (std_msgs/String, latched): state and number of the run, "running 2", then "done 2"; "idle
/// 0" before the first run. A script can wait for this message after it has called `~start`. At a time scale
/// other than 1 the node also publishes `/clock` in rig time, which begins at the wall time of the start:
/// before each scan is sent, and at least 250 times a second of wall time.
///
/// Services: `~start` (starts a new run of cycles with the present parameters `~chamber/`), `~stop`,
/// `~set_surface`, `~set_damage` (true: damages the line as the present parameters `~damage/` say; false:
/// ends the damage). The node does not publish `curvature`: when the surface changes, call the curvature node
/// too, with the same surface and mount.
/// `~set_trigger` makes an edge at the board's trigger input (true: rising).
///
/// With the parameter `~operator` a RigOperator works chamber and sheet; `~start`, `~stop` and `~set_surface`
/// do not exist then.
///
/// Parameters: see launch/rig_emulator.launch and docs/nodes.md.
Server makeRigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Publishes the description of a recording, so that a bag can be understood without other files. `session`
/// is latched and repeated each second; its fields are the private parameters of the same names. `events`
/// gets one message for each call of `~mark`.
///
/// If `~bag` names the bag that is being recorded, `/diagnostics` and the log report whether it grows.
///
/// Persons are identified by a code only: `~subject_code` must match [A-Z]{1,3}[0-9]{2,4}.
Server makeSessionServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Collects messages from the topics raw, chamber_pressure, curvature, temperature and matrix_info, sent by
/// `rosbag play` or a rig. The service `~train` trains a calibration from them, and `~clear` removes them. If
/// one bag was replayed without loss, the tables are those of the tool `train`, bit for bit.
///
/// Training runs in the thread of the service call. With two or more spinner threads, the node goes on
/// collecting meanwhile. From `~most_messages` on, further messages are left out. `~gathered`
/// (diagnostic_msgs/DiagnosticStatus, latched) reports what has come and what is missing.
///
/// Parameters: ~output, ~report, ~scheme, ~model, ~bandwidth, ~spread, ~distance, ~equal_bins, ~trees,
/// ~minimum_leaf, ~leaf_rule, ~folds, ~scores, ~threads, ~seed, ~ambient_pressure, ~most_messages; see
/// train.launch and docs/nodes.md.
Server makeTrainingServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

/// Publishes pictures and statistics of the pressure map in the frame of the scan: `points`, `surface`,
/// `image`, `statistics`, `centre_of_pressure`. The sheet is bent as `curvature` says, and flat while the
/// curvature is unknown. The node receives maps only while one of its topics has a subscriber or an alarm is
/// set. `surface` and `image` are published at most at `~rate`, the other topics for every map. The
/// pressure-time integral begins with the first subscriber. When maps stop, all alarms become UNKNOWN, and
/// `surface` and `image` lose their colours unless the ROS time stands still, as in a paused replay. The
/// service `~set_alarm` sets alarms; they are logged and published on `events`. Parameters: ViewSettings.
Server makeViewServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

}  // namespace fsr_ros
