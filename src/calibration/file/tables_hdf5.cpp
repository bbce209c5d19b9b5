#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

void writeClasses(const std::string& group, const std::vector<dataset::CurvatureClass>& classes,
                  hdf5::Writer& writer) {
  std::size_t values = 1;
  std::vector<std::string> surfaces;
  for (const dataset::CurvatureClass& one : classes) {
    surfaces.push_back(one.surface);
    values = std::max(values, one.curvature.size());
  }
  std::vector<double> curvature;
  for (const dataset::CurvatureClass& one : classes) {
    for (std::size_t taxel = 0; taxel < values; ++taxel) curvature.push_back(one.at(taxel));
  }
  writer.texts(group + "/surfaces", surfaces, "names of the conditions, one for each class");
  writer.dataset(group + "/curvature", curvature, {classes.size(), values}, "1/m",
                 "principal curvature of each class, one for all taxels or one each");
}

std::vector<dataset::CurvatureClass> readClasses(const std::string& group, matrix::MatrixSize size,
                                                 const hdf5::Reader& reader) {
  const std::vector<std::string> surfaces = reader.texts(group + "/surfaces");
  const std::vector<std::size_t> shape = reader.shape(group + "/curvature");
  if (shape.size() != 2 || shape[0] != surfaces.size() || (shape[1] != 1 && shape[1] != size.taxels())) {
    throw settings::InputError("its " + group + "/curvature does not fit " + group +
                               "/surfaces and the matrix");
  }
  const auto curvature = reader.dataset<double>(group + "/curvature", shape);
  if (!std::all_of(curvature.begin(), curvature.end(), [](double value) { return std::isfinite(value); })) {
    throw settings::InputError("its " + group + "/curvature is not finite");
  }
  std::vector<dataset::CurvatureClass> classes;
  for (std::size_t c = 0; c < surfaces.size(); ++c) {
    const auto row = curvature.begin() + static_cast<std::ptrdiff_t>(c * shape[1]);
    std::vector<double> values(row, row + static_cast<std::ptrdiff_t>(shape[1]));
    if (std::all_of(values.begin(), values.end(), [&](double value) { return value == values[0]; })) {
      values.resize(1);
    }
    classes.push_back({surfaces[c], values});
  }
  return classes;
}

void writeTables(const compensation::CurvatureTables& tables, hdf5::Writer& writer) {
  const std::vector<std::size_t> shape = {tables.size.taxels(), tables.classes.size(),
                                          tables.full_scale + 1u};
  using Column = std::vector<float> regression::CodeTable::*;
  const auto write = [&](const char* name, Column column, const char* unit, const char* meaning) {
    const std::function<std::vector<float>(std::size_t)> of_taxel = [&](std::size_t taxel) {
      std::vector<float> values;
      values.reserve(shape[1] * shape[2]);
      for (std::size_t model = 0; model < shape[1]; ++model) {
        const std::vector<float>& own = tables.tables[taxel * shape[1] + model].*column;
        values.insert(values.end(), own.begin(), own.end());
      }
      return values;
    };
    writer.dataset("/tables/" + std::string(name), shape[0], of_taxel, shape, unit, meaning);
  };
  std::vector<std::uint16_t> codes;
  for (const regression::CodeTable& table : tables.tables)
    codes.insert(codes.end(), {table.lowest, table.highest});
  writer.group("/tables");
  writeClasses("/tables", tables.classes, writer);
  writer.attribute("/tables", "class_tolerance", std::vector<double>{tables.class_tolerance});
  writer.attribute("/tables", "class_tolerance_unit", "1/m");
  write("pressure", &regression::CodeTable::pressure, "Pa",
        "[taxels x models x codes], gauge pressure of each reading; NaN = no model");
  write("deviation", &regression::CodeTable::deviation, "Pa",
        "one standard deviation of a held-out reading, likewise");
  write("support", &regression::CodeTable::support, "", "effective number of training samples, likewise");
  writer.dataset("/tables/trained_codes", codes, {shape[0], shape[1], 2}, "counts",
                 "smallest and largest reading of training");
}

compensation::CurvatureTables readTables(const hdf5::Reader& reader, matrix::MatrixSize size) {
  compensation::CurvatureTables tables;
  tables.scheme = compensation::schemeFromName(reader.text("/", "scheme"));
  tables.size = size;
  tables.full_scale =
      static_cast<std::uint16_t>(std::min<std::uint64_t>(reader.integer("/", "full_scale"), 65535));
  tables.classes = readClasses("/tables", size, reader);
  tables.class_tolerance = reader.numbers("/tables", "class_tolerance", 1)[0];
  const std::size_t codes = tables.full_scale + 1u;
  tables.tables.resize(size.taxels() * tables.classes.size());
  const auto scatter = [&](const std::string& name, std::vector<float> regression::CodeTable::*column) {
    const auto values =
        reader.dataset<float>("/tables/" + name, {size.taxels(), tables.classes.size(), codes});
    for (std::size_t i = 0; i < tables.tables.size(); ++i) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * codes);
      (tables.tables[i].*column).assign(first, first + static_cast<std::ptrdiff_t>(codes));
    }
  };
  scatter("pressure", &regression::CodeTable::pressure);
  scatter("deviation", &regression::CodeTable::deviation);
  scatter("support", &regression::CodeTable::support);
  const auto trained =
      reader.dataset<std::uint16_t>("/tables/trained_codes", {size.taxels(), tables.classes.size(), 2});
  for (std::size_t i = 0; i < tables.tables.size(); ++i) {
    tables.tables[i].lowest = trained[2 * i];
    tables.tables[i].highest = trained[2 * i + 1];
  }
  return tables;
}

}  // namespace fsr::calibration
