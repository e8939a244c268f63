#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "sweep/database.h"
#include "sweep/request.h"
#include "sweep/worker_id.h"

namespace pendular::sweep {

enum class RunStatus { waiting, running, done, failed };

std::string to_string(RunStatus status);

/// What the index knows of a run.
struct RunRecord {
  std::string hash;
  RunStatus status = RunStatus::waiting;
  int exit_status = 0;  ///< of a failed run
  std::string message;  ///< of a failed run
  WorkerId worker;      ///< of a running one
  bool worker_alive = false;

  /// Whether a worker may take it: nobody works on it.
  bool free() const {
    return status == RunStatus::waiting || (status == RunStatus::running && !worker_alive);
  }
};

/// What making a run took.
struct Effort {
  double particle_steps = 0.0;
  double seconds = 0.0;  ///< wall time
  int threads = 1;
};

/// A folder of runs, each once under the hash of its content:
///   index.sqlite         table `runs`, one row per run
///   runs/HASH/           a finished run, with its request (request.json) and sample (sample.toml)
///   runs/HASH.part/      one that is being made, was stopped, or failed (failed.json)
///   packings/HASH.vtp    the beads that runs start from
///   logs/HASH.txt        what its worker said
/// Any number of processes may use it at once; killed at any moment it stays whole. Where the index is absent
/// it is made from the run folders.
class Store {
 public:
  /// Opens or makes a store. BadInput where its index is damaged or of another version.
  explicit Store(const fs::path& folder);

  /// Whether there is a store in this folder.
  static bool exists(const fs::path& folder);

  const fs::path& folder() const { return folder_; }
  fs::path run_folder(const std::string& hash) const { return folder_ / "runs" / hash; }
  fs::path part_folder(const std::string& hash) const { return folder_ / "runs" / (hash + ".part"); }
  fs::path packing_path(const std::string& hash) const { return folder_ / "packings" / (hash + ".vtp"); }
  fs::path log_path(const std::string& hash) const { return folder_ / "logs" / (hash + ".txt"); }

  /// Enters runs that are not there yet, as waiting, and copies the packing files they need. A run that is
  /// entered as done but whose folder has gone waits again. Returns the hashes.
  std::vector<std::string> add(std::span<const RunRequest> requests);

  /// Records by hash; of hashes that are not there, nothing.
  std::map<std::string, RunRecord> records(std::span<const std::string> hashes);
  RunRecord record(const std::string& hash);  ///< BadInput where it is not there
  RunRequest request(const std::string& hash);

  /// Hash and request (request_text()) of every run that is done and whose folder is there.
  std::vector<std::pair<std::string, std::string>> finished();

  /// Makes this process the run's worker, unless it is done, has failed, or has a worker that lives.
  bool take(const std::string& hash);

  /// For the worker of a run: a sign of life; the end; failure; and giving it back, to be gone on with later.
  void give_sign(const std::string& hash);
  void finish(const std::string& hash, const std::optional<Effort>& effort);
  void fail(const std::string& hash, int exit_status, const std::string& message);
  void give_back(const std::string& hash);

  /// Lets a failed run wait again.
  void retry(const std::string& hash);

  /// Particle-steps per second and thread over all runs made here; nothing where there is none.
  std::optional<double> rate();

 private:
  void make_index();
  std::size_t enter_run_folders();

  fs::path folder_;
  Database index_;
};

}  // namespace pendular::sweep
