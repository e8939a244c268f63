#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"

namespace pendular::test {

/// Writes `rounds` damaged variants of a good file (bytes flipped, runs overwritten, cut, repeated) to `path`
/// and reads each. A reader may accept what it can make sense of, or throw pendular::Error; anything else
/// fails.
inline void read_mutations(const fs::path& path, const std::string& good, int rounds,
                           const std::function<void(const fs::path&)>& read) {
  for (int round = 0; round < rounds; ++round) {
    std::uint64_t draw = 0;
    const auto below = [&](std::size_t limit) {
      return static_cast<std::size_t>(random_uniform(static_cast<std::uint64_t>(round), draw++) *
                                      static_cast<double>(limit));
    };
    // Headers decide how the rest is read: half of the damage goes there.
    const auto place = [&](std::size_t size) {
      return below(2) ? below(std::min<std::size_t>(size, 600)) : below(size);
    };
    std::string bad = good;
    for (std::size_t n = 1 + below(3); n > 0 && !bad.empty(); --n) {
      switch (below(5)) {
        case 0:
          bad[place(bad.size())] ^= static_cast<char>(1 << below(8));
          break;
        case 1:
          bad[place(bad.size())] = static_cast<char>(below(256));
          break;
        case 2:
          bad.resize(place(bad.size()));
          break;
        case 3: {
          const std::string piece = bad.substr(place(bad.size()), 40);
          bad.insert(place(bad.size()), piece);
          break;
        }
        default:
          bad.replace(place(bad.size()), 3, "-99999999999");
          break;
      }
    }
    write_text(path, bad);
    try {
      read(path);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos)
          << "round " << round << ": " << error.what();
    }
  }
}

}  // namespace pendular::test
