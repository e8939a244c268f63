#include "packing/exchange_spam.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "packing/word_lines.h"

namespace pendular {
namespace {

constexpr int kConverged = 2;

/// The header's names and where they stand.
class Header {
 public:
  explicit Header(const WordLine& line) : line_(line) {}

  std::optional<std::size_t> find(const std::vector<const char*>& names) const {
    for (const char* name : names) {
      const auto at = std::find(line_.words.begin(), line_.words.end(), name);
      if (at != line_.words.end()) return static_cast<std::size_t>(at - line_.words.begin());
    }
    return std::nullopt;
  }
  std::size_t need(const std::vector<const char*>& names) const {
    const auto found = find(names);
    if (!found)
      bad_input("{}: found no column {}, expected a table of spam", line_.where, fmt::join(names, " or "));
    return *found;
  }
  std::array<std::size_t, 3> need_vector(const std::string& ending) const {
    std::array<std::size_t, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = need({(std::string(1, "XYZ"[axis]) + ending).c_str()});
    return at;
  }

 private:
  const WordLine& line_;
};

/// Three numbers of a line, in voxels; nothing where one is nan, as of a label that has no bead.
std::optional<Vec3> vector_at(const WordLine& line, const std::array<std::size_t, 3>& columns) {
  Vec3 found;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (line.words[columns[axis]] == "nan") return std::nullopt;
    found[static_cast<Eigen::Index>(axis)] = line.number(columns[axis]);
  }
  return found;
}

}  // namespace

std::vector<Bead> read_spam(const fs::path& path, const SpamTable& how, std::optional<double> diameter) {
  if (!how.voxel) throw BadUsage("format spam is in voxels: the voxel size is needed (--voxel-um)");
  const auto lines = read_word_lines(path);
  if (lines.empty()) bad_input("{}: found nothing, expected a table of spam", path.string());
  const Header header(lines.front());
  const std::size_t label = header.need({"Label", "NodeNumber"});
  const auto place = header.need_vector("pos");
  const auto radius = header.find({"radius", "Radius"});
  if (!radius && !diameter)
    throw BadUsage(fmt::format("{}: found no column radius: the bead diameter is needed (--diameter-um)",
                               path.string()));
  std::array<std::size_t, 3> moved{};
  std::size_t status = 0;
  if (how.displaced) {
    moved = header.need_vector("disp");
    status = header.need({"returnStatus", "SubPixReturnStat"});
  }
  std::vector<Bead> beads;
  std::size_t nowhere = 0, failed = 0;
  for (std::size_t row = 1; row < lines.size(); ++row) {
    const WordLine& line = lines[row];
    line.require(lines.front().words.size(), "as many as the header has");
    // Labels are written as floating numbers.
    const double number = line.number(label);
    if (number != std::floor(number) || std::fabs(number) > 1e15)
      bad_input("{}: word {}: found {}, expected a whole number", line.where, label + 1, line.words[label]);
    if (number == 0.0) continue;
    auto at = vector_at(line, place);
    if (!at || *at == Vec3::Zero()) {
      ++nowhere;
      continue;
    }
    if (how.displaced) {
      const auto step = vector_at(line, moved);
      if (!step || line.number(status) != kConverged) {
        ++failed;
        continue;
      }
      *at += *step;
    }
    Bead bead;
    bead.id = static_cast<std::int64_t>(number);
    bead.centre = *how.voxel * *at;
    bead.diameter = radius ? 2.0 * *how.voxel * line.number(*radius) : *diameter;
    beads.push_back(bead);
  }
  if (nowhere + failed > 0)
    warn(fmt::format("{}: left out {} labels without a place and {} that did not converge, of {}",
                     path.string(), nowhere, failed, lines.size() - 1));
  if (beads.empty()) bad_input("{}: found no beads, expected at least one", path.string());
  return beads;
}

}  // namespace pendular
