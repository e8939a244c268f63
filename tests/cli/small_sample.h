#pragma once

#include <string>

#include "sample_file.h"

namespace pendular::test {

/// A specimen small enough to go through the whole chain in seconds, as a sample file.
inline std::string small_sample(const std::string& compression = "max_strain = 0.02\nframes = 2\n",
                                const std::string& more = "") {
  return sample_file(
      "[bridges]\nnormal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n"
      "[specimen]\ndiameter_um = 1500\nheight_um = 1500\nvolume_fraction = 0.55\n"
      "[phantom]\nvoxel_um = 10\nwall_thickness_um = 60\nmargin_um = 80\n"
      "[compression]\n" +
      compression + more);
}

}  // namespace pendular::test
