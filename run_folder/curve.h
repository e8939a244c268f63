#pragma once

#include <string>
#include <vector>

#include "base/files.h"
#include "base/provenance.h"

namespace pendular {

/// One row of a stress–strain curve; means over the row's interval. SI.
struct CurveRow {
  double strain = 0.0;                  ///< engineering strain from platen displacement
  double stress = 0.0;                  ///< force on the fixed platen over the initial section, Pa
  double stress_bottom = 0.0;           ///< the same on the moving platen
  double broken_bonds = 0.0;            ///< since the start
  double kinetic = 0.0, elastic = 0.0;  ///< energies at the row's end, J
  double work = 0.0, damped = 0.0, slipped = 0.0, released = 0.0,
         halted = 0.0;            ///< running totals at the row's end, J
  double coordination = 0.0;      ///< standing bonds per bead
  double lateral_strain = 0.0;    ///< at mid-height at the row's end, expansion positive
  double inertial_number = 0.0;   ///< see dem_core/observe/quasi_static.h
  double unbalanced_force = 0.0;  ///< at the row's end
};

/// A column of curve.csv.
struct CurveColumn {
  std::string name;  ///< with its unit
  double CurveRow::*field;
  int digits;         ///< significant ones that are written; 0: a whole number
  bool may_be_empty;  ///< there may be no such number, as of the inertial number without stress
  std::string meaning;
};

/// All of them, in the order of the file. Writers, readers and checkpoints go by this table.
const std::vector<CurveColumn>& curve_columns();

/// curve.csv, written whole or not at all.
void write_curve(const fs::path& path, const std::vector<CurveRow>& rows, const Provenance& provenance);

/// The columns of a curve that are asked for; the others stay zero. NaN where a cell is empty that may be.
/// BadInput where a column is missing or holds something else.
std::vector<CurveRow> read_curve(const fs::path& path, const std::vector<double CurveRow::*>& wanted);

}  // namespace pendular
