#include "dem_core/checkpoint.h"

#include <cstring>
#include <type_traits>

#include "base/error.h"
#include "base/model_version.h"
#include "base/path_kind.h"
#include "base/progress.h"

namespace pendular::dem_core {
namespace {

constexpr char kNewest[] = "checkpoint", kPrevious[] = "checkpoint.previous", kNext[] = "checkpoint.next";
constexpr char kMagic[] = "pendular checkpoint 8\n";

struct Writer {
  std::string bytes;
  template <typename T>
  void scalar(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::size_t length(std::size_t size) {
    scalar(size);
    return size;
  }
};

struct Reader {
  const std::string& bytes;
  std::size_t at;
  template <typename T>
  void scalar(T& value) {
    if (bytes.size() - at < sizeof value) throw BadInput("ends early");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
  }
  void scalar(bool& value) {
    unsigned char byte = 0;
    scalar(byte);
    if (byte > 1) throw BadInput("found a flag that is neither 0 nor 1");
    value = byte == 1;
  }
  std::size_t length(std::size_t) {
    std::size_t size = 0;
    scalar(size);
    if (size > bytes.size() - at) throw BadInput("ends early");
    return size;
  }
};

// Every field by name, once for reading and writing: what is forgotten here is lost at --resume.
template <typename Archive, typename T>
requires std::is_arithmetic_v<T>
void visit(Archive& archive, T& value) {
  archive.scalar(value);
}

template <typename Archive>
void visit(Archive& archive, Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) archive.scalar(v[axis]);
}

template <typename Archive>
void visit(Archive& archive, Triple<double>& v) {
  for (double* component : {&v.x, &v.y, &v.z}) archive.scalar(*component);
}

template <typename Archive, typename T>
void visit(Archive& archive, std::vector<T>& values) {
  values.resize(archive.length(values.size()));
  for (auto& value : values) visit(archive, value);
}

template <typename Archive, typename... Fields>
void fields(Archive& archive, Fields&... all) {
  (visit(archive, all), ...);
}

template <typename Archive>
void visit(Archive& a, Pair& p) {
  auto& [rest, touch, kn, kt, limit, bend, twist] = p.properties;
  auto& [bond_slip, contact_slip, turn, closing] = p.history;
  fields(a, p.i, p.j, p.bond, rest, touch, kn, kt, limit, bend, twist, bond_slip, contact_slip, turn,
         closing);
}

template <typename Archive>
void visit(Archive& a, Bond& b) {
  fields(a, b.i, b.j, b.broken, b.height);
}

template <typename Archive>
void visit(Archive& a, Platen& p) {
  fields(a, p.z, p.velocity, p.normal_sign, p.slip, p.closing, p.force, p.relief);
}

template <typename Archive>
void visit(Archive& a, BreakEvent& e) {
  fields(a, e.strain, e.i, e.j, e.place, e.stretch, e.shear, e.energy);
}

template <typename Archive>
void visit(Archive& a, BeadStates& b) {
  fields(a, b.position, b.velocity, b.spin, b.radius, b.mass, b.inertia, b.start);
}

template <typename Archive>
void visit(Archive& a, LawParameters& l) {
  fields(a, l.k_glass, l.kt_glass, l.hertz_overlap, l.friction, l.platen_friction, l.damping, l.one_spring,
         l.bond_friction_limit, l.bending, l.separate_limits);
}

template <typename Archive>
void visit(Archive& a, Simulation& s) {
  fields(a, s.law, s.stiffest, s.dt, s.steps, s.beads, s.pairs, s.bonds, s.bond_memory, s.bottom, s.top,
         s.initial_height, s.section, s.listing.at, s.listing.margin, s.listing.bottom_at, s.listing.top_at,
         s.listing.platen_margin, s.events, s.work.platen, s.work.damped, s.work.slipped, s.work.broken,
         s.work.halted, s.work.given);
}

template <typename Archive>
void visit(Archive& a, CurveRow& r) {
  for (const auto& column : curve_columns()) a.scalar(r.*column.field);
}

template <typename Archive>
void visit(Archive& a, PlatenProgress& p) {
  fields(a, p.unloadings_done, p.holds_done, p.unloading, p.holding, p.force_at_reversal, p.hold_until);
}

template <typename Archive>
void visit(Archive& a, RunState& s) {
  fields(a, s.simulation, s.rows, s.frames_written, s.platen, s.finished, s.open_row.strain, s.open_row.top,
         s.open_row.bottom, s.open_row.steps);
}

/// Every field of a packing but its provenance.
std::string content_of(const Packing& packing) {
  Writer writer;
  const auto add = [&](const auto&... values) { (writer.scalar(values), ...); };
  add(packing.beads.size());
  for (const auto& b : packing.beads)
    add(b.id, b.centre.x(), b.centre.y(), b.centre.z(), b.diameter, b.sigma_centre, b.sigma_diameter,
        b.quality, b.boundary);
  for (const auto& b : packing.bridges)
    add(b.i, b.j, b.gap, b.sigma_gap, b.probability, b.diameter, b.sigma_diameter, b.state);
  const Specimen& s = packing.specimen;
  add(s.diameter, s.height, s.axis_x, s.axis_y, s.bottom);
  return writer.bytes;
}

}  // namespace

std::string work_identity(const Packing& packing, const Sample& sample, const std::string& further) {
  return sha256(fmt::format("model {}\n{}\n{}\n{}", kModelVersion, sha256(content_of(packing)),
                            sample_text(sample), further));
}

void write_checkpoint(const fs::path& path, const RunState& state, const std::string& identity) {
  Writer writer;
  visit(writer, const_cast<RunState&>(state));  // the writer only reads
  write_text(path, kMagic + identity + "\n" + sha256(writer.bytes) + "\n" + writer.bytes);
}

RunState read_checkpoint(const fs::path& path, const std::string& identity) {
  const std::string bytes = read_text(path);
  const std::string magic = kMagic;
  if (bytes.compare(0, magic.size(), magic) != 0)
    bad_input("{}: is no checkpoint of this version of pendular", path.string());
  const std::size_t digest_at = bytes.find('\n', magic.size()) + 1;
  const std::size_t payload_at = digest_at + 65;
  if (digest_at == 0 || payload_at > bytes.size() || bytes[payload_at - 1] != '\n')
    bad_input("{}: checkpoint is cut short", path.string());
  if (bytes.substr(digest_at, 64) != sha256(std::string_view(bytes).substr(payload_at)))
    bad_input("{}: checkpoint is damaged: its checksum does not match", path.string());
  if (bytes.substr(magic.size(), digest_at - 1 - magic.size()) != identity)
    bad_input(
        "{}: checkpoint belongs to another packing, sample, seed or version; resume with the same or start "
        "anew",
        path.string());
  RunState state;
  Reader reader{bytes, payload_at};
  try {
    visit(reader, state);
    if (reader.at != bytes.size()) throw BadInput("goes on beyond its end");
  } catch (const BadInput& error) {
    bad_input("{}: checkpoint is damaged: {}", path.string(), error.what());
  }
  return state;
}

void keep_checkpoint(const fs::path& folder, const RunState& state, const std::string& identity) {
  const fs::path newest = folder / kNewest, next = folder / kNext;
  write_checkpoint(next, state, identity);
  if (is_there(newest)) rename_durably(newest, folder / kPrevious);
  rename_durably(next, newest);
}

std::optional<RunState> kept_checkpoint(const fs::path& folder, const std::string& identity) {
  const fs::path newest = folder / kNewest, previous = folder / kPrevious;
  if (!is_there(newest) && !is_there(previous)) return std::nullopt;
  std::string wrong;
  try {
    return read_checkpoint(newest, identity);
  } catch (const BadInput& error) {
    wrong = error.what();
  }
  if (!is_there(previous)) throw BadInput(wrong);
  RunState state;
  try {
    state = read_checkpoint(previous, identity);
  } catch (const BadInput& error) {
    throw BadInput(fmt::format("{}; nor can the one before be used: {}", wrong, error.what()));
  }
  warn(fmt::format("{}; going on from the one before, {}", wrong, previous.string()));
  fs::remove(newest);  // or the next one would push the good one out
  return state;
}

void remove_checkpoints(const fs::path& folder) {
  for (const char* name : {kNewest, kPrevious, kNext}) fs::remove(folder / name);
}

}  // namespace pendular::dem_core
