#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace pendular {

namespace fs = std::filesystem;

/// Calls `write` with a temporary path beside `path` (same extension), makes the result durable and
/// renames it to `path`: the file is there whole or not at all, also after a loss of power (file and folder
/// are synchronised). The temporary file is removed on any error. BadInput where `path` is a folder or a
/// device, BadUsage where it is an input (protect_inputs()), ComputationFailed where the disc is full or the
/// folder cannot be written.
void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write);

/// Files written while it lives get their names together, by commit(), or none of them. One at a time.
class WrittenTogether {
 public:
  WrittenTogether();
  ~WrittenTogether();
  WrittenTogether(const WrittenTogether&) = delete;
  WrittenTogether& operator=(const WrittenTogether&) = delete;
  void commit();
};

/// The files that the command reads. From here on none of them is overwritten or removed, under whatever
/// name. Replaces what was protected before.
void protect_inputs(const std::vector<fs::path>& inputs);

/// Further ones, found while reading.
void protect_also(const std::vector<fs::path>& inputs);

/// BadUsage where two of the paths are one file, or one of them is an input. Empty paths are left out.
void require_outputs(const std::vector<fs::path>& outputs);

/// Gives a file or folder another name in the same place, so that it lasts: an older file of that name is
/// replaced at once.
void rename_durably(const fs::path& from, const fs::path& to);

/// The regular files in a folder, sorted; none where it is no folder.
std::vector<fs::path> files_in(const fs::path& folder);

/// Removes a file, if it is there; BadUsage for an input.
void remove_output(const fs::path& path);

/// Writes `text` whole or not at all.
void write_text(const fs::path& path, std::string_view text);

/// The whole file; BadInput if it cannot be read.
std::string read_text(const fs::path& path);

/// Creates the folder and its parents; BadInput if `path` is a file or cannot be created or written.
void make_folder(const fs::path& path);

/// The same for a folder within one that the program writes: a link there would lead out of it, which is
/// BadInput.
void make_inner_folder(const fs::path& path);

/// BadInput unless a file could be written at `path`: its folder is there and can be written. For the start
/// of long work; an empty path passes.
void require_writable(const fs::path& path);

/// BadInput unless `path` is a regular file (or, with `folder_allowed`, a folder) that can be opened.
void require_readable(const fs::path& path, bool folder_allowed = false);

/// SHA-256 in hexadecimal, of bytes or of a file's content (of a folder: of its files' names and contents).
std::string sha256(std::string_view bytes);
std::string sha256_of(const fs::path& path);

}  // namespace pendular
