#include "statistics/paired_tests.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::triplesTest;

Values differences(const Values& first, const Values& second) {
  Values d = first;
  for (std::size_t i = 0; i < d.size(); ++i) d[i] -= second[i];
  return d;
}

void expectTriples(const Values& sample, double z, double p) {
  const fsr::statistics::TestResult result = triplesTest(sample);
  expectNear(result.statistic, z);
  expectNear(result.p, p);
}

// Debian's packages of R have no such test. This is the definition, triple by triple:
//   tri <- function(x) { n <- length(x); B <- numeric(n); B2 <- matrix(0, n, n)
//     for (i in 1:(n-2)) for (j in (i+1):(n-1)) for (k in (j+1):n) {
//       f <- sign(x[i]+x[j]-2*x[k]) + sign(x[i]+x[k]-2*x[j]) + sign(x[j]+x[k]-2*x[i]); ijk <- c(i,j,k)
//       B[ijk] <- B[ijk]+f; B2[i,j] <- B2[i,j]+f; B2[i,k] <- B2[i,k]+f; B2[j,k] <- B2[j,k]+f }
//     T <- sum(B)/3; v <- (n-3)*(n-4)/((n-1)*(n-2))*sum(B^2) + (n-3)/(n-4)*sum(B2^2) + n*(n-1)*(n-2)/6 -
//       (1-(n-3)*(n-4)*(n-5)/(n*(n-1)*(n-2)))*T^2; z <- T/sqrt(v); sprintf("%.15g", c(z, 2*pnorm(-abs(z)))) }
TEST(TriplesTest, AgreesWithItsDefinitionInR) {
  expectTriples(differences(kA, kB), -0.248616480800019, 0.803657458874118);  // tri(a - b)
  expectTriples(differences(kX70, kY70), -0.370844946940964, 0.710753021748859);
  expectTriples({1, 2, 4, 9, 10}, 0.431331092813754, 0.666227645409619);
  expectTriples(kX70, 7.13859663369691, 9.42885742326955e-13);
}

TEST(TriplesTest, AgreesWithItsDefinitionInRUnderTies) {
  expectTriples(differences(kT70, kU70), -1.48300797135836, 0.138072292895723);
  expectTriples({-12, -24, -13, -13, 0, -10, -18, -8, -46, -14}, -0.697341209514457,
                0.485589284182965);  // 10 * (s1 - s2)
}

TEST(TriplesTest, StaysFiniteWhereAllTriplesAreSkewedAlike) {
  expectTriples({1, 2, 4, 8, 16, 32, 64, 128, 256, 512}, 4.14039335605412,
                3.46710768726972e-05);  // tri(2^(0:9))
}

TEST(TriplesTest, HandlesDegenerateDataAsDocumented) {
  const fsr::statistics::TestResult result = triplesTest(Values(10, 0.0));
  EXPECT_EQ(result.p, 1);
  EXPECT_EQ(result.method, fsr::statistics::PMethod::kNothingToTest);
  EXPECT_THROW(triplesTest({1, 2, 3, 4}), fsr::settings::InputError);
  EXPECT_THROW(triplesTest({1, 2, 3, 4, std::nan("")}), fsr::settings::InputError);
}

}  // namespace
