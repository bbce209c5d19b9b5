#include "support/planted_shape.h"

#include <limits>
#include <string>

#include "calibration/stages/shape/rest_law.h"

namespace test_support {

using fsr::calibration::ShapeModel;

fsr::calibration::MountScatter scatterOf(fsr::calibration::FieldFamily family, double deviation,
                                         double length, double common, double white) {
  fsr::calibration::MountScatter scatter;
  scatter.family = family;
  scatter.deviation = deviation;
  scatter.length = length;
  scatter.common = common;
  scatter.white = white;
  return scatter;
}

fsr::matrix::Layout plantedLayout(const PlantedShape& sheet) {
  return {sheet.size, 0.01, 0.01};
}

std::vector<fsr::matrix::Position> plantedPlaces(const PlantedShape& sheet) {
  std::vector<fsr::matrix::Position> places;
  for (std::size_t t = 0; t < sheet.size.taxels(); ++t) places.push_back(plantedLayout(sheet).position({t}));
  return places;
}

Eigen::MatrixXd drawMounts(const PlantedShape& sheet, std::size_t number, std::mt19937& random) {
  Eigen::MatrixXd covariance = fsr::calibration::fieldCovariance(sheet.scatter, plantedPlaces(sheet));
  covariance.diagonal().array() += sheet.scatter.white * sheet.scatter.white;
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  std::normal_distribution<double> normal;
  Eigen::MatrixXd fields(static_cast<Eigen::Index>(number), covariance.rows());
  for (Eigen::Index m = 0; m < fields.rows(); ++m) {
    const Eigen::VectorXd white =
        Eigen::VectorXd::NullaryExpr(covariance.rows(), [&](Eigen::Index) { return normal(random); });
    fields.row(m) = (root * white).transpose();
  }
  return fields;
}

Eigen::VectorXd plantedRest(const PlantedShape& sheet, double curvature) {
  std::mt19937 random(sheet.fingerprint);
  std::normal_distribution<double> normal;
  Eigen::VectorXd rest(static_cast<Eigen::Index>(sheet.size.taxels()));
  for (Eigen::Index t = 0; t < rest.size(); ++t) {
    const double amplitude = 40e3 * (1 + 0.1 * normal(random)), half = 5 * (1 + 0.1 * normal(random));
    rest(t) = 15e3 + amplitude * curvature / (curvature + half);
  }
  return rest;
}

fsr::calibration::RestReading readingOf(const Eigen::VectorXd& pressure) {
  fsr::calibration::RestReading rest;
  for (const double own : pressure) rest.reading.push_back(own / kPlantedScale * kPlantedFullScale);
  rest.zero.assign(rest.reading.size(), 0);
  return rest;
}

ShapeModel learnPlanted(const PlantedShape& sheet) {
  const std::size_t taxels = sheet.size.taxels(), surfaces = sheet.curvature.size();
  ShapeModel model;
  model.missing.clear();
  model.layout = plantedLayout(sheet);
  model.full_scale = kPlantedFullScale;
  model.used.assign(taxels, 1);
  model.scale.assign(taxels, kPlantedScale);
  model.history.assign(taxels, 1.0);
  model.curvature = sheet.curvature;
  model.mounts.assign(surfaces, static_cast<std::uint32_t>(sheet.mounts));
  model.gain.assign(surfaces, 1.0);
  model.zero_share.assign(surfaces, 0.0);
  model.error_between.assign(surfaces - 1, std::numeric_limits<double>::quiet_NaN());
  std::vector<fsr::calibration::SurfaceRests> rests;
  std::mt19937 random(sheet.seed);
  for (const double curvature : sheet.curvature) {
    model.surfaces.push_back("surface_" + std::to_string(model.surfaces.size()));
    fsr::calibration::SurfaceRests surface;
    surface.pressure = drawMounts(sheet, sheet.mounts, random);
    surface.pressure.rowwise() += plantedRest(sheet, curvature).transpose();
    const Eigen::VectorXd mean = surface.pressure.colwise().mean();
    model.rest.insert(model.rest.end(), mean.begin(), mean.end());
    rests.push_back(std::move(surface));
  }
  model.scatter = fsr::calibration::learnScatter(rests, plantedPlaces(sheet));
  model.law = fsr::calibration::learnShapeLaw(model);
  return model;
}

}  // namespace test_support
