#include "sweep/make_run.h"

#include <condition_variable>
#include <mutex>
#include <new>
#include <thread>

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

/// Gives signs of life for a run as long as it exists.
class SignsOfLife {
 public:
  SignsOfLife(const fs::path& folder, const std::string& hash)
      : thread_([this, folder, hash] { give(folder, hash); }) {}
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
  void give(const fs::path& folder, const std::string& hash) {
    std::unique_lock lock(mutex_);
    while (!end_.wait_for(lock, kSignEvery, [this] { return ended_; })) {
      try {
        Store(folder).give_sign(hash);
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

void make(Store& store, const std::string& hash) {
  const RunRequest request = store.request(hash);
  if (content_hash(request) != hash)
    bad_input("run {}: was asked for by another version of the model, this is {}", hash, kModelVersion);
  const fs::path final_folder = store.run_folder(hash), folder = store.part_folder(hash);
  if (is_there(final_folder)) make_inner_folder(final_folder);
  if (is_there(final_folder)) return book(store, hash, request, std::nullopt);
  make_inner_folder(folder);
  write_text(folder / "request.json", request_text(request));
  write_text(folder / "sample.toml", sample_text(request.sample));

  dem_core::CompressOptions options;
  options.resume = true;
  options.provenance = provenance_of(request, hash);
  const Packing packing = start_packing(store, request);
  options.provenance.inputs = {{"packing", sha256_of(store.packing_path(packing_hash(request)))}};
  auto result = effects::compress_with_effects(packing, request.sample, request.seed, folder, options).result;

  Effort effort;
  effort.particle_steps = result["beads"].get<double>() * result["steps"].get<double>();
  const double rate = result["performance"]["particle_steps_per_second"];
  effort.seconds = rate > 0.0 ? effort.particle_steps / rate : 0.0;
  effort.threads = static_cast<int>(thread_count());
  result.erase("performance");  // the only part that differs between two runs of the same work
  write_text(folder / run_file::kResult, result.dump(2) + "\n");
  remove_leftovers(folder);
  rename_durably(folder, final_folder);
  book(store, hash, request, effort);
}

}  // namespace

std::string run_command(const std::string& hash) {
  return "pendular sweep: run " + hash;
}

void make_run(Store& store, const std::string& hash) {
  if (!store.take(hash)) return;
  const SignsOfLife signs(store.folder(), hash);
  try {
    make(store, hash);
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

}  // namespace pendular::sweep
