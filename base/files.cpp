#include "base/files.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/path_kind.h"

namespace pendular {
namespace {

/// A temporary name in the same folder, with the same extension so that writers which look at it agree.
fs::path temporary_beside(const fs::path& path) {
  return path.parent_path() /
         fmt::format(".{}.{}.tmp{}", path.stem().string(), ::getpid(), path.extension().string());
}

/// Flushes a finished file, or the names in a folder, to the disc, which is where a full disc is noticed at
/// the latest.
void sync_to_disc(const fs::path& path, const fs::path& said) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw ComputationFailed(fmt::format("{}: was not written: {}", said.string(), std::strerror(errno)));
  const int failed = ::fsync(descriptor);
  const int why = errno;
  ::close(descriptor);
  if (failed != 0 && why != EINVAL && why != EROFS)  // file systems without it
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", said.string(), std::strerror(why)));
}

using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identity_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return Identity(status.st_dev, status.st_ino);
}

/// What this process has to keep in mind of its files.
struct Files {
  std::mutex mutex;
  std::set<Identity> inputs;
  bool together = false;
  std::vector<std::pair<fs::path, fs::path>> unnamed;  ///< temporary and final name
};

Files& files() {
  static Files all;
  return all;
}

bool is_input(const fs::path& path) {
  const auto identity = identity_of(path);
  const std::lock_guard lock(files().mutex);
  return identity && files().inputs.count(*identity) != 0;
}

void require_no_input(const fs::path& path) {
  if (is_input(path))
    throw BadUsage(
        fmt::format("{}: is an input of this command, expected another file to write", path.string()));
}

/// A regular file, a link to one, or nothing yet. A link to an open stream, as /dev/stdout, is none of these
/// even where that is a file.
void require_file_name(const fs::path& path) {
  std::error_code error;
  if (fs::is_symlink(path, error) && fs::read_symlink(path, error).string().starts_with("/proc/"))
    bad_input("{}: is a stream, expected a file name to write", path.string());
  const auto status = fs::status(path, error);
  if (fs::is_directory(status)) bad_input("{}: is a folder, expected a file name to write", path.string());
  if (fs::exists(status) && !fs::is_regular_file(status))
    bad_input("{}: is a device, expected a file name to write", path.string());
}

/// Why something failed, without the words of a library about files.
std::string reason(const std::exception& error) {
  const auto* of_files = dynamic_cast<const fs::filesystem_error*>(&error);
  return of_files ? of_files->code().message() : error.what();
}

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add(const void* bytes, std::size_t size) { EVP_DigestUpdate(context_.get(), bytes, size); }
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string text;
    for (unsigned k = 0; k < size; ++k) text += fmt::format("{:02x}", digest[k]);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

void add_file(Sha256& hash, const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) bad_input("{}: cannot be opened for reading", path.string());
  std::vector<char> block(1 << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    hash.add(block.data(), static_cast<std::size_t>(in.gcount()));
}

}  // namespace

void rename_durably(const fs::path& from, const fs::path& to) {
  fs::rename(from, to);
  sync_to_disc(to.has_parent_path() ? to.parent_path() : fs::path("."), to);
}

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  require_file_name(path);
  require_no_input(path);
  const fs::path temporary = temporary_beside(path);
  std::error_code ignored;
  try {
    write(temporary);
    sync_to_disc(temporary, path);
    const std::lock_guard lock(files().mutex);
    if (files().together)
      files().unnamed.emplace_back(temporary, path);
    else
      rename_durably(temporary, path);
  } catch (const Error&) {
    fs::remove(temporary, ignored);
    throw;
  } catch (const std::exception& error) {
    fs::remove(temporary, ignored);
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", path.string(), reason(error)));
  }
}

WrittenTogether::WrittenTogether() {
  const std::lock_guard lock(files().mutex);
  if (std::exchange(files().together, true)) throw std::logic_error("WrittenTogether: there is one already");
}

WrittenTogether::~WrittenTogether() {
  const std::lock_guard lock(files().mutex);
  std::error_code ignored;
  for (const auto& [temporary, path] : files().unnamed) fs::remove(temporary, ignored);
  files().unnamed.clear();
  files().together = false;
}

void WrittenTogether::commit() {
  const std::lock_guard lock(files().mutex);
  for (const auto& [temporary, path] : std::exchange(files().unnamed, {})) {
    try {
      rename_durably(temporary, path);
    } catch (const fs::filesystem_error& error) {
      throw ComputationFailed(fmt::format("{}: cannot be written: {}", path.string(), reason(error)));
    }
  }
}

void protect_inputs(const std::vector<fs::path>& inputs) {
  {
    const std::lock_guard lock(files().mutex);
    files().inputs.clear();
  }
  protect_also(inputs);
}

void protect_also(const std::vector<fs::path>& inputs) {
  const std::lock_guard lock(files().mutex);
  for (const auto& path : inputs)
    if (const auto identity = identity_of(path)) files().inputs.insert(*identity);
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

void require_outputs(const std::vector<fs::path>& outputs) {
  std::set<fs::path> names;
  std::set<Identity> there;
  for (const auto& path : outputs) {
    if (path.empty()) continue;
    require_no_input(path);
    std::error_code circle;  // of links: where its name leads is not known, and it is refused when written
    const fs::path followed = fs::weakly_canonical(path, circle);
    const bool new_name = names.insert(circle ? path.lexically_normal() : followed).second;
    const auto identity = identity_of(path);
    if (!new_name || (identity && !there.insert(*identity).second))
      throw BadUsage(
          fmt::format("{}: is to be written twice, expected a file for each output", path.string()));
  }
}

void remove_output(const fs::path& path) {
  require_no_input(path);
  fs::remove(path);
}

void write_text(const fs::path& path, std::string_view text) {
  write_atomically(path, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out)
      throw ComputationFailed(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  });
}

std::string read_text(const fs::path& path) {
  require_readable(path);
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);  // of what is no file there is none
  std::string text(error ? 4096 : static_cast<std::size_t>(size) + 1, '\0');
  std::size_t there = 0;
  const auto fill = [&] {
    in.read(text.data() + there, static_cast<std::streamsize>(text.size() - there));
    there += static_cast<std::size_t>(in.gcount());
    return static_cast<bool>(in);
  };
  while (fill()) text.resize(2 * text.size());
  text.resize(there);
  return text;
}

void make_folder(const fs::path& path) {
  std::error_code error;
  if (is_there(path) && !is_folder(path)) bad_input("{}: is a file, expected a folder", path.string());
  fs::create_directories(path, error);
  if (error) bad_input("{}: folder cannot be created: {}", path.string(), error.message());
  if (::access(path.c_str(), W_OK) != 0)
    bad_input("{}: folder cannot be written: {}", path.string(), std::strerror(errno));
}

void make_inner_folder(const fs::path& path) {
  std::error_code error;
  if (fs::is_symlink(path, error))
    bad_input("{}: is a link to elsewhere, expected a folder of its own", path.string());
  make_folder(path);
}

void require_writable(const fs::path& path) {
  if (path.empty()) return;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!is_folder(folder)) bad_input("{}: its folder does not exist", path.string());
  require_file_name(path);
  require_no_input(path);
  if (::access(folder.c_str(), W_OK) != 0)
    bad_input("{}: its folder cannot be written: {}", path.string(), std::strerror(errno));
}

void require_readable(const fs::path& path, bool folder_allowed) {
  if (!is_there(path)) bad_input("{}: no such file", path.string());
  if (is_folder(path)) {
    if (!folder_allowed) bad_input("{}: is a folder, expected a file", path.string());
    return;
  }
  if (!is_file(path)) bad_input("{}: is a device or a pipe, expected a file", path.string());
  if (::access(path.c_str(), R_OK) != 0)
    bad_input("{}: cannot be read: {}", path.string(), std::strerror(errno));
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

std::string sha256_of(const fs::path& path) {
  Sha256 hash;
  if (!is_folder(path)) {
    add_file(hash, path);
    return hash.hex();
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (is_file(entry.path())) names.push_back(entry.path().lexically_relative(path).generic_string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    hash.add(name.data(), name.size());
    add_file(hash, path / name);
  }
  return hash.hex();
}

}  // namespace pendular
