#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/csv.h"
#include "diagnosis/experiment/observation.h"
#include "diagnosis/kinds/features.h"
#include "diagnosis/kinds/simulated.h"

namespace pendular::diagnosis {

struct Experiment;

/// What a simulation offers in the place of an observation: the sample as it was simulated, and its test
/// where the kind needs one.
struct Simulated {
  const Sample& sample;
  const SimulatedTest* test = nullptr;
};

/// A key of an [[observation]] that only one kind knows.
struct KindKey {
  std::string name;
  std::vector<std::string> words;  ///< that it may hold, the first where it is absent; empty: a number
  double lowest = 0.0, highest = 0.0, otherwise = 0.0;  ///< of a number
};

/// How the kind is measured where an experiment lacks it.
struct UsualMeasurement {
  std::string name, why;
  double cost = 1.0;  ///< in units of one compression test
};

/// Where the strain that an observation states comes from. The machine's may be read wrongly; of a gauge's
/// and a scan's it is not stated whether they are the machine's or measured on the specimen. Of kinds without
/// a strain it says nothing.
enum class StrainBy { machine, gauge, scan };

/// What an observation shows that no effect of the library brings about, and how probable it is by chance.
struct Unlike {
  double by_chance = 1.0;
  std::string what = {};  ///< a clause
};

/// One kind of observation: everything that the diagnosis knows of it stands in the kind's own file. A hook
/// is null where the kind has no part in the question.
struct Kind {
  std::string name;
  std::vector<std::string> required = {}, optional = {};  ///< columns
  std::size_t least_rows = 1;
  Scale scale = Scale::aggregate;
  StrainBy strain_by = StrainBy::gauge;
  std::vector<KindKey> keys = {};
  /// With it, and `planned` and `shown`, the kind is among the further measurements.
  std::optional<UsualMeasurement> usual = {};
  bool of_bridges = false;  ///< single bridges: answered by what a sample says of them, without a test

  /// Further columns, from the file's cells that are no numbers and from the specimen's beads.
  std::function<void(Observation& observation, const CsvTable& table)> read = nullptr;
  /// BadInput for what cannot be: a wrong unit, a sign, an order. What is odd but usable goes into
  /// `warnings`.
  std::function<void(const Sample& believed, Observation& observation, std::vector<std::string>& warnings)>
      check = nullptr;
  /// Adds what its test must show to the course of the simulated one; null: needs none.
  std::function<void(const Observation& observation, Sample::Compression& course)> course = nullptr;
  /// The columns that the observation would have had.
  std::function<Columns(const Observation& observation, const Simulated& simulated)> simulate = nullptr;
  /// What a reader looks at, and what words are made of.
  std::function<std::vector<Feature>(const Observation& observation, const Columns& columns)> landmarks =
      nullptr;
  /// All that the columns say, at places that the observation fixes; null: the landmarks.
  std::function<std::vector<Feature>(const Observation& observation, const Columns& columns)> readings =
      nullptr;
  /// A displacement of every bead that was followed, without rigid motion and scale, m; three rows a bead.
  std::function<Eigen::VectorXd(const Observation& observation, const Columns& columns)> field = nullptr;
  /// What no effect of the library brings about, of the observation by itself.
  std::function<Unlike(const Observation& observation)> unlike = nullptr;
  /// Columns as another measurement of the same might have them.
  std::function<Columns(const Observation& observation, unsigned long seed)> perturbed = nullptr;
  /// Columns of such a measurement as it is usually made, up to a platen strain: where it reads and with
  /// which errors; what it will show is only rough. Null: it is not planned.
  std::function<Columns(const Observation& observation, const Sample& believed, double strain)> planned =
      nullptr;
  /// The planned columns once a simulation tells what they would show.
  std::function<Columns(const Observation& planned, const Columns& simulated)> shown = nullptr;
  /// Covariance of what the simulation itself may be off in these features, as they are compared.
  std::function<Eigen::MatrixXd(const std::vector<Feature>& features)> model_error = nullptr;
};

/// Every kind, in the order of the documentation, then those that were added. Adding one: its file, its test,
/// its line in list.cpp.
const std::vector<const Kind*>& all_kinds();

/// A kind that is no part of the library, at the end of the list as long as this lives. Add it before
/// anything reads an experiment and remove it after, on one thread.
class AddedKind {
 public:
  /// The kind must outlive this. BadInput where its name is empty or known already, or it lacks columns or
  /// one of the hooks simulate, landmarks, perturbed and model_error.
  explicit AddedKind(const Kind& kind);
  ~AddedKind();
  AddedKind(const AddedKind&) = delete;
  AddedKind& operator=(const AddedKind&) = delete;

 private:
  const Kind& kind_;
};

/// BadInput, opening with `where`, names the nearest one where there is none.
const Kind* find_kind(const std::string& name, const std::string& where);

namespace kinds {
const Kind& compression();
const Kind& lateral_strain();
const Kind& modulus_series();
const Kind& bridge_stiffness();
const Kind& bridge_diameters();
const Kind& bridge_gaps();
const Kind& coordination();
const Kind& displacements();
const Kind& bridges();
const Kind& broken_bonds();
}  // namespace kinds

}  // namespace pendular::diagnosis
