#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "diagnosis/kinds/displacement_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/similarity.h"
#include "diagnosis/kinds/tools.h"
#include "packing/bridges.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr std::size_t kLeastBeads = 20;
// Of the strain of a scan: frames that tell the displacements also where the strain is misread.
constexpr double kShares[] = {0.4, 0.7, 1.0};
constexpr double kElsewhere = 0.25;  // rms of motion over bead diameters, beyond which beads are others
constexpr double kSamePlace = 0.1;   // likewise of places at rest
constexpr double kStill = 0.003;  // rms of motion over the platen's way, below which beads do not take part
constexpr double kAlongAxis = 0.75;  // least cosine to z of the direction in which beads approach most
constexpr double kNeighbours = 0.1;  // gap over bead diameter
constexpr double kAlike = 0.7;       // of neighbours' difference over that of any two beads, mean squares
constexpr double kAffine = 0.1;      // share of motion that is affine; that of other beads has less
constexpr double kByChance = 8.0;    // that share times the beads, by chance
constexpr double kSeen = 4.0;        // of motion over its error, from which neighbours can be compared
constexpr double kUsualError = 0.1;  // of a bead's motion as it is usually measured, um
constexpr double kUnstated = 0.005;  // of that error over bead diameters, where none is stated

using Names = std::array<const char*, 3>;
constexpr Names kPlaces = {"x_um", "y_um", "z_um"}, kMotions = {"ux_um", "uy_um", "uz_um"};

/// Columns in µm as vectors in m.
std::vector<Vec3> vectors_in(const Columns& columns, const Names& names) {
  std::vector<Vec3> all(columns.at(names[0]).size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& column = columns.at(names[axis]);
    for (std::size_t k = 0; k < all.size(); ++k) all[k][static_cast<int>(axis)] = column[k] / kUm;
  }
  return all;
}

std::vector<Vec3> places_in(const Columns& columns) {
  return vectors_in(columns, kPlaces);
}

std::vector<Vec3> motions_in(const Columns& columns) {
  return vectors_in(columns, kMotions);
}

/// The rows of one scan.
Columns rows_at(const Columns& columns, double strain) {
  Columns rows;
  const auto& strains = columns.at("strain");
  for (const auto& [name, column] : columns) {
    auto& kept = rows[name];
    for (std::size_t k = 0; k < column.size(); ++k)
      if (strains[k] == strain) kept.push_back(column[k]);
  }
  return rows;
}

std::set<double> scans_in(const Columns& columns) {
  const auto& strain = columns.at("strain");
  return {strain.begin(), strain.end()};
}

/// The rows with this motion, m, in the place of their own.
Columns with_motion(Columns rows, const std::vector<Vec3>& motion) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& column = rows[kMotions[axis]];
    for (std::size_t k = 0; k < motion.size(); ++k) column[k] = kUm * motion[k][static_cast<int>(axis)];
  }
  return rows;
}

/// The ids and places are those of the specimen's table.
void check_places(const Observation& observation, const CsvTable& table) {
  if (observation.beads.empty()) return;
  std::map<std::int64_t, Vec3> known;
  double diameter = 0.0;
  for (const auto& bead : read_beads(observation.beads))
    known[bead.id] = bead.centre, diameter = std::max(diameter, bead.diameter);
  const auto ids = table.integers("bead_id");
  const auto rest = places_in(observation.columns);
  double square = 0.0, extent = 0.0, stated = 0.0;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto found = known.find(ids[k]);
    if (found == known.end())
      bad_input("{}: column bead_id: found bead {}, expected one of those of {}", table.where(k), ids[k],
                observation.beads.string());
    square += (rest[k] - found->second).squaredNorm() / static_cast<double>(ids.size());
    extent = std::max(extent, found->second.norm()), stated = std::max(stated, rest[k].norm());
  }
  if (std::sqrt(square) <= kSamePlace * diameter) return;
  bad_input(
      "{}: found beads {:.3g} um (rms) from where {} has them, expected the same places at rest (is it {}?)",
      observation.file.string(), kUm * std::sqrt(square), observation.beads.string(),
      stated < 1e-5 * extent   ? "in m"
      : stated < 1e-2 * extent ? "in mm"
                               : "another specimen, or turned or mirrored");
}

/// Beads that came loose roll on their own: where they end says nothing of the specimen.
void leave_out_loose(Observation& observation, const CsvTable& table) {
  if (!table.has("state")) return;
  const auto& state = table.texts("state");
  for (auto& [name, column] : observation.columns) {
    std::vector<double> kept;
    for (std::size_t k = 0; k < column.size(); ++k)
      if (state[k] != "loose") kept.push_back(column[k]);
    column = std::move(kept);
  }
}

void read(Observation& observation, const CsvTable& table) {
  check_places(observation, table);
  leave_out_loose(observation, table);
  if (observation.rows() < kLeastBeads)
    bad_input("{}: found {} beads that are not loose, expected at least {}", observation.file.string(),
              observation.rows(), kLeastBeads);
}

double mean_square(const std::vector<Vec3>& all) {
  double sum = 0.0;
  for (const Vec3& one : all) sum += one.squaredNorm() / static_cast<double>(all.size());
  return sum;
}

/// Mean square difference of neighbours' motion over that of any two beads: small where the motion is that of
/// these beads, one where it is that of others. 0 where there are no neighbours.
double unlikeness(const std::vector<Bead>& beads, const std::vector<Vec3>& motion) {
  const auto pairs = candidate_bridges(beads, kNeighbours * mean_diameter(beads));
  double sum = 0.0;
  for (const auto& pair : pairs)
    sum +=
        (motion[static_cast<std::size_t>(pair.i)] - motion[static_cast<std::size_t>(pair.j)]).squaredNorm() /
        static_cast<double>(pairs.size());
  return sum / (2.0 * mean_square(motion));  // its mean is taken off
}

/// Of motion without its rigid part: what is affine of it.
struct AffineMotion {
  double share = 0.0;     ///< of its square
  double approach = 0.0;  ///< cosine to z of the direction in which beads approach most
};

AffineMotion affine_part(const std::vector<Vec3>& places, const std::vector<Vec3>& motion) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& at : places) middle += at / static_cast<double>(places.size());
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero(), inertia = product;
  for (std::size_t k = 0; k < places.size(); ++k) {
    product += motion[k] * (places[k] - middle).transpose();
    inertia += (places[k] - middle) * (places[k] - middle).transpose();
  }
  const Eigen::Matrix3d gradient = product * inertia.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> strain(0.5 * (gradient + gradient.transpose()));
  const double square = (gradient * product.transpose()).trace();
  return {square / (static_cast<double>(motion.size()) * mean_square(motion)),
          std::fabs(strain.eigenvectors()(2, 0))};
}

/// The followed beads, as the specimen's table has them.
std::vector<Bead> beads_in(const Observation& observation, const Columns& rows) {
  std::map<double, Bead> by_id;
  for (const auto& bead : read_beads(observation.beads)) by_id[static_cast<double>(bead.id)] = bead;
  std::vector<Bead> followed;
  for (const double id : rows.at("bead_id")) followed.push_back(by_id.at(id));
  return followed;
}

/// That the motion at one strain can be that of these beads between platens that approach along z. Where
/// places are worse than stated, neighbours seem to move on their own; other beads' motion is not affine
/// either.
void check_motion(const Sample& believed, const Observation& observation, const Columns& rows, double strain,
                  std::vector<std::string>& warnings) {
  const std::string file = observation.file.string();
  const auto places = places_in(rows), motion = without_rigid_motion(places, motions_in(rows));
  const double rms = std::sqrt(mean_square(motion)), way = strain * believed.specimen.height,
               diameter = believed.beads.diameter;
  if (rms > std::max(kElsewhere * diameter, 0.5 * way))
    bad_input(
        "{}: found displacements of {:.3g} um (rms) beside any rigid motion at strain {:.4g}, expected those "
        "of one specimen (beads of another, mirrored, or in another unit?)",
        file, kUm * rms, strain);
  if (rms < kStill * way)
    bad_input(
        "{}: found displacements of {:.3g} um (rms) beside any rigid motion at strain {:.4g}, expected about "
        "{:.3g} um "
        "(are they in {}?)",
        file, kUm * rms, strain, 0.2 * kUm * way, rms < 1e-5 * way ? "m" : "mm");
  const double sigma =
      observation.has("sigma_um") ? mean_of(rows.at("sigma_um")) / kUm : kUnstated * diameter;
  if (rms < kSeen * sigma) return;
  const AffineMotion affine = affine_part(places, motion);
  const bool unlike = !observation.beads.empty() && unlikeness(beads_in(observation, rows), motion) > kAlike;
  const double least_share = kAffine + kByChance / static_cast<double>(motion.size());
  if (unlike && !(affine.share >= least_share))
    bad_input(
        "{}: found neighbours that move as differently as any two beads at strain {:.4g}, expected the "
        "motion of the "
        "beads of {} (another specimen, or other ids?)",
        file, strain, observation.beads.string());
  if (affine.approach < kAlongAxis)
    bad_input(
        "{}: found beads that approach most at {:.0f} degrees to z at strain {:.4g}, expected along z, as "
        "platens do "
        "(turned, mirrored, or of the other sign?)",
        file, std::acos(affine.approach) * 180.0 / M_PI, strain);
  if (unlike)
    warnings.push_back(fmt::format(
        "{}: at strain {:.4g} neighbours move nearly as differently as any two beads, more than "
        "errors of {:.2g} um explain: are places worse than stated, or beads of another specimen?",
        file, strain, kUm * sigma));
}

void check(const Sample& believed, Observation& observation, std::vector<std::string>& warnings) {
  const std::string file = observation.file.string();
  check_strain(observation, "strain");
  check_sigma(observation, "sigma_um", kUm * believed.beads.diameter);
  for (double strain : scans_in(observation.columns)) {
    if (strain <= 0.0)
      bad_input("{}: strain: found {:.4g}, expected the platen strain of a second scan, above 0", file,
                strain);
    const Columns rows = rows_at(observation.columns, strain);
    if (std::set<double>(rows.at("bead_id").begin(), rows.at("bead_id").end()).size() !=
        rows.at("bead_id").size())
      bad_input("{}: column bead_id: found a bead twice in the scan at strain {:.4g}, expected each once",
                file, strain);
    check_motion(believed, observation, rows, strain, warnings);
  }
}

void course(const Observation& observation, Sample::Compression& course) {
  course.frame_at.push_back(kRestStrain);  // as `bridges` at rest asks for: they share their runs
  for (double strain : scans_in(observation.columns))
    for (double share : kShares) course.frame_at.push_back(share * strain);
}

/// What a simulated scan shows of the observed beads, or of all where none were measured.
Columns simulate(const Observation& observation, const Simulated& simulated) {
  Columns columns;
  for (double strain : scans_in(observation.columns)) {
    const Frame& frame = frame_near(*simulated.test, strain);
    const double scale = strain / frame.strain;
    std::map<std::int64_t, std::size_t> index;
    for (std::size_t k = 0; k < frame.ids.size(); ++k) index[frame.ids[k]] = k;
    const auto ids = rows_at(observation.columns, strain).at("bead_id");
    std::vector<std::size_t> seen;
    if (observation.beads.empty())
      for (std::size_t k = 0; k < frame.ids.size(); ++k) seen.push_back(k);
    else
      for (double id : ids) seen.push_back(index.at(static_cast<std::int64_t>(id)));
    auto &strains = columns["strain"], &found = columns["bead_id"];
    strains.insert(strains.end(), seen.size(), strain);
    for (const std::size_t k : seen) found.push_back(static_cast<double>(frame.ids[k]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto &places = columns[kPlaces[axis]], &motions = columns[kMotions[axis]];
      for (const std::size_t k : seen) {
        places.push_back(kUm * frame.rest[k][static_cast<int>(axis)]);
        motions.push_back(kUm * scale * frame.displacement[k][static_cast<int>(axis)]);
      }
    }
  }
  return columns;
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::network);
  const Columns last = rows_at(columns, *scans_in(columns).rbegin());
  const auto motion = without_rigid_motion(places_in(last), motions_in(last));
  for (const auto& [name, value] : displacement_signature(with_motion(last, motion)))
    list.difference(name, value);
  return list.take();
}

Eigen::VectorXd field(const Observation&, const Columns& columns) {
  std::vector<double> all;
  for (double strain : scans_in(columns)) {
    const Columns rows = rows_at(columns, strain);
    for (const Vec3& u : without_rigid_motion(places_in(rows), motions_in(rows)))
      all.insert(all.end(), u.data(), u.data() + 3);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  if (!columns.contains("sigma_um")) {
    draw_rows_again(columns, seed);
    return columns;
  }
  for (const char* name : {"ux_um", "uy_um", "uz_um"})
    add_noise(columns[name], columns.at("sigma_um"), random_bits(seed, static_cast<unsigned char>(name[1])));
  return columns;
}

/// Every bead of the specimen, followed. The motion of a bead is rough: along the axis, by its height.
Columns planned(const Observation& observation, const Sample&, double strain) {
  Columns columns;
  for (const auto& bead : read_beads(observation.beads)) {
    columns["strain"].push_back(strain);
    columns["bead_id"].push_back(static_cast<double>(bead.id));
    for (int axis = 0; axis < 3; ++axis) {
      columns[kPlaces[static_cast<std::size_t>(axis)]].push_back(kUm * bead.centre[axis]);
      columns[kMotions[static_cast<std::size_t>(axis)]].push_back(
          axis == 2 ? -kUm * strain * bead.centre[axis] : 0.0);
    }
    columns["sigma_um"].push_back(kUsualError);
  }
  return columns;
}

Columns shown(const Observation& planned, const Columns& simulated) {
  Columns columns = simulated;
  columns["sigma_um"].assign(simulated.at("strain").size(), planned.column("sigma_um").front());
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  return errors_by_name(features, {{"deviatoric_share", 0.02}, {"tilt_share", 0.02}, {"wandering", 0.05}});
}

}  // namespace

/// Beads followed from a scan at rest to scans under load. Rigid motion and a change of scale are fitted and
/// taken off, of what was measured and of what is simulated alike.
const Kind& kinds::displacements() {
  static const Kind kind{.name = "displacements",
                         .required = {"strain", "bead_id", "x_um", "y_um", "z_um", "ux_um", "uy_um", "uz_um"},
                         .optional = {"sigma_um"},
                         .least_rows = kLeastBeads,
                         .scale = Scale::network,
                         .strain_by = StrainBy::scan,
                         .read = read,
                         .check = check,
                         .course = course,
                         .simulate = simulate,
                         .landmarks = landmarks,
                         .field = field,
                         .perturbed = perturbed,
                         .planned = planned,
                         .shown = shown,
                         .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
