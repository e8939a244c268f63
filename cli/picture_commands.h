#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pendular::cli {

/// Commands that read volumes or draw need libraries (ITK, HDF5, OpenCV) that take longer to load than many a
/// run of a bank takes. They are in a program of their own, `pendular-pictures`, which `pendular`
/// becomes.
bool is_picture_command(const std::string& name);

/// Adds one of them, with what the help says of it; its options are for `pendular-pictures` to add.
CLI::App* add_picture_command(CLI::App& app, const std::string& name);

}  // namespace pendular::cli
