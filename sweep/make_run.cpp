#include "sweep/make_run.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <set>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/model_version.h"
#include "base/parallel.h"
#include "base/path_kind.h"
#include "effects/compress.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/vtp.h"
#include "run_folder/run_folder.h"

namespace pendular::sweep {
namespace {

constexpr auto kSignEvery = std::chrono::seconds(30);

/// Gives signs of life for runs as long as it exists.
class SignsOfLife {
 public:
  SignsOfLife(const fs::path& folder, const std::vector<std::string>& hashes)
      : thread_([this, folder, hashes] { give(folder, hashes); }) {}
  ~SignsOfLife() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    end_.notify_all();
    thread_.join();
  }
  SignsOfLife(const SignsOfLife&) = delete;
  SignsOfLife& operator=(const SignsOfLife&) = delete;

 private:
  void give(const fs::path& folder, const std::vector<std::string>& hashes) {
    std::unique_lock lock(mutex_);
    while (!end_.wait_for(lock, kSignEvery, [this] { return ended_; })) {
      try {
        Store store(folder);
        for (const auto& hash : hashes) store.give_sign(hash);
      } catch (const Error&) {  // one sign missed does no harm
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;  // last: it uses the others
};

Provenance provenance_of(const RunRequest& request, const std::string& hash) {
  Provenance provenance;
  provenance.version = program_version();
  provenance.command = run_command(hash);
  provenance.seed = request.seed;
  return provenance;
}

/// The beads that the request starts from. Generated ones are kept in the store for the runs that share them,
/// and read from there also by the first, so that all start from the same bits.
Packing start_packing(const Store& store, const RunRequest& request) {
  const std::string name = packing_hash(request);
  const fs::path path = store.packing_path(name);
  const bool generated = request.packing.sha256.empty();
  if (generated && !is_there(path)) {
    Packing packing = generate_packing(request.sample, request.packing.seed);
    packing.provenance = {program_version(), "pendular sweep: packing " + name, request.packing.seed, {}};
    write_packing(path, packing);
  }
  if (!generated && sha256_of(path) != name)
    bad_input("{}: is not the packing that it was, remove it; the sweep copies it anew", path.string());
  Packing packing = read_packing(path);
  if (generated)
    packing.bridges =
        candidate_bridges(packing.beads, request.sample.bridges.cutoff * request.sample.beads.diameter);
  return packing;
}

/// Temporary files that a killed process has left.
void remove_leftovers(const fs::path& folder) {
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename().string().starts_with('.')) leftovers.push_back(entry.path());
  for (const auto& path : leftovers) fs::remove(path);
}

/// Books a run whose folder has its final name.
void book(Store& store, const std::string& hash, const RunRequest& request,
          const std::optional<Effort>& effort) {
  const fs::path folder = store.run_folder(hash);
  fs::remove(folder / "checkpoint.previous");  // only slow runs have one
  if (!request.keep_all) {
    fs::remove_all(folder / "checkpoint");
    if (request.sample.compression.frame_at.empty()) fs::remove_all(folder / run_file::kFrames);
  }
  store.finish(hash, effort);
}

/// A run that this process makes.
struct Making {
  std::string hash;
  RunRequest request;
  dem_core::CompressTask task;
};

/// Nothing where the run's folder is whole: it is booked.
std::optional<Making> begin(Store& store, const std::string& hash) {
  Making making = {hash, store.request(hash), {}};
  const RunRequest& request = making.request;
  if (content_hash(request) != hash)
    bad_input("run {}: was asked for by another version of the model, this is {}", hash, kModelVersion);
  const fs::path final_folder = store.run_folder(hash), folder = store.part_folder(hash);
  if (is_there(final_folder)) make_inner_folder(final_folder);
  if (is_there(final_folder)) {
    book(store, hash, request, std::nullopt);
    return std::nullopt;
  }
  make_inner_folder(folder);
  write_text(folder / "request.json", request_text(request));
  write_text(folder / "sample.toml", sample_text(request.sample));

  dem_core::CompressOptions options;
  options.resume = true;
  options.provenance = provenance_of(request, hash);
  const Packing packing = start_packing(store, request);
  options.provenance.inputs = {{"packing", sha256_of(store.packing_path(packing_hash(request)))}};
  making.task = effects::task_with_effects(packing, request.sample, request.seed, folder, options);
  return making;
}

void conclude(Store& store, const Making& making, const dem_core::CompressResult& done) {
  auto result = done.result;
  Effort effort;
  effort.particle_steps = result["beads"].get<double>() * result["steps"].get<double>();
  const double rate = result["performance"]["particle_steps_per_second"];
  effort.seconds = rate > 0.0 ? effort.particle_steps / rate : 0.0;
  effort.threads = static_cast<int>(thread_count());
  result.erase("performance");  // the only part that differs between two runs of the same work
  const fs::path folder = store.part_folder(making.hash);
  write_text(folder / run_file::kResult, result.dump(2) + "\n");
  remove_leftovers(folder);
  rename_durably(folder, store.run_folder(making.hash));
  book(store, making.hash, making.request, effort);
}

/// Does part of a run's work. A failure is recorded in the store and thrown; interrupted, the run waits
/// again.
template <typename Work>
void recorded(Store& store, const std::string& hash, const Work& work) {
  try {
    work();
  } catch (const Interrupted&) {
    store.give_back(hash);
    throw;
  } catch (const Error& error) {
    store.fail(hash, error.exit_status(), error.what());
    throw;
  } catch (const std::bad_alloc&) {
    store.fail(hash, 4, "out of memory");
    throw;
  } catch (const std::exception& error) {
    store.fail(hash, 4, error.what());
    throw;
  }
}

/// The same for one of several runs, of which the others go on: its log says why.
template <typename Work>
void recorded_for_itself(Store& store, const std::string& hash, const Work& work) {
  try {
    recorded(store, hash, work);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    write_text(store.log_path(hash), fmt::format("pendular: {}\n", error.what()));
  }
}

}  // namespace

std::string run_command(const std::string& hash) {
  return "pendular sweep: run " + hash;
}

void make_run(Store& store, const std::string& hash) {
  if (!store.take(hash)) return;
  const SignsOfLife signs(store.folder(), {hash});
  recorded(store, hash, [&] {
    if (const auto making = begin(store, hash)) conclude(store, *making, dem_core::compress(making->task));
  });
}

void make_side_by_side(Store& store, std::span<const std::string> hashes) {
  std::set<std::string> open;
  for (const auto& hash : hashes)
    if (store.take(hash)) open.insert(hash);
  const std::vector<std::string> taken(open.begin(), open.end());
  const SignsOfLife signs(store.folder(), taken);
  try {
    std::vector<Making> makings;
    std::vector<dem_core::CompressTask> tasks;
    for (const auto& hash : taken) {
      recorded_for_itself(store, hash, [&] {
        if (auto making = begin(store, hash)) makings.push_back(std::move(*making));
      });
      if (makings.size() == tasks.size())
        open.erase(hash);
      else
        tasks.push_back(std::move(makings.back().task));
    }
    const auto ended = [&](std::size_t k, const dem_core::CompressOutcome& outcome) {
      open.erase(makings[k].hash);
      recorded_for_itself(store, makings[k].hash, [&] {
        if (outcome.error) std::rethrow_exception(outcome.error);
        conclude(store, makings[k], *outcome.result);
      });
    };
    dem_core::compress_side_by_side(tasks, ended);
  } catch (const Interrupted&) {
    for (const auto& hash : open) store.give_back(hash);
    throw;
  }
  for (const auto& hash : open) store.give_back(hash);
}

}  // namespace pendular::sweep
