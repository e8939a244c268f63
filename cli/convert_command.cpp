#include <optional>

#include "base/error.h"
#include "base/path_kind.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "packing/exchange.h"
#include "packing/exchange_run.h"
#include "packing/polydata.h"
#include "packing/tables.h"

namespace pendular::cli {
namespace {

struct ConvertOptions {
  Common common;
  fs::path in, out, bridges;
  std::string from, format;
  double density = 2540.0;
  std::optional<double> diameter_um, voxel_um;
  bool displaced = false;
};

ExchangeFormat format_for(const std::string& word, const fs::path& path) {
  return word.empty() ? exchange_format_of(path) : exchange_format(word);
}

/// The output as named by its place or by --out.
fs::path output_of(const ConvertOptions& options) {
  if (options.out.empty() == options.common.out.empty()) throw BadUsage("convert: expected one output file");
  return options.out.empty() ? options.common.out : options.out;
}

/// Provenance that does not depend on the output's name, as for --out.
Provenance provenance_for(const ConvertOptions& options, const std::vector<fs::path>& inputs) {
  Provenance result = provenance(options.common, inputs);
  if (const auto at =
          options.out.empty() ? std::string::npos : result.command.rfind(' ' + options.out.string());
      at != std::string::npos)
    result.command.erase(at, 1 + options.out.string().size());
  return result;
}

/// A run folder, for ParaView (.pvd) or OVITO (.dump).
void convert_run(const ConvertOptions& options, const fs::path& out) {
  const bool dump = out.extension() == ".dump";
  if (!dump && out.extension() != ".pvd")
    throw BadUsage(
        fmt::format("{}: found a run folder to convert, expected an output .pvd or .dump", out.string()));
  apply(options.common, run_frames(options.in), {out, dump ? bonds_beside(out) : fs::path()});
  dump ? write_dump(out, options.in) : write_pvd(out, options.in);
}

/// Any .vtp of this program, a frame too, with all that it holds.
void convert_polydata(const ConvertOptions& options, const fs::path& out) {
  apply(options.common, {options.in}, {out});
  write_vtkhdf(out, read_polydata(options.in));
}

void run(const ConvertOptions& options) {
  const fs::path out = output_of(options);
  if (is_folder(options.in)) return convert_run(options, out);
  const ExchangeFormat from = format_for(options.from, options.in), to = format_for(options.format, out);
  if (from == ExchangeFormat::vtp && to == ExchangeFormat::vtkhdf) return convert_polydata(options, out);
  if (from != ExchangeFormat::spam && (options.voxel_um || options.displaced))
    throw BadUsage("convert: --voxel-um and --displaced go with tables of spam");
  const bool reads_bridges = from == ExchangeFormat::csv && !options.bridges.empty();
  const bool writes_bridges = to == ExchangeFormat::csv && !reads_bridges && !options.bridges.empty();
  apply(options.common, {options.in, reads_bridges ? options.bridges : fs::path()},
        {out, writes_bridges ? options.bridges : fs::path()});
  std::optional<double> diameter;
  if (options.diameter_um) diameter = 1e-6 * *options.diameter_um;
  SpamTable table;
  if (options.voxel_um) table.voxel = 1e-6 * *options.voxel_um;
  table.displaced = options.displaced;
  Packing packing = read_exchange(options.in, from, diameter, table);
  std::vector<fs::path> inputs = {options.in};
  if (reads_bridges) {
    packing.bridges = read_bridges(options.bridges, packing.beads);
    inputs.push_back(options.bridges);
  }
  packing.provenance = provenance_for(options, inputs);
  WrittenTogether written;
  write_exchange(out, to, packing, options.density);
  if (writes_bridges) write_bridges(options.bridges, packing.beads, packing.bridges, packing.provenance);
  written.commit();
}

}  // namespace

void add_convert(CLI::App& app) {
  auto options = std::make_shared<ConvertOptions>();
  auto* command = app.add_subcommand(
      "convert",
      "Packings from and to other programs' files.\n"
      "vtp: packing of this program. csv: beads.csv, lengths in um. yade: x_y_z_r text, lengths in m.\n"
      "lammps: data file, units si, atom_style hybrid sphere bond (reads sphere and bpm/sphere too).\n"
      "lammps-bpm: the same with atom_style bpm/sphere, for its BPM package.\n"
      "liggghts: data file, units si, atom_style granular. xyz (read only): lines of id x y z in bead "
      "radii.\n"
      "spam (read only): table of labels, places and displacements in voxels, as of spam-ddic.\n"
      "vtkhdf (write only): VTKHDF unstructured grid, of a packing or of a run's frame (.vtp).\n"
      "The format follows from the extension: .vtp, .csv, .txt (yade), .data, .lmp (lammps), .bpm "
      "(lammps-bpm), .liggghts, "
      ".tsv (spam), .vtkhdf, .xyz.\n"
      "A run folder becomes one file that ParaView plays (.pvd), or LAMMPS dumps of beads and of bonds for "
      "OVITO (.dump).");
  command->add_option("input", options->in, "File to read, or a run folder; axes x, y, z")->required();
  command->add_option("--from", options->from, "Format of the input, where the extension does not say it");
  command->add_option("--format", options->format,
                      "Format of the output, where the extension does not say it");
  command->add_option("--bridges", options->bridges,
                      "bridges.csv: read beside a csv input, written beside a csv output");
  command->add_option("--density-kg-m3", options->density, "Bead density in LAMMPS and LIGGGHTS files")
      ->check(within(1e-3, 1e6))
      ->capture_default_str();
  command
      ->add_option("--diameter-um", options->diameter_um,
                   "Bead diameter of an xyz input, or of spam's without radii")
      ->check(within(1e-3, 1e6));
  command->add_option("--voxel-um", options->voxel_um, "Voxel size of spam's tables")
      ->check(within(1e-3, 1e6));
  command->add_flag("--displaced", options->displaced,
                    "Beads where spam-ddic found them in the second scan, for `pendular track`");
  add_common(*command, options->common, "File to write");
  command->get_option("--out")->required(false);
  command->add_option("output", options->out, "File to write");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
