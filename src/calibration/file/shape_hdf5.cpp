#include <cmath>
#include <string>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/yaml_text.h"

namespace fsr::calibration {

namespace {

using compensation::FieldFamily;
using compensation::ShapeModel;

constexpr const char* kShapeGroup = "/shape";
const std::string kShapePath = "/shape/";

constexpr const char* kGaussian = "gaussian";
constexpr const char* kMatern = "matern";

// Beyond these, squares are no numbers that a covariance can be made of.
constexpr double kLeast = 1e-9;
constexpr double kMostOfShape = 1e12;

void requireWithin(const std::vector<double>& values, const std::string& name, double low, double high) {
  for (const double value : values) {
    if (value >= low && value <= high) continue;
    throw settings::InputError("its " + kShapePath + name + " has a value of " + settings::numberText(value) +
                               ", but all must be " + settings::roundedText(low) + " to " +
                               settings::roundedText(high));
  }
}

void requirePositive(const std::vector<double>& values, const std::string& name) {
  requireWithin(values, name, kLeast, kMostOfShape);
}

void requireFinite(const std::vector<double>& values, const std::string& name) {
  for (const double value : values) {
    if (!std::isfinite(value))
      throw settings::InputError("its " + kShapePath + name + " has a value that is not finite");
  }
}

void writeLaw(const ShapeModel& model, hdf5::Writer& writer) {
  const compensation::MountScatter& scatter = model.scatter;
  const compensation::ShapeLaw& law = model.law;
  writer.attribute(kShapeGroup, "family", scatter.family == FieldFamily::kGaussian ? kGaussian : kMatern);
  writer.attribute(kShapeGroup, "contrasts", static_cast<std::uint64_t>(scatter.contrasts));
  writer.attribute(
      kShapeGroup, "scatter",
      std::vector<double>{scatter.deviation, scatter.length, scatter.common, scatter.white, scatter.history});
  writer.attribute(kShapeGroup, "scatter_meaning",
                   "of mounts: deviation [Pa], length [m], common [Pa], white [Pa], history [Pa]");
  writer.attribute(kShapeGroup, "law",
                   std::vector<double>{law.common, law.common_length, law.own_offset, law.own_share, law.own,
                                       law.own_length, law.own_white});
  writer.attribute(
      kShapeGroup, "law_meaning",
      "common [Pa], its length; own_offset [Pa], own_share, own [Pa], its length [1/m], own_white [Pa]");
  writer.attribute(kShapeGroup, "direction",
                   std::vector<double>{model.direction.x, model.direction.y, model.direction.xy});
  writer.attribute(kShapeGroup, "one_direction", static_cast<std::uint64_t>(model.one_direction ? 1 : 0));
}

void readLaw(const hdf5::Reader& reader, ShapeModel& model) {
  compensation::MountScatter& scatter = model.scatter;
  const std::string family = reader.text(kShapeGroup, "family");
  if (family != kGaussian && family != kMatern)
    throw settings::InputError("its /shape family is '" + family + "', but must be gaussian or matern");
  scatter.family = family == kGaussian ? FieldFamily::kGaussian : FieldFamily::kMatern;
  scatter.contrasts = reader.integer(kShapeGroup, "contrasts");
  if (scatter.contrasts == 0)
    throw settings::InputError("its /shape contrasts is 0, but the scatter was learnt from some");
  const std::vector<double> s = reader.numbers(kShapeGroup, "scatter", 5);
  requirePositive({s[0], s[1], s[2], s[3]}, "scatter");
  requireWithin({s[4]}, "scatter", 0, kMostOfShape);
  scatter.deviation = s[0];
  scatter.length = s[1];
  scatter.common = s[2];
  scatter.white = s[3];
  scatter.history = s[4];
  const std::vector<double> l = reader.numbers(kShapeGroup, "law", 7);
  requirePositive(l, "law");
  model.law = {l[0], l[1], l[2], l[3], l[4], l[5], l[6]};
  const std::vector<double> d = reader.numbers(kShapeGroup, "direction", 3);
  requireFinite(d, "direction");
  model.direction = {d[0], d[1], d[2]};
  model.one_direction = reader.integer(kShapeGroup, "one_direction") != 0;
}

void requireTaxels(const ShapeModel& model) {
  std::vector<double> scales;
  for (std::size_t t = 0; t < model.used.size(); ++t) {
    if (model.used[t] != 0) scales.push_back(model.scale[t]);
  }
  if (scales.empty()) throw settings::InputError("its /shape/used has no taxel that takes part");
  requirePositive(scales, "scale");
}

void requireSurfaces(const ShapeModel& model) {
  requireFinite(model.curvature, "curvature");
  requirePositive(model.gain, "gain");
  requireWithin(model.zero_share, "zero_share", 0, 1);
  requireWithin(model.rest, "rest", -kMostOfShape, kMostOfShape);
  for (std::size_t s = 0; s < model.curvature.size(); ++s) {
    if (s > 0 && !(model.curvature[s] > model.curvature[s - 1]))
      throw settings::InputError("its /shape/curvature does not ascend");
    if (model.mounts[s] == 0) throw settings::InputError("its /shape/mounts has a surface without a mount");
  }
}

}  // namespace

void writeShape(const ShapeModel& model, hdf5::Writer& writer) {
  writer.group(kShapeGroup);
  writer.attribute(kShapeGroup, "missing", model.missing);
  writer.attribute(kShapeGroup, "meaning", "how the unloaded sheet reads on each surface of training");
  if (!model.present()) return;
  const std::size_t surfaces = model.curvature.size(), taxels = model.used.size();
  writeLaw(model, writer);
  writer.texts(kShapePath + "surfaces", model.surfaces, "by ascending curvature");
  writer.dataset(kShapePath + "curvature", model.curvature, {surfaces}, "1/m", "principal");
  writer.dataset(kShapePath + "mounts", model.mounts, {surfaces}, "", "behind each mean");
  writer.dataset(kShapePath + "gain", model.gain, {surfaces}, "", "how strongly a mount acts on the surface");
  writer.dataset(kShapePath + "zero_share", model.zero_share, {surfaces}, "", "readings at rest that are 0");
  writer.dataset(kShapePath + "error_between", model.error_between, {surfaces - 1}, "1/m",
                 "of an estimate between two neighbours; NaN = not known");
  writer.dataset(kShapePath + "used", model.used, {taxels}, "", "1 = the taxel takes part");
  writer.dataset(kShapePath + "scale", model.scale, {taxels}, "Pa",
                 "pressure that a reading of full scale would stand for");
  writer.dataset(kShapePath + "history",
                 model.history.empty() ? std::vector<double>(taxels, 1.0) : model.history, {taxels}, "",
                 "pattern that a load leaves behind, mean 1");
  writer.dataset(kShapePath + "rest", model.rest, {surfaces, taxels}, "Pa",
                 "mean over mounts, by that scale");
}

ShapeModel readShape(const hdf5::Reader& reader, const matrix::Layout& layout, std::uint16_t full_scale) {
  ShapeModel model;
  model.layout = layout;
  model.full_scale = full_scale;
  model.missing = "the calibration file is of an earlier version, which learnt no shape; train again";
  if (!reader.has(kShapeGroup)) return model;
  model.missing = reader.text(kShapeGroup, "missing");
  if (!model.present()) return model;
  const std::size_t taxels = layout.size.taxels();
  readLaw(reader, model);
  model.surfaces = reader.texts(kShapePath + "surfaces");
  const std::size_t surfaces = model.surfaces.size();
  if (surfaces < 2) throw settings::InputError("its /shape/surfaces has fewer than two surfaces");
  model.curvature = reader.dataset<double>(kShapePath + "curvature", {surfaces});
  model.mounts = reader.dataset<std::uint32_t>(kShapePath + "mounts", {surfaces});
  model.gain = reader.dataset<double>(kShapePath + "gain", {surfaces});
  model.zero_share = reader.dataset<double>(kShapePath + "zero_share", {surfaces});
  model.error_between = reader.dataset<double>(kShapePath + "error_between", {surfaces - 1});
  model.used = reader.dataset<std::uint8_t>(kShapePath + "used", {taxels});
  model.rest = reader.dataset<double>(kShapePath + "rest", {surfaces, taxels});
  model.history = reader.dataset<double>(kShapePath + "history", {taxels});
  requireWithin(model.history, "history", -kMostOfShape, kMostOfShape);
  model.scale = reader.dataset<double>(kShapePath + "scale", {taxels});
  requireTaxels(model);
  requireSurfaces(model);
  return model;
}

}  // namespace fsr::calibration
