#include "support/nearest_code.h"

#include "regression/grnn/weighted_codes.h"

namespace test_support {

namespace {

namespace regression = fsr::regression;

constexpr char kOffset[] = "offset";

class NearestCode : public regression::Regressor {
 public:
  explicit NearestCode(double offset) : offset_(offset) {}

  std::string name() const override { return "nearest_code"; }

  regression::Fit fit(const regression::CodeHistogram& training) const override {
    const regression::WeightedCodes samples = regression::weightedCodes(training);
    regression::Fit fit{std::vector<double>(samples.table_size), std::vector<double>(samples.table_size)};
    std::size_t nearest = 0;
    for (std::size_t code = 0; code < samples.table_size; ++code) {
      while (nearest + 1 < samples.code.size() &&
             2 * static_cast<std::int64_t>(code) > samples.code[nearest] + samples.code[nearest + 1]) {
        ++nearest;
      }
      fit.pressure[code] = samples.sum[nearest] / samples.count[nearest] + offset_;
      fit.support[code] = samples.count[nearest];
    }
    return fit;
  }

 private:
  double offset_;  // [Pa]
};

double offsetOf(const regression::RegressorOptions& options) {
  const auto found = options.more.find(kOffset);
  return found == options.more.end() ? 0.0 : found->second;
}

}  // namespace

regression::RegressorEntry nearestCodeEntry() {
  regression::RegressorEntry entry;
  entry.name = "nearest_code";
  entry.summary = "mean pressure of the nearest code of training";
  entry.make = [](const regression::RegressorOptions& options) -> std::unique_ptr<regression::Regressor> {
    return std::make_unique<NearestCode>(offsetOf(options));
  };
  entry.write = [](const regression::RegressorOptions& options, regression::OptionWriter& writer) {
    writer.number(kOffset, offsetOf(options));
  };
  entry.read = [](const regression::OptionReader& reader, regression::RegressorOptions& options) {
    options.more[kOffset] = reader.number(kOffset);
  };
  return entry;
}

const regression::RegressorTable& regressorsWithNearestCode() {
  static const regression::RegressorTable table = [] {
    regression::RegressorTable all = regression::packageRegressors();
    all.entries.push_back(nearestCodeEntry());
    return all;
  }();
  return table;
}

}  // namespace test_support
