#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <vector>

#include "base/provenance.h"

namespace pendular::cli {

/// Options that mean the same in every command.
struct Common {
  int threads = 0;
  std::uint64_t seed = 1;
  bool quiet = false;
  fs::path out;
};

/// Adds --threads, --seed, --quiet and -o/--out; `out_default` empty: --out is required.
void add_common(CLI::App& command, Common& common, const std::string& out_help,
                const std::string& out_default = "");

/// Applies threads and quiet, and keeps the command's inputs from being written to: call first in a command's
/// callback, with every file that it reads and every file that it writes. BadUsage where an output is
/// an input or another output, BadInput where it could not be written. Empty paths are left out.
void apply(const Common& common, const std::vector<fs::path>& inputs,
           const std::vector<fs::path>& outputs = {});

/// Where the file that goes beside an output is written.
fs::path beside(const fs::path& out, const char* extension);

/// The words of the command that runs now, for its provenance.
void set_command_line(const std::vector<std::string>& words);

/// Version, command line and seed of this run, and the hashes of its input files.
Provenance provenance(const Common& common, const std::vector<fs::path>& inputs);

/// Adds the commands that a program has, in the order of its help; each program has its own.
void add_commands(CLI::App& app);

/// Each adds its command to the program; the command runs from the parse callback and throws Error.
void add_demo(CLI::App& app);
void add_phantom(CLI::App& app);
void add_segment(CLI::App& app);
void add_pack(CLI::App& app);
void add_bridge(CLI::App& app);
void add_compress(CLI::App& app);
void add_modulus(CLI::App& app);
void add_render(CLI::App& app);
void add_convert(CLI::App& app);
void add_sweep(CLI::App& app);
void add_reproduce(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_blind(CLI::App& app);
void add_sweep_run(CLI::App& app);   // the process of one run; not for users
void add_blind_case(CLI::App& app);  // the process of one case; not for users
void add_manual(CLI::App& app);      // pages and completions for installation
void add_pipette(CLI::App& app);
void add_track(CLI::App& app);
void add_doctor(CLI::App& app);
void add_formats(CLI::App& app);  // what the program knows of its files; for scripts/formats-docs

}  // namespace pendular::cli
