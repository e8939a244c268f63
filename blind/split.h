#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/sample.h"

namespace pendular::blind {

/// What is withheld from a case.
enum class Stratum { library, none, outside, pair, wrong_belief, other_law, other_engine };
inline constexpr std::size_t kStrata = 7;

std::string to_string(Stratum stratum);
/// BadInput, opening with `where`, for another word.
Stratum stratum_of(const std::string& word, const std::string& where);

/// What is measured in a case, each with all that those before have: the curve of specimen A; coordination
/// and lateral strain; the curve of specimen B; a second scan of A, its beads followed.
enum class Observed { curve, network, second_specimen, scan };
inline constexpr std::size_t kObserved = 4;

std::string to_string(Observed observed);
/// BadInput, opening with `where`, for another word.
Observed observed_of(const std::string& word, const std::string& where);

/// Two specimens that cases share, as they are believed to be: what every case on them has in common.
struct SharedPacking {
  std::uint64_t seed = 1;
  double height = 0.0;                ///< of specimen A, m
  double short_height = 0.0;          ///< of specimen B, m
  double short_youngs_modulus = 0.0;  ///< of B's polymer, Pa
  double scan_strain = 0.015;         ///< platen strain, as read, of A's second scan
};

/// A family of cases.
struct Split {
  std::string name;
  std::uint64_t seed = 1;
  std::size_t cases = 0;
  fs::path file;
  std::string content;                          ///< SHA-256 of what the cases follow from
  Sample sample;                                ///< what is believed; A's height is the packing's
  std::map<std::string, double> uncertainty;    ///< one sd of a believed value, by dotted key, in its unit
  std::array<double, kStrata> shares = {};      ///< of the cases, summing to 1
  std::array<double, kObserved> observed = {};  ///< shares of the cases by what is measured, likewise
  std::vector<std::string> engines;             ///< that take turns in the stratum other_engine
  std::map<std::string, double> seen_from;  ///< |θ| from which an effect can be told from none, by its id
  std::vector<SharedPacking> packings;
  double max_strain = 0.09, unload_at = 0.03;         ///< of the tests; A is unloaded once
  double sigma_centre = 3e-7, sigma_diameter = 3e-7;  ///< of the measured beads, m
};

/// Reads a split file (docs/blind.md), with another seed where one is given. BadInput names file, line, key,
/// what was found and what was expected.
Split read_split(const fs::path& path, std::optional<std::uint64_t> seed);

/// What is believed of specimen A of a packing, and of B.
Sample believed_a(const Split& split, const SharedPacking& packing);
Sample believed_b(const Split& split, const SharedPacking& packing);

}  // namespace pendular::blind
