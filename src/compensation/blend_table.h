#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::compensation {

/// Pressure and deviation of a code. A cache line holds eight neighbouring codes.
struct TableEntry {
  float pressure;   ///< gauge [Pa]
  float deviation;  ///< one standard deviation of a held-out reading [Pa]
};

/// The position of a curvature among the classes of one taxel.
struct CurvaturePlace {
  std::size_t below = 0;  ///< the class below, or the nearest class if there is none below
  std::size_t above =
      0;  ///< the class above, or the nearest; equal to `below` on a class or beyond the outer ones
  double share = 0;  ///< position between below and above, 0 to 1
  /// Beyond the outer classes: the next class inwards, and the distance in units of the distance between the
  /// two.
  std::size_t inner = 0;
  double beyond = 0;
};

/// `curvature` [classes], in any order, with at least one value that is not NaN. Classes of NaN are ignored.
CurvaturePlace placeOf(double at, const std::vector<double>& curvature);

/// The tables of one taxel, one for each class, of `codes` entries each.
struct TaxelTables {
  std::size_t codes = 0;
  std::vector<double> curvature;         ///< of each class at this taxel [1/m]; NaN = ignore the class
  std::vector<const TableEntry*> table;  ///< of each class
  std::vector<const float*> log_weight;  ///< kKernel: logarithm of the kernel sum of each class at each code
  std::vector<std::size_t> highest;      ///< entry of the highest code of training of each class; empty = all
};

/// Computes the table of a taxel for the curvature `at` [1/m]. `out` has room for tables.codes entries. The
/// pressure follows the rule; kNearest and kByName use the table of class `chosen`. `length_scale` is used by
/// kKernel.
///
/// The deviation is interpolated between the neighbouring classes and is larger between them: midway the
/// error of predictions for left-out curvatures is added in quadrature, or, if that is not known, half the
/// difference of the neighbours. Above the highest code of training of one of them, the part of their
/// difference that its table may lack is added. Beyond the outer classes it increases with the distance, by
/// the difference between the last two classes.
///
/// Allocates nothing.
void blendTable(const CurvatureRule& rule, double length_scale, const TaxelTables& tables, double at,
                std::size_t chosen, TableEntry* out);

/// Adds to the deviations of a table for the curvature `at` what a curvature with the standard deviation
/// `deviation` contributes [1/m]: half the difference of the pressures at either side of it, linear between
/// the classes and beyond them, in quadrature (JCGM 100:2008, eq. 10). With one class nothing is known, and
/// nothing is added. Allocates nothing.
void addCurvatureDeviation(const TaxelTables& tables, double at, double deviation, TableEntry* out);

}  // namespace fsr::compensation
