#include "matrix/surface_file.h"

namespace fsr::matrix {

namespace {

const settings::Range kCurvatureRange{-kMaxCurvature, kMaxCurvature, "1/m (a bend radius of 10 mm or more)"};

Curvature cylinder(const settings::Settings& settings) {
  const double radius = settings.number("radius", {1.0 / kMaxCurvature, 1000.0, "m"});
  const bool along_y = settings.choice("axis", {"x", "y"}) == "y";
  const bool outside = settings.choice("side", {"outside", "inside"}, "outside") == "outside";
  const double bend = outside ? 1.0 / radius : -1.0 / radius;
  return along_y ? Curvature{bend, 0, 0} : Curvature{0, bend, 0};
}

Curvature twoPlanes(const settings::Settings& settings) {
  return {settings.number("x", kCurvatureRange), settings.number("y", kCurvatureRange),
          settings.number("xy", kCurvatureRange, 0.0)};
}

std::vector<double> oneForEachTaxel(const settings::Settings& settings, const std::string& key,
                                    MatrixSize size) {
  const std::vector<double> values = settings.numbers(key, kCurvatureRange);
  if (values.size() != size.taxels()) {
    throw settings.error(key, "must have one value for each of the " + std::to_string(size.taxels()) +
                                  " taxels of a " + sizeText(size) + " matrix, row after row");
  }
  return values;
}

std::vector<Curvature> taxelByTaxel(const settings::Settings& settings, MatrixSize size) {
  std::vector<Curvature> result(size.taxels());
  const auto x = oneForEachTaxel(settings, "x", size);
  const auto y =
      settings.has("y") ? oneForEachTaxel(settings, "y", size) : std::vector<double>(x.size(), 0.0);
  const auto xy =
      settings.has("xy") ? oneForEachTaxel(settings, "xy", size) : std::vector<double>(x.size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {x[i], y[i], xy[i]};
  return result;
}

int countForms(const settings::Settings& settings) {
  return int{settings.has("flat")} + int{settings.has("cylinder")} + int{settings.has("two_planes")} +
         int{settings.has("taxels")};
}

std::vector<Curvature> readForm(const settings::Settings& settings, MatrixSize size) {
  if (countForms(settings) != 1) {
    throw settings::InputError(settings.origin() + ": the surface has " +
                               std::to_string(countForms(settings)) +
                               " forms, but exactly one of flat, cylinder, two_planes, taxels must be given");
  }
  if (settings.has("cylinder")) return {cylinder(settings.section("cylinder"))};
  if (settings.has("two_planes")) return {twoPlanes(settings.section("two_planes"))};
  if (settings.has("taxels")) return taxelByTaxel(settings.section("taxels"), size);
  if (!settings.flag("flat", true)) throw settings.error("flat", "must be true or left out");
  return {Curvature{}};
}

}  // namespace

Surface readSurface(const settings::Settings& settings, MatrixSize size) {
  Surface surface;
  surface.name = settings.text("surface");
  surface.curvature = readForm(settings, size);
  if (settings.has("deviation")) {
    surface.deviation = {settings.number("deviation", {0.0, kMaxCurvature, "1/m"})};
  }
  return surface;
}

bool hasSurfaceForm(const settings::Settings& settings) {
  return countForms(settings) > 0;
}

Surface readSurfaceFile(const std::string& path, MatrixSize size) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  const Surface surface = readSurface(settings, size);
  settings.refuseUnknown();
  return surface;
}

}  // namespace fsr::matrix
