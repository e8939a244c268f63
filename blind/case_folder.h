#pragma once

#include "blind/plan.h"

namespace pendular::blind {

/// Where the parts of a split lie:
///   cases/NAME/        what a diagnosis may read, and seal.txt: the SHA-256 of its sealed file
///   sealed/NAME.json   its truth
///   seals.csv          all these hashes
///   work/              of cases that are being made
struct CaseFolders {
  fs::path root;
  fs::path open(const std::string& name) const { return root / "cases" / name; }
  fs::path sealed(const std::string& name) const { return root / "sealed" / (name + ".json"); }
  fs::path work(const std::string& name) const { return root / "work" / name; }
  fs::path log(const std::string& name) const { return root / "work" / (name + ".log"); }
  fs::path seals() const { return root / "seals.csv"; }
};

/// Whether a case is there whole, from this split. BadInput where it was made from another.
bool is_made(const CaseFolders& folders, const Split& split, const CasePlan& plan);

/// Makes a case by simulation and seals its truth; what an earlier attempt has left is replaced. The folder
/// of the case has its name only when all is there.
void make_case(const CaseFolders& folders, const Split& split, const CasePlan& plan);

/// The hash that is published of a case. BadInput where there is none.
std::string published_seal(const fs::path& case_folder);

/// About how many particle-steps of this program the truth of a case takes, by its time.
double expected_particle_steps(const Split& split, const CasePlan& plan);

}  // namespace pendular::blind
