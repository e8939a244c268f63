#include "base/files.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "base/error.h"

namespace pendular {
namespace {

/// A temporary name in the same folder, with the same extension so that writers which look at it agree.
fs::path temporary_beside(const fs::path& path) {
  return path.parent_path() /
         fmt::format(".{}.{}.tmp{}", path.stem().string(), ::getpid(), path.extension().string());
}

/// Flushes a finished file to the disc, which is where a full disc is noticed at the latest.
void sync_to_disc(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0)
    throw ComputationFailed(fmt::format("{}: was not written: {}", path.string(), std::strerror(errno)));
  const int failed = ::fsync(descriptor);
  const int why = errno;
  ::close(descriptor);
  if (failed != 0)
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(why)));
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

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  if (fs::is_directory(path)) bad_input("{}: is a folder, expected a file name to write", path.string());
  const fs::path temporary = temporary_beside(path);
  std::error_code ignored;
  try {
    write(temporary);
    sync_to_disc(temporary);
    fs::rename(temporary, path);
  } catch (const Error&) {
    fs::remove(temporary, ignored);
    throw;
  } catch (const std::exception& error) {
    fs::remove(temporary, ignored);
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", path.string(), error.what()));
  }
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
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void make_folder(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    bad_input("{}: is a file, expected a folder", path.string());
  fs::create_directories(path, error);
  if (error) bad_input("{}: folder cannot be created: {}", path.string(), error.message());
  if (::access(path.c_str(), W_OK) != 0)
    bad_input("{}: folder cannot be written: {}", path.string(), std::strerror(errno));
}

void require_writable(const fs::path& path) {
  if (path.empty()) return;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) bad_input("{}: its folder does not exist", path.string());
  if (fs::is_directory(path)) bad_input("{}: is a folder, expected a file name to write", path.string());
  if (::access(folder.c_str(), W_OK) != 0)
    bad_input("{}: its folder cannot be written: {}", path.string(), std::strerror(errno));
}

void require_readable(const fs::path& path, bool folder_allowed) {
  std::error_code error;
  if (!fs::exists(path, error)) bad_input("{}: no such file", path.string());
  if (fs::is_directory(path, error)) {
    if (!folder_allowed) bad_input("{}: is a folder, expected a file", path.string());
    return;
  }
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
  if (!fs::is_directory(path)) {
    add_file(hash, path);
    return hash.hex();
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    hash.add(name.data(), name.size());
    add_file(hash, file);
  }
  return hash.hex();
}

}  // namespace pendular
