#pragma once

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include "dataset/recording_builder.h"

namespace fsr_ros {

// Add messages to a RecordingBuilder by their header stamps, both from bags and from live topics. Each throws
// fsr::InputError if the message is malformed.

void addEvent(const fsr_pressure_map::MatrixFrame& message, fsr::dataset::RecordingBuilder& builder);
void addEvent(const sensor_msgs::FluidPressure& message, fsr::dataset::RecordingBuilder& builder);
void addEvent(const fsr_pressure_map::SurfaceCurvature& message, fsr::dataset::RecordingBuilder& builder);
void addEvent(const sensor_msgs::Temperature& message, fsr::dataset::RecordingBuilder& builder);
void addEvent(const fsr_pressure_map::MatrixInfo& message, fsr::dataset::RecordingBuilder& builder);
/// Only ends of attempts are taken: events `step` and `reject`.
void addEvent(const fsr_pressure_map::Event& message, fsr::dataset::RecordingBuilder& builder);

/// Throws fsr::InputError if the pitch is not positive or the mask does not fit the matrix.
fsr::dataset::MatrixDescription toDescription(const fsr_pressure_map::MatrixInfo& message);

}  // namespace fsr_ros
