#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pendular {

/// Inflates a zlib or gzip stream (of one or several members) into `target`. Returns the bytes that the
/// stream holds, counted no further than one beyond the target; the target is filled up to there. What
/// follows a damaged place counts as not there.
std::uint64_t inflate_into(std::span<const std::byte> stored, std::span<std::byte> target);

/// The same without keeping anything, counted no further than one beyond `most`.
std::uint64_t inflated_size(std::span<const std::byte> stored, std::uint64_t most);

}  // namespace pendular
