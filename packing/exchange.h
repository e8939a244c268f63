#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "packing/exchange_spam.h"
#include "packing/packing.h"

namespace pendular {

/// Files that other programs share packings by. Lengths in m, but for csv and vtp (µm) and xyz (bead radii).
enum class ExchangeFormat {
  vtp,     ///< vtp.h: everything
  csv,     ///< tables.h: beads
  yade,    ///< Yade's ymport.text(), x_y_z_r: beads, numbered from 1 in the order of the file
  lammps,  ///< LAMMPS read_data, units si, atom_style hybrid sphere bond: beads and bonds; reads sphere and
           ///< bpm/sphere too
  lammps_bpm,  ///< LAMMPS read_data, units si, atom_style bpm/sphere: beads and bonds
  liggghts,    ///< LIGGGHTS read_data, units si, atom_style granular: beads
  spam,        ///< read only; exchange_spam.h
  vtkhdf,      ///< write only; VTKHDF (polydata.h): what vtp holds
  xyz,         ///< read only; lines of "id x y z" in bead radii, as of Finney's packing
};

/// vtp, csv, yade, lammps, lammps-bpm, liggghts, spam, vtkhdf or xyz; BadUsage for any other word.
ExchangeFormat exchange_format(const std::string& word);

/// By extension: .vtp, .csv, .txt (yade), .data or .lmp (lammps), .bpm (lammps-bpm), .liggghts, .tsv (spam),
/// .vtkhdf, .xyz; BadUsage for any other.
ExchangeFormat exchange_format_of(const fs::path& path);

/// Writes the packing as far as the format holds it. LAMMPS and LIGGGHTS need the bead density (kg/m3) and
/// ids from 1 to 2147483647 (else BadInput). Bonds are the bridges in state bridge or candidate.
void write_exchange(const fs::path& path, ExchangeFormat format, const Packing& packing, double density);

/// What the file holds, checked by check_beads(). Bonds become bridges in state bridge. The specimen of any
/// format but vtp is the smallest upright cylinder that encloses the beads. `diameter` (m) is needed by xyz,
/// and by spam where the table has no radii; `table` by spam only. Provenance is left empty but for vtp.
/// BadInput with file and line.
Packing read_exchange(const fs::path& path, ExchangeFormat format,
                      std::optional<double> diameter = std::nullopt, const SpamTable& table = {});

}  // namespace pendular
