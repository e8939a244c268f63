#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace pendular {

namespace fs = std::filesystem;

/// Calls `write` with a temporary path beside `path` (same extension), makes the result durable and
/// renames it to `path`: the file is there whole or not at all. The temporary file is removed on any error.
/// Throws ComputationFailed where the disc is full or the folder cannot be written.
void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write);

/// Writes `text` whole or not at all.
void write_text(const fs::path& path, std::string_view text);

/// The whole file; BadInput if it cannot be read.
std::string read_text(const fs::path& path);

/// Creates the folder and its parents; BadInput if `path` is a file or cannot be created or written.
void make_folder(const fs::path& path);

/// BadInput unless a file could be written at `path`: its folder is there and can be written. For the start
/// of long work; an empty path passes.
void require_writable(const fs::path& path);

/// BadInput unless `path` is a regular file (or, with `folder_allowed`, a folder) that can be opened.
void require_readable(const fs::path& path, bool folder_allowed = false);

/// SHA-256 in hexadecimal, of bytes or of a file's content (of a folder: of its files' names and contents).
std::string sha256(std::string_view bytes);
std::string sha256_of(const fs::path& path);

}  // namespace pendular
