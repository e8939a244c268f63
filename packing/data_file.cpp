#include "packing/data_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>
#include <unordered_map>

#include "base/error.h"
#include "packing/bridges.h"
#include "packing/word_lines.h"

namespace pendular {
namespace {

/// Where an atom style keeps what makes a bead.
struct Columns {
  std::size_t x, diameter, least;
};
constexpr Columns kSphere{4, 2, 7};     // id type diameter density x y z
constexpr Columns kHybrid{2, 5, 8};     // id type x y z diameter density molecule
constexpr Columns kBpmSphere{5, 3, 8};  // id molecule type diameter density x y z

struct Box {
  Vec3 lowest, highest;
};

/// The specimen's bounding box, wide enough for every bead: the programs refuse atoms outside.
Box box_of(const Packing& packing) {
  const Specimen& s = packing.specimen;
  const Vec3 bottom(s.axis_x, s.axis_y, s.bottom), half(0.5 * s.diameter, 0.5 * s.diameter, 0.0);
  Box box{bottom - half, bottom + half + Vec3(0, 0, s.height)};
  for (const auto& bead : packing.beads) {
    box.lowest = box.lowest.cwiseMin(bead.centre - Vec3::Constant(0.5 * bead.diameter));
    box.highest = box.highest.cwiseMax(bead.centre + Vec3::Constant(0.5 * bead.diameter));
  }
  return box;
}

std::string header(const Packing& packing, const std::string& style, std::size_t bonds) {
  std::string text = fmt::format("pendular packing: units si (lengths in m), atom_style {}\n", style);
  text += to_comment(packing.provenance);
  text += fmt::format("\n{} atoms\n", packing.beads.size());
  if (bonds > 0) text += fmt::format("{} bonds\n", bonds);
  text += "1 atom types\n";
  if (bonds > 0) text += "1 bond types\n";
  const Box box = box_of(packing);
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format("{} {} {}lo {}hi\n", box.lowest[axis], box.highest[axis], "xyz"[axis], "xyz"[axis]);
  return text;
}

void require_atom_ids(const Packing& packing) {
  for (const auto& bead : packing.beads)
    if (bead.id < 1 || bead.id > std::numeric_limits<std::int32_t>::max())
      bad_input("bead {}: found an id that is no atom id, expected 1 to 2147483647", bead.id);
}

Columns columns_of(const WordLine& section) {
  std::istringstream words(section.comment);
  const std::vector<std::string> style{std::istream_iterator<std::string>(words), {}};
  if (style.empty() || style[0] == "sphere" || style[0] == "granular") return kSphere;
  if (style[0] == "bpm/sphere") return kBpmSphere;
  if (style[0] == "hybrid") return kHybrid;
  bad_input("{}: found atom style {}, expected hybrid (sphere bond), sphere, granular or bpm/sphere",
            section.where, style[0]);
}

Bead bead_of(const WordLine& line, const Columns& columns) {
  line.require(columns.least,
               "a line of atom_style hybrid sphere bond, sphere or bpm/sphere, as named after Atoms");
  Bead bead;
  bead.id = line.integer(0);
  bead.centre = {line.number(columns.x), line.number(columns.x + 1), line.number(columns.x + 2)};
  bead.diameter = line.number(columns.diameter);
  return bead;
}

struct Bond {
  const WordLine* line;
  std::int64_t i, j;
};

std::vector<Bridge> bridges_of(const std::vector<Bond>& bonds, const std::vector<Bead>& beads) {
  std::unordered_map<std::int64_t, int> index;
  for (std::size_t k = 0; k < beads.size(); ++k) index.emplace(beads[k].id, static_cast<int>(k));
  std::set<std::pair<int, int>> seen;
  std::vector<Bridge> bridges;
  for (const auto& [line, id_i, id_j] : bonds) {
    const auto a = index.find(id_i), b = index.find(id_j);
    if (a == index.end() || b == index.end() || id_i == id_j)
      bad_input("{}: found a bond between atoms {} and {}, expected two atoms of the file", line->where, id_i,
                id_j);
    Bridge bridge;
    std::tie(bridge.i, bridge.j) = std::minmax(a->second, b->second);
    if (!seen.emplace(bridge.i, bridge.j).second)
      bad_input("{}: found a second bond between atoms {} and {}, expected one", line->where, id_i, id_j);
    bridge.gap = gap(beads[static_cast<std::size_t>(bridge.i)], beads[static_cast<std::size_t>(bridge.j)]);
    bridge.state = BridgeState::bridge;
    bridges.push_back(bridge);
  }
  std::sort(bridges.begin(), bridges.end(),
            [](const Bridge& a, const Bridge& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return bridges;
}

void require_count(const fs::path& path, const char* what, std::int64_t announced, std::size_t found) {
  if (announced != static_cast<std::int64_t>(found))
    bad_input("{}: found {} {}, expected {} as its head says", path.string(), found, what, announced);
}

/// The bridges that are bonds.
std::vector<const Bridge*> bonds_of(const Packing& packing) {
  std::vector<const Bridge*> bonds;
  for (const auto& bridge : packing.bridges)
    if (bridge.state == BridgeState::bridge || bridge.state == BridgeState::candidate)
      bonds.push_back(&bridge);
  return bonds;
}

/// Their section of a data file; empty where there are none.
std::string bonds_text(const Packing& packing) {
  std::string text;
  std::size_t number = 0;
  for (const Bridge* bond : bonds_of(packing)) {
    if (text.empty()) text = "\nBonds\n\n";
    fmt::format_to(std::back_inserter(text), "{} 1 {} {}\n", ++number,
                   packing.beads[static_cast<std::size_t>(bond->i)].id,
                   packing.beads[static_cast<std::size_t>(bond->j)].id);
  }
  return text;
}

}  // namespace

std::string lammps_text(const Packing& packing, double density) {
  require_atom_ids(packing);
  std::string text = header(packing, "hybrid sphere bond", bonds_of(packing).size());
  // LAMMPS takes each atom's mass from its size, yet this atom style wants one per type as well.
  text += fmt::format("\nMasses\n\n1 {}\n", density * M_PI / 6.0 * std::pow(mean_diameter(packing.beads), 3));
  text += "\nAtoms # hybrid\n\n";
  for (const auto& b : packing.beads)
    fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {} {} 1\n", b.id, b.centre.x(), b.centre.y(),
                   b.centre.z(), b.diameter, density);
  return text + bonds_text(packing);
}

std::string lammps_bpm_text(const Packing& packing, double density) {
  require_atom_ids(packing);
  std::string text = header(packing, "bpm/sphere", bonds_of(packing).size());
  text += "\nAtoms # bpm/sphere\n\n";
  for (const auto& b : packing.beads)
    fmt::format_to(std::back_inserter(text), "{} 1 1 {} {} {} {} {}\n", b.id, b.diameter, density,
                   b.centre.x(), b.centre.y(), b.centre.z());
  return text + bonds_text(packing);
}

std::string liggghts_text(const Packing& packing, double density) {
  require_atom_ids(packing);
  std::string text = header(packing, "granular", 0);
  text += "\nAtoms\n\n";
  for (const auto& b : packing.beads)
    fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {} {}\n", b.id, b.diameter, density, b.centre.x(),
                   b.centre.y(), b.centre.z());
  return text;
}

Packing read_data_file(const fs::path& path) {
  const auto lines = read_word_lines(path, 2);  // the first line is a title, whatever it says
  std::int64_t atoms = 0, bonds = 0;
  std::string section;
  Columns columns = kSphere;
  Packing packing;
  std::vector<Bond> ends;
  for (const auto& line : lines) {
    if (std::isalpha(static_cast<unsigned char>(line.words[0][0])) != 0) {
      section = line.words.size() == 1 ? line.words[0] : line.words[0] + " " + line.words[1];
      if (section == "Atoms") columns = columns_of(line);
    } else if (section == "Atoms") {
      packing.beads.push_back(bead_of(line, columns));
    } else if (section == "Bonds") {
      line.require(4, "bond id, bond type and two atoms");
      ends.push_back({&line, line.integer(2), line.integer(3)});
    } else if (section.empty() && line.words.size() == 2) {
      if (line.words[1] == "atoms") atoms = line.integer(0);
      if (line.words[1] == "bonds") bonds = line.integer(0);
    }
  }
  require_count(path, "atoms", atoms, packing.beads.size());
  require_count(path, "bonds", bonds, ends.size());
  packing.bridges = bridges_of(ends, packing.beads);
  return packing;
}

}  // namespace pendular
