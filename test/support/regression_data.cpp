#include "support/regression_data.h"

#include <fstream>
#include <stdexcept>
#include <string>

#include "fsr_pressure_map/statistics/metrics.h"
#include "support/source_dir.h"

namespace test_support {

RegressionData regressionData() {
  const std::string path = sourceDir() + "/test/data/regression.csv";
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  RegressionData data;
  data.train.full_scale = data.test.full_scale = 4095;
  std::string header;
  std::getline(file, header);
  unsigned code = 0, held_out = 0;
  double pressure = 0, curvature = 0;
  char comma;
  while (file >> code >> comma >> pressure >> comma >> curvature >> comma >> held_out) {
    fsr::regression::CodeSamples& part = held_out != 0 ? data.test : data.train;
    part.add(static_cast<std::uint16_t>(code), fsr::regression::toFixed(pressure));
    part.curvature.push_back(curvature);
  }
  return data;
}

double rmsePercentOn(const fsr::regression::CodeSamples& test, const std::vector<double>& answers) {
  std::vector<double> pressure;
  for (const fsr::regression::FixedPressure p : test.pressure)
    pressure.push_back(fsr::regression::fromFixed(p));
  return fsr::statistics::rmsePercent(answers, pressure);
}

}  // namespace test_support
