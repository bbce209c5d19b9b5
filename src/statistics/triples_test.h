#pragma once

#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

/// Triples test: is a distribution symmetric about any centre? The paper chooses by symmetry between
/// Wilcoxon's test, which needs symmetric differences, and the sign test, which does not. It does not say how
/// symmetry was tested; SPSS has no such test.
///
/// A triple of values is skewed to the right where the middle one is closer to the smallest, to the left
/// where it is closer to the largest. T = right triples - left triples, and z = T / sigma is standard normal
/// for large n, with
///
///   sigma^2 = (n-3)(n-4) / ((n-1)(n-2)) sum_i B_i^2 + (n-3) / (n-4) sum_{i<j} B_ij^2
///             + n(n-1)(n-2) / 6 - (1 - (n-3)(n-4)(n-5) / (n(n-1)(n-2))) T^2,
///
/// B_i and B_ij the sums over the triples that contain i, or i and j.
/// Source: R. Randles, M. Fligner, G. Policello, D. Wolfe, J. Am. Stat. Assoc. 75 (1980) 168-172;
/// M. Hollander, D. Wolfe, Nonparametric Statistical Methods, 1999, sec. 3.9.
///
/// It is used instead of tests of (mean - median) / deviation, e.g. that of Miao, Gel and Gastwirth (2006).
/// Their critical values hold for normal data, but symmetry is tested here only where normality was rejected.
/// At a level of 5 % and 70 values (10,000 trials each) the triples test rejects 6.8 % of uniform, 5.4 % of
/// normal, 6.1 % of Laplace's and 6.2 % of Student's samples with 2 degrees of freedom; the other test
/// rejects 9.4, 4.6, 6.0 and 22 %. With fewer than 20 values the triples test has little power. Its time is
/// proportional to n^2 log n.
///
/// All values equal: T = 0, p = 1, nothing to test. A triple whose middle value is exactly in the middle,
/// e.g. because of ties, counts for neither side. InputError: fewer than 5 values (sigma has no value), one
/// not finite.
TestResult triplesTest(const std::vector<double>& sample);

}  // namespace fsr::statistics
