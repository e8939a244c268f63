#pragma once

#include <Eigen/Core>

#include <functional>
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

/// One kind of observation: everything that the diagnosis knows of it stands in the kind's own file. A hook
/// is null where the kind has no part in the question.
struct Kind {
  std::string name;
  std::vector<std::string> required = {}, optional = {};  ///< columns
  std::size_t least_rows = 1;
  Scale scale = Scale::aggregate;
  std::vector<KindKey> keys = {};
  bool of_bridges = false;  ///< single bridges: answered by what a sample says of them, without a test

  /// Further columns, from the file's cells that are no numbers and from the specimen's beads.
  void (*read)(Observation& observation, const CsvTable& table) = nullptr;
  /// BadInput for what cannot be: a wrong unit, a sign, an order. What is odd but usable goes into
  /// `warnings`.
  void (*check)(const Sample& believed, Observation& observation,
                std::vector<std::string>& warnings) = nullptr;
  /// Adds what its test must show to the course of the simulated one; null: needs none.
  void (*course)(const Observation& observation, Sample::Compression& course) = nullptr;
  /// The columns that the observation would have had.
  Columns (*simulate)(const Observation& observation, const Simulated& simulated) = nullptr;
  /// What a reader looks at, and what words are made of.
  std::vector<Feature> (*landmarks)(const Observation& observation, const Columns& columns) = nullptr;
  /// All that the columns say, at places that the observation fixes; null: the landmarks.
  std::vector<Feature> (*readings)(const Observation& observation, const Columns& columns) = nullptr;
  /// A displacement of every bead that was followed, without rigid motion and scale, m; three rows a bead.
  Eigen::VectorXd (*field)(const Observation& observation, const Columns& columns) = nullptr;
  /// Columns as another measurement of the same might have them.
  Columns (*perturbed)(const Observation& observation, unsigned long seed) = nullptr;
  /// Columns of such a measurement as it is usually made, up to a platen strain: where it reads and with
  /// which errors; what it will show is only rough. Null: it is not planned.
  Columns (*planned)(const Observation& observation, const Sample& believed, double strain) = nullptr;
  /// The planned columns once a simulation tells what they would show.
  Columns (*shown)(const Observation& planned, const Columns& simulated) = nullptr;
  /// Covariance of what the simulation itself may be off in these features, as they are compared.
  Eigen::MatrixXd (*model_error)(const std::vector<Feature>& features) = nullptr;
};

/// Every kind, in the order of the documentation. Adding one: its file, its test, its line in list.cpp.
const std::vector<const Kind*>& all_kinds();

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
