#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <ostream>

// What a person is led through. Each function throws fsr::InputError for parameters that cannot be used.
namespace fsr_ros {

/// Leads a person through the plan of a session (session::Conductor) until ROS is shut down. Publishes
/// `instruction` and `session_coverage`, both latched, the surface of the plan on `curvature` and what
/// happens on `events`. Records one bag for each mount. The services `~confirm`, `~accept`, `~reject` and
/// `~skip` are a person's answers. The state is kept in a file in the folder of the bags, so that a session
/// goes on after a crash or the night.
///
/// Parameters: `~plan` (path), `~surfaces` (folder), `~folder` (of bags and state), `~minutes` (time that
/// there is; 0 = no limit), `~command` (true: publish `chamber_command` for a regulator, at each reading),
/// `~silence` (time without a reading until it is said [s]), `~report` (true: write the report of the day
/// once the session is over), `~frame_id`, and those of the Recorder in `~recorder/`.
///
/// While it cannot start, e.g. because the plan is missing or has a mistake, it says why in the terminal and
/// on `instruction`, and tries again each second: a file that is put right is taken up. `begun` is called
/// once it has started. Returns false where a bag of this run was not closed.
bool conductSession(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                    const std::function<void()>& begun);

/// Rechecks a calibration on one surface: records until enough cycles of the chamber have passed or ROS ends,
/// or takes bags that exist, and writes a corrected calibration where that wins. The result is printed to
/// `out`. See recheck.launch and docs/check.md. Returns whether it came to a verdict.
///
/// Parameters: `~calibration` (empty = that of the calibration node), `~output` (empty = beside it),
/// `~report`, `~same_mount`, `~bags` (separated by spaces; empty = record), `~bag`, `~cycles`,
/// `~ambient_pressure` [Pa], `~wait` [s], `~min_space` [MB].
bool recheck(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, std::ostream& out);

}  // namespace fsr_ros
