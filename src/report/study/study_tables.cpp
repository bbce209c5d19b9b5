#include <cmath>
#include <sstream>

#include "report/study/study_report.h"
#include "settings/number_text.h"
#include "study/paper.h"

namespace fsr::report {

namespace {

constexpr double kTableKilopascal = 1e3;  // [Pa]

// One CSV file. Numbers have nine digits; NaN is an empty cell.
class Table {
 public:
  explicit Table(const std::string& headings) {
    text_ << headings;
    text_.precision(9);
  }

  Table& row() {
    text_ << '\n';
    first_ = true;
    return *this;
  }
  Table& operator<<(double value) {
    separate();
    if (!std::isnan(value)) text_ << value;
    return *this;
  }
  Table& operator<<(const std::string& value) {
    separate();
    text_ << '"';
    for (const char letter : value) text_ << (letter == '"' ? "\"\"" : std::string(1, letter));
    text_ << '"';
    return *this;
  }
  std::string text() const { return text_.str() + '\n'; }

 private:
  void separate() {
    if (!first_) text_ << ',';
    first_ = false;
  }
  std::ostringstream text_;
  bool first_ = true;
};

// Calls visit(id of the comparison or split, score) for all scores.
template <typename Visit>
void forEachScore(const study::StudyResult& result, Visit visit) {
  for (const study::StudyComparison& comparison : result.comparisons) {
    for (const study::StudyScore& score : comparison.scores) visit(comparison.id, score);
  }
  for (const study::SplitResult& split : result.splits) {
    for (const study::StudyScore& score : split.scores) visit(split.id, score);
  }
}

void addInterval(Table& table, const statistics::BootstrapResult& interval, double unit) {
  table << interval.low / unit << interval.high / unit << interval.level
        << static_cast<double>(interval.units);
}

void addErrors(Table& table, const statistics::ErrorSummary& errors) {
  table << static_cast<double>(errors.count) << errors.bias / kTableKilopascal
        << errors.rmse / kTableKilopascal << errors.limit_low / kTableKilopascal
        << errors.limit_high / kTableKilopascal << errors.p95_absolute / kTableKilopascal;
}

std::string scoresTable(const study::StudyResult& result) {
  Table table(
      "part,method,label,model,scored,R2,R2 deviation,RMSE [%],RMSE deviation [%],paper R2,paper R2 "
      "deviation,paper RMSE [%],paper RMSE deviation [%],readings,bias [kPa],RMSE [kPa],limit low "
      "[kPa],limit high [kPa],p95 [kPa],first cycle RMSE [kPa],later cycles RMSE [kPa],worst taxel,worst "
      "taxel RMSE [%],RMSE low [kPa],RMSE high [kPa],unit,units");
  forEachScore(result, [&](const std::string& part, const study::StudyScore& score) {
    const study::PaperScore paper = study::paperScore(score.id).value_or(study::PaperScore{});
    table.row() << part << score.id << score.label << score.model << score.scored << score.r2_spread.mean
                << score.r2_spread.deviation << score.rmse_percent_spread.mean
                << score.rmse_percent_spread.deviation << paper.r2.mean << paper.r2.deviation
                << paper.rmse_percent.mean << paper.rmse_percent.deviation;
    addErrors(table, score.errors.whole.all);
    table << score.first_cycle.rmse / kTableKilopascal << score.later_cycles.rmse / kTableKilopascal
          << static_cast<double>(score.worst_taxel) << score.worst_rmse_percent;
    addInterval(table, score.rmse_interval, kTableKilopascal);
  });
  return table.text();
}

std::string taxelTable(const study::StudyResult& result) {
  Table table("part,method,taxel,R2,RMSE [%]");
  forEachScore(result, [&](const std::string& part, const study::StudyScore& score) {
    for (std::size_t t = 0; t < result.taxels.size(); ++t) {
      table.row() << part << score.id << static_cast<double>(result.taxels[t]) << score.r2[t]
                  << score.rmse_percent[t];
    }
  });
  return table.text();
}

std::string binTable(const study::StudyResult& result) {
  Table table(
      "part,method,pressure [kPa],direction,readings,bias [kPa],RMSE [kPa],limit low [kPa],limit high "
      "[kPa],p95 [kPa]");
  forEachScore(result, [&](const std::string& part, const study::StudyScore& score) {
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
      const statistics::BinnedErrors::Directions& errors = score.errors.bins[bin];
      const auto add = [&](const std::string& direction, const statistics::ErrorSummary& summary) {
        addErrors(table.row() << part << score.id << statistics::pressureBinName(bin) << direction, summary);
      };
      add("all", errors.all);
      add("loading", errors.loading);
      add("unloading", errors.unloading);
    }
  });
  return table.text();
}

void addTest(Table& table, const statistics::TestResult& test) {
  std::string freedom;
  for (const double degrees : test.degrees_of_freedom) {
    freedom += (freedom.empty() ? "" : " ") + settings::roundedText(degrees);
  }
  table << test.test << test.symbol << test.statistic << freedom << test.p << static_cast<double>(test.n);
}

void addRule(Table& table, const study::StudyComparison& comparison, const std::string& measure,
             const statistics::PaperRuleResult& rule) {
  for (const statistics::Decision& decision : rule.decisions) {
    table.row() << comparison.id << measure << decision.subject;
    addTest(table, decision.test);
    table << NAN << decision.conclusion;
  }
  for (const statistics::PairComparison& pair : rule.pairs) {
    table.row() << comparison.id << measure
                << comparison.scores[pair.first].label + " - " + comparison.scores[pair.second].label;
    addTest(table, pair.test);
    table << pair.adjusted_p << std::string(pair.differ ? "differ" : "no difference shown");
  }
}

std::string testTable(const study::StudyResult& result) {
  Table table(
      "comparison,measure,subject,test,symbol,statistic,degrees of freedom,p,taxels,adjusted p,conclusion");
  for (const study::StudyComparison& comparison : result.comparisons) {
    addRule(table, comparison, "R2", comparison.r2);
    addRule(table, comparison, "RMSE%", comparison.rmse_percent);
  }
  return table.text();
}

std::string differenceTable(const study::StudyResult& result) {
  Table table("comparison,first,second,difference of RMSE [%],low [%],high [%],unit,units");
  for (const study::StudyComparison& comparison : result.comparisons) {
    for (const study::StudyDifference& difference : comparison.differences) {
      table.row() << comparison.id << difference.first << difference.second
                  << difference.rmse_percent.estimate;
      addInterval(table, difference.rmse_percent, 1.0);
    }
  }
  return table.text();
}

std::string bandwidthTable(const study::StudyResult& result) {
  std::string headings = "bandwidth [deviations]";
  for (const study::BandwidthCurve& curve : result.bandwidths) headings += "," + curve.id + " RMSE [%]";
  Table table(headings);
  for (std::size_t b = 0; b < result.plan.bandwidths.size(); ++b) {
    table.row() << result.plan.bandwidths[b];
    for (const study::BandwidthCurve& curve : result.bandwidths) table << curve.rmse_percent[b];
  }
  return table.text();
}

Table& addError(Table& table, const study::CurvatureErrorCurve& curve, const study::CurvatureError& error) {
  return table.row() << curve.id << curve.label << 100 * error.relative << error.absolute;
}

std::string curvatureErrorTable(const study::StudyResult& result) {
  Table table(
      "method,label,relative error of the curvature [%],absolute error of the curvature [1/m],RMSE [%],RMSE "
      "[kPa],change of the answers [kPa],stated for the curvature [kPa],RMSE low [kPa],RMSE high "
      "[kPa],unit,units");
  for (const study::CurvatureErrorCurve& curve : result.curvature_errors) {
    for (const study::CurvatureErrorScore& score : curve.scores) {
      addError(table, curve, score.error)
          << score.rmse_percent << score.rmse / kTableKilopascal << score.moved / kTableKilopascal
          << score.stated / kTableKilopascal;
      addInterval(table, score.rmse_interval, kTableKilopascal);
    }
  }
  return table.text();
}

std::string curvatureErrorsBySurface(const study::StudyResult& result) {
  Table table(
      "method,label,relative error of the curvature [%],absolute error of the curvature [1/m],surface,RMSE "
      "[kPa]");
  for (const study::CurvatureErrorCurve& curve : result.curvature_errors) {
    for (const study::CurvatureErrorScore& score : curve.scores) {
      for (std::size_t c = 0; c < result.classes.size(); ++c) {
        addError(table, curve, score.error)
            << result.classes[c].condition.surface << score.rmse_of_class[c] / kTableKilopascal;
      }
    }
  }
  return table.text();
}

std::string responseTable(const study::StudyResult& result) {
  Table table("surface,curvature [1/m],time [s],pressure [kPa],reading [counts]");
  for (const study::TaxelResponse::Curve& curve : result.response.curves) {
    for (std::size_t i = 0; i < curve.time.size(); ++i) {
      table.row() << curve.surface << curve.curvature << curve.time[i] << curve.pressure[i] / kTableKilopascal
                  << curve.counts[i];
    }
  }
  return table.text();
}

std::string predictionTable(const study::StudyResult& result) {
  Table table("time [s],reference [kPa],without curvature [kPa],with curvature [kPa]");
  const study::TaxelResponse::Prediction& prediction = result.response.prediction;
  for (std::size_t i = 0; i < prediction.with_curvature.size(); ++i) {
    table.row() << prediction.time[i] << prediction.reference[i] / kTableKilopascal
                << prediction.without_curvature[i] / kTableKilopascal
                << prediction.with_curvature[i] / kTableKilopascal;
  }
  return table.text();
}

}  // namespace

std::map<std::string, std::string> studyTables(const study::StudyResult& result) {
  return {{"scores.csv", scoresTable(result)},
          {"taxel_scores.csv", taxelTable(result)},
          {"errors_by_bin.csv", binTable(result)},
          {"tests.csv", testTable(result)},
          {"differences.csv", differenceTable(result)},
          {"bandwidths.csv", bandwidthTable(result)},
          {"response.csv", responseTable(result)},
          {"prediction.csv", predictionTable(result)},
          {"curvature_errors.csv", curvatureErrorTable(result)},
          {"curvature_errors_by_surface.csv", curvatureErrorsBySurface(result)}};
}

}  // namespace fsr::report
