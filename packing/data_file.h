#pragma once

#include "packing/packing.h"

namespace pendular {

/// The data files of LAMMPS (atom_style hybrid sphere bond, or bpm/sphere) and of LIGGGHTS (granular), units
/// si. Internal to packing; see exchange.h.
std::string lammps_text(const Packing& packing, double density);
std::string lammps_bpm_text(const Packing& packing, double density);
std::string liggghts_text(const Packing& packing, double density);

/// Reads either: the atom style from the comment after "Atoms", else granular. Specimen is left empty.
Packing read_data_file(const fs::path& path);

}  // namespace pendular
