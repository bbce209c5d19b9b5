#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <random>
#include <vector>

#include "calibration/stages/shape/learn_shape.h"
#include "fsr_pressure_map/calibration/shape.h"

namespace test_support {

/// `deviation`, `common`, `white` [Pa], `length` [m]
fsr::calibration::MountScatter scatterOf(fsr::calibration::FieldFamily family, double deviation,
                                         double length, double common, double white);

/// A sheet whose readings at rest are known for every curvature: a preload that grows with the curvature and
/// saturates, with an amplitude of its own for each taxel. Its formulas are not those of the model.
struct PlantedShape {
  fsr::matrix::MatrixSize size{4, 5};
  std::vector<double> curvature = {0, 5, 9, 14, 20};  // of the surfaces, principal [1/m]
  std::size_t mounts = 4;                             // of each surface
  fsr::calibration::MountScatter scatter =
      scatterOf(fsr::calibration::FieldFamily::kGaussian, 1e3, 0.03, 400, 100);
  unsigned fingerprint = 1;  // seed of the amplitudes of the taxels
  unsigned seed = 1;         // of the mounts
};

constexpr std::uint16_t kPlantedFullScale = 4095;
constexpr double kPlantedScale = 500e3;  // that a reading of full scale stands for [Pa]

fsr::matrix::Layout plantedLayout(const PlantedShape& sheet);
std::vector<fsr::matrix::Position> plantedPlaces(const PlantedShape& sheet);

/// Fields of new mounts, [number x taxels] [Pa].
Eigen::MatrixXd drawMounts(const PlantedShape& sheet, std::size_t number, std::mt19937& random);

/// Pressures at rest without scatter, [taxels] [Pa]. `curvature`: principal [1/m].
Eigen::VectorXd plantedRest(const PlantedShape& sheet, double curvature);

/// Readings that stand for pressures [Pa].
fsr::calibration::RestReading readingOf(const Eigen::VectorXd& pressure);

/// What training learns from the mounts of the sheet.
fsr::calibration::ShapeModel learnPlanted(const PlantedShape& sheet);

}  // namespace test_support
