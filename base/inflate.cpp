#include "base/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

namespace pendular {
namespace {

constexpr int kZlibOrGzip = 15 + 32;  // the library's code for: by the stream's own head
constexpr std::size_t kBlock = 1 << 20;

/// A stream that is read in blocks.
class Inflater {
 public:
  explicit Inflater(std::span<const std::byte> stored) : stored_(stored) {
    if (inflateInit2(&state_, kZlibOrGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&state_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills a block as far as the stream goes; returns how far.
  std::size_t next(std::span<std::byte> block) {
    state_.next_out = reinterpret_cast<Bytef*>(block.data());
    state_.avail_out = static_cast<uInt>(block.size());
    while (!ended_ && state_.avail_out > 0) step();
    return block.size() - state_.avail_out;
  }

 private:
  void step() {
    if (state_.avail_in == 0) {
      const std::size_t size = std::min(kBlock, stored_.size());
      state_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stored_.data()));  // zlib only reads
      state_.avail_in = static_cast<uInt>(size);
      stored_ = stored_.subspan(size);
    }
    const int status = inflate(&state_, Z_NO_FLUSH);
    const bool more = state_.avail_in > 0 || !stored_.empty();
    if (status == Z_STREAM_END)
      ended_ = !more || inflateReset(&state_) != Z_OK;  // another member
    else
      ended_ = status != Z_OK;
  }

  std::span<const std::byte> stored_;
  z_stream state_{};
  bool ended_ = false;
};

}  // namespace

std::uint64_t inflate_into(std::span<const std::byte> stored, std::span<std::byte> target) {
  Inflater inflater(stored);
  std::uint64_t done = 0;
  while (done < target.size()) {
    const std::size_t got =
        inflater.next(target.subspan(done, std::min<std::size_t>(kBlock, target.size() - done)));
    if (got == 0) return done;
    done += got;
  }
  std::array<std::byte, 1> beyond{};
  return done + inflater.next(beyond);
}

std::uint64_t inflated_size(std::span<const std::byte> stored, std::uint64_t most) {
  Inflater inflater(stored);
  std::array<std::byte, 1 << 16> block;
  std::uint64_t done = 0;
  while (done <= most) {
    const std::size_t got = inflater.next(block);
    if (got == 0) return done;
    done += got;
  }
  return most + 1;
}

}  // namespace pendular
