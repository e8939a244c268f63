#include "packing/exchange.h"

#include <fmt/format.h>

#include <array>
#include <iterator>

#include "base/error.h"
#include "packing/check.h"
#include "packing/data_file.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "packing/word_lines.h"

namespace pendular {
namespace {

struct Name {
  ExchangeFormat format;
  const char* word;
  std::array<const char*, 2> extensions;
};
constexpr std::array<Name, 9> kNames = {{{ExchangeFormat::vtp, "vtp", {".vtp", ".vtp"}},
                                         {ExchangeFormat::csv, "csv", {".csv", ".csv"}},
                                         {ExchangeFormat::yade, "yade", {".txt", ".yade"}},
                                         {ExchangeFormat::lammps, "lammps", {".data", ".lmp"}},
                                         {ExchangeFormat::lammps_bpm, "lammps-bpm", {".bpm", ".bpm"}},
                                         {ExchangeFormat::liggghts, "liggghts", {".liggghts", ".liggghts"}},
                                         {ExchangeFormat::spam, "spam", {".tsv", ".tsv"}},
                                         {ExchangeFormat::vtkhdf, "vtkhdf", {".vtkhdf", ".vtkhdf"}},
                                         {ExchangeFormat::xyz, "xyz", {".xyz", ".xyz"}}}};

std::string yade_text(const Packing& packing) {
  std::string text = "#format x_y_z_r\n# lengths in m\n" + to_comment(packing.provenance);
  for (const auto& b : packing.beads)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", b.centre.x(), b.centre.y(), b.centre.z(),
                   0.5 * b.diameter);
  return text;
}

std::vector<Bead> read_yade(const fs::path& path) {
  std::vector<Bead> beads;
  for (const auto& line : read_word_lines(path)) {
    line.require(4, "x y z r");
    Bead bead;
    bead.id = static_cast<std::int64_t>(beads.size()) + 1;
    bead.centre = {line.number(0), line.number(1), line.number(2)};
    bead.diameter = 2.0 * line.number(3);
    beads.push_back(bead);
  }
  return beads;
}

std::vector<Bead> read_xyz(const fs::path& path, std::optional<double> diameter) {
  if (!diameter) throw BadUsage("format xyz is in bead radii: the bead diameter is needed (--diameter-um)");
  std::vector<Bead> beads;
  for (const auto& line : read_word_lines(path)) {
    line.require(4, "id x y z");
    Bead bead;
    bead.id = line.integer(0);
    bead.centre = 0.5 * *diameter * Vec3(line.number(1), line.number(2), line.number(3));
    bead.diameter = *diameter;
    beads.push_back(bead);
  }
  return beads;
}

Packing read_unchecked(const fs::path& path, ExchangeFormat format, std::optional<double> diameter,
                       const SpamTable& table) {
  Packing packing;
  switch (format) {
    case ExchangeFormat::vtp:
      return read_packing(path);
    case ExchangeFormat::csv:
      packing.beads = read_beads(path);
      break;
    case ExchangeFormat::yade:
      packing.beads = read_yade(path);
      break;
    case ExchangeFormat::spam:
      packing.beads = read_spam(path, table, diameter);
      break;
    case ExchangeFormat::vtkhdf:
      throw BadUsage(
          "format vtkhdf is write only, expected vtp, csv, yade, lammps, lammps-bpm, liggghts, spam or xyz");
    case ExchangeFormat::xyz:
      packing.beads = read_xyz(path, diameter);
      break;
    case ExchangeFormat::lammps:
    case ExchangeFormat::lammps_bpm:
    case ExchangeFormat::liggghts:
      packing = read_data_file(path);
      break;
  }
  return packing;
}

}  // namespace

ExchangeFormat exchange_format(const std::string& word) {
  for (const auto& name : kNames)
    if (word == name.word) return name.format;
  throw BadUsage(fmt::format(
      "format: found {}, expected vtp, csv, yade, lammps, lammps-bpm, liggghts, spam, vtkhdf or xyz", word));
}

ExchangeFormat exchange_format_of(const fs::path& path) {
  for (const auto& name : kNames)
    for (const char* extension : name.extensions)
      if (path.extension() == extension) return name.format;
  throw BadUsage(fmt::format(
      "{}: the extension names no format, expected .vtp, .csv, .txt, .data, .lmp, .bpm, .liggghts, "
      ".tsv, .vtkhdf or "
      ".xyz, or "
      "the format by option",
      path.string()));
}

void write_exchange(const fs::path& path, ExchangeFormat format, const Packing& packing, double density) {
  switch (format) {
    case ExchangeFormat::vtp:
      return write_packing(path, packing);
    case ExchangeFormat::csv:
      return write_beads(path, packing.beads, packing.provenance);
    case ExchangeFormat::yade:
      return write_text(path, yade_text(packing));
    case ExchangeFormat::lammps:
      return write_text(path, lammps_text(packing, density));
    case ExchangeFormat::lammps_bpm:
      return write_text(path, lammps_bpm_text(packing, density));
    case ExchangeFormat::liggghts:
      return write_text(path, liggghts_text(packing, density));
    case ExchangeFormat::vtkhdf:
      return write_vtkhdf(path, to_polydata(packing));
    case ExchangeFormat::spam:
    case ExchangeFormat::xyz:
      throw BadUsage(
          "formats spam and xyz are read only, expected vtp, csv, yade, lammps, lammps-bpm, liggghts or "
          "vtkhdf");
  }
}

Packing read_exchange(const fs::path& path, ExchangeFormat format, std::optional<double> diameter,
                      const SpamTable& table) {
  Packing packing = read_unchecked(path, format, diameter, table);
  if (format == ExchangeFormat::vtp) return packing;
  check_beads(packing.beads, path.string());
  packing.specimen = specimen_enclosing(packing.beads);
  flag_boundary(packing);
  return packing;
}

}  // namespace pendular
