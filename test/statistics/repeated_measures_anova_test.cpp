#include "statistics/repeated_measures.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/paired_tests.h"
#include "statistics/random_stream.h"
#include "statistics/repeated_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::repeatedMeasuresAnova;

struct AnovaOfR {
  double f, df1, df2, p;  // of R's table
  double gg, gg_p, hf, hf_p;
  double w, mauchly_p;
};

void expectAnova(const fsr::statistics::RepeatedMeasures& data, const AnovaOfR& r) {
  const fsr::statistics::RepeatedMeasuresAnova result = repeatedMeasuresAnova(data);
  expectNear(result.test.statistic, r.f);
  EXPECT_EQ(result.test.degrees_of_freedom, (Values{r.df1, r.df2}));
  expectNear(result.test.p, r.p);
  expectNear(result.greenhouse_geisser.epsilon, r.gg);
  expectNear(result.greenhouse_geisser.p, r.gg_p);
  expectNear(result.huynh_feldt.epsilon, r.hf);
  expectNear(result.huynh_feldt.p, r.hf_p);
  expectNear(result.mauchly.statistic, r.w);
  expectNear(result.mauchly.p, r.mauchly_p);
}

fsr::statistics::RepeatedMeasures firstUnits(fsr::statistics::RepeatedMeasures data, std::size_t units,
                                             std::size_t treatments) {
  data.values.resize(treatments);
  data.treatments.resize(treatments);
  for (Values& values : data.values) values.resize(units);
  return data;
}

// f <- lm(m ~ 1); r <- anova(f, X = ~1, test = "Spherical"); s <- stats:::sphericity(SSD(f), X = ~1)
// sprintf("%.15g", c(r[1,"F"], r[1,"num Df"], r[1,"den Df"], r[1,"Pr(>F)"],
//                    s$GG.eps, r[1,"G-G Pr"], s$HF.eps, r[1,"H-F Pr"]))
// H <- apply(contr.helmert(ncol(m)), 2, function(v) v / sqrt(sum(v^2)))   # Mauchly on the contrasts:
// For RT the mean is subtracted: R's contrasts are orthogonal to the units' level to 1e-10 only, which
// matters at 5.5 s. u <- mauchly.test(lm(m %*% H ~ 1)); sprintf("%.15g", c(u$statistic, u$p.value))
TEST(RepeatedMeasuresAnova, AgreesWithR) {
  expectAnova(roundingTimes(),
              {6.28830791576219, 2, 42, 0.00408410072218699, 0.773501463270237, 0.00843979904539667,
               0.823370924873981, 0.00718882158641832, 0.707177623463382, 0.0312813222776286});
  expectAnova(skewed5(), {0.998345340941805, 4, 276, 0.408843195591877, 0.930234212660215, 0.405440880371234,
                          0.989848686069102, 0.408370136210707, 0.84193741251648, 0.237002838985857});
  expectAnova(tied5(),
              {20.1833938888557, 4, 276, 1.3497713855822e-14, 0.704214629951822, 6.00150461017545e-11,
               0.737272710320512, 2.34179476711271e-11, 0.372537667698601, 7.27698489529451e-11});
}

TEST(RepeatedMeasuresAnova, UsesAnEpsilonAboveOneAsOne) {
  expectAnova(normal3(), {7.68297844903738, 2, 58, 0.00109665193601302, 0.96224105287834, 0.00129032216425848,
                          1.02924094361553, 0.00109665193601302, 0.960759367926911, 0.570958823301983});
}

TEST(RepeatedMeasuresAnova, AgreesWithROnFewUnits) {
  expectAnova(firstUnits(skewed5(), 20, 5),  // m5[1:20, ]
              {2.10009366941424, 4, 76, 0.0890128648160115, 0.763984480386759, 0.108967730640418,
               0.926971403837462, 0.0947415841669971, 0.451947316912881, 0.130000458011334});
  expectAnova(firstUnits(skewed5(), 6, 4),  // m5[1:6, 1:4]
              {3.0927397081296, 3, 15, 0.0589194339220102, 0.502925310734349, 0.111419013730577,
               0.673369898948621, 0.0892499673097401, 0.018192732728116, 0.0134731739857929});
}

TEST(RepeatedMeasuresAnova, IsThePairedTTestOnTwoTreatments) {
  const fsr::statistics::RepeatedMeasuresAnova result = repeatedMeasuresAnova(measures({kA, kB}));
  const fsr::statistics::TestResult t = fsr::statistics::pairedT(kA, kB).test;
  expectNear(result.test.statistic, t.statistic * t.statistic);
  expectNear(result.test.p, t.p);
  expectNear(result.greenhouse_geisser.p, t.p);
  expectNear(result.huynh_feldt.p, t.p);
  EXPECT_EQ(result.mauchly.p, 1);
}

TEST(RepeatedMeasuresAnova, HandlesDegenerateDataAsDocumented) {
  const fsr::statistics::RepeatedMeasuresAnova same = repeatedMeasuresAnova(measures({kA, kA, kA}));
  EXPECT_EQ(same.test.p, 1);
  EXPECT_EQ(same.test.method, fsr::statistics::PMethod::kNothingToTest);

  const fsr::statistics::RepeatedMeasuresAnova few =
      repeatedMeasuresAnova(measures({{1, 2}, {2, 5}, {3, 1}, {7, 3}}));
  EXPECT_TRUE(std::isnan(few.mauchly.p));
  EXPECT_EQ(few.mauchly.statistic, 0);
  EXPECT_TRUE(few.greenhouse_geisser.p > 0 && few.greenhouse_geisser.p <= 1);
  EXPECT_EQ(few.huynh_feldt.epsilon, 1);
}

TEST(RepeatedMeasuresAnova, RefusesUnusableData) {
  EXPECT_THROW(repeatedMeasuresAnova({}), fsr::settings::InputError);
  EXPECT_THROW(repeatedMeasuresAnova(measures({kA})), fsr::settings::InputError);
  EXPECT_THROW(repeatedMeasuresAnova(measures({{1}, {2}})), fsr::settings::InputError);
  EXPECT_THROW(repeatedMeasuresAnova(measures({{1, 2}, {2}})), fsr::settings::InputError);
  EXPECT_THROW(repeatedMeasuresAnova(measures({{1, 2}, {2, std::nan("")}})), fsr::settings::InputError);
  EXPECT_THROW(repeatedMeasuresAnova(measures({{1, 2, 3}, {3, 4, 5}, {0, 1, 2}})), fsr::settings::InputError);
}

}  // namespace
