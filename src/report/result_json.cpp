#include "report/result_json.h"

namespace fsr::report {

Json json(const statistics::Spread& spread) {
  return {{"mean", spread.mean}, {"deviation", spread.deviation}};
}

Json json(const statistics::ErrorSummary& errors) {
  return {{"count", errors.count},
          {"bias", errors.bias},
          {"rmse", errors.rmse},
          {"limits_95", Json::array({errors.limit_low, errors.limit_high})},
          {"p95_absolute", errors.p95_absolute}};
}

namespace {

using report::json;  // the overloads of result_json.h

Json json(const statistics::BinnedErrors::Directions& errors) {
  return {
      {"all", json(errors.all)}, {"loading", json(errors.loading)}, {"unloading", json(errors.unloading)}};
}

}  // namespace

Json json(const statistics::BinnedErrors& errors) {
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
    bins[statistics::pressureBinName(bin) + " kPa"] = json(errors.bins[bin]);
  }
  return {{"whole", json(errors.whole)}, {"bins", bins}};
}

Json json(const dataset::SensorIdentity& sensor) {
  return {{"sensor_id", sensor.sensor_id}, {"serial", sensor.serial},   {"firmware", sensor.firmware},
          {"model", sensor.model},         {"sealing", sensor.sealing}, {"transducer", sensor.transducer}};
}

Json json(const calibration::Provenance& provenance) {
  Json bags = Json::array();
  for (const calibration::SourceBag& bag : provenance.bags) {
    bags.push_back({{"name", bag.name}, {"sha256", bag.sha256}, {"scans", bag.scans}});
  }
  return {{"tool_version", provenance.tool_version},
          {"date", provenance.date},
          {"seed", provenance.seed},
          {"bags", bags},
          {"conditioning", provenance.conditioning}};
}

std::string dump(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fsr::report
