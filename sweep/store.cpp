#include "sweep/store.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/path_kind.h"
#include "base/progress.h"

namespace pendular::sweep {
namespace {

constexpr std::int64_t kVersion = 1;
constexpr const char* kIndex = "index.sqlite";
constexpr const char* kFailure = "failed.json";

/// All that an index holds beside SQLite's own.
constexpr const char* kTable =
    "CREATE TABLE runs (hash TEXT PRIMARY KEY, status TEXT NOT NULL, exit_status INTEGER, message TEXT,"
    " particle_steps REAL, wall_s REAL, threads INTEGER,"
    " host TEXT, pid INTEGER, started INTEGER, sign INTEGER, request TEXT NOT NULL)";
constexpr const char* kByStatus = "CREATE INDEX runs_by_status ON runs (status)";

/// The columns that a RunRecord is read from.
constexpr const char* kRecord =
    "SELECT hash, status, exit_status, message, host, pid, started, sign FROM runs";

std::int64_t now() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::seconds>(system_clock::now().time_since_epoch()).count();
}

const fs::path& with_folders(const fs::path& folder) {
  for (const char* name : {"runs", "packings", "logs"}) make_inner_folder(folder / name);
  return folder;
}

template <typename T>
T value_or(const Database::Cell& cell, T absent) {
  const T* held = std::get_if<T>(&cell);
  return held ? *held : absent;
}

RunStatus status_of(const std::string& word) {
  for (const auto status : {RunStatus::running, RunStatus::done, RunStatus::failed})
    if (to_string(status) == word) return status;
  return RunStatus::waiting;
}

/// Whether failed.json says what Store::fail() writes.
bool is_failure(const nlohmann::json& json) {
  return json.is_object() && json.contains("exit_status") && json["exit_status"].is_number_integer() &&
         json.contains("message") && json["message"].is_string();
}

RunRecord record_of(const Database::Row& row) {
  RunRecord record;
  record.hash = value_or<std::string>(row[0], "");
  record.status = status_of(value_or<std::string>(row[1], ""));
  record.exit_status = static_cast<int>(value_or<std::int64_t>(row[2], 0));
  record.message = value_or<std::string>(row[3], "");
  record.worker = {value_or<std::string>(row[4], ""), value_or<std::int64_t>(row[5], 0),
                   value_or<std::int64_t>(row[6], 0)};
  if (record.status == RunStatus::running)
    record.worker_alive =
        alive(record.worker, static_cast<double>(now() - value_or<std::int64_t>(row[7], 0)));
  return record;
}

}  // namespace

std::string to_string(RunStatus status) {
  switch (status) {
    case RunStatus::running:
      return "running";
    case RunStatus::done:
      return "done";
    case RunStatus::failed:
      return "failed";
    default:
      return "waiting";
  }
}

Store::Store(const fs::path& folder) : folder_(with_folders(folder)), index_(folder / kIndex) {
  const auto version = [&] { return std::get<std::int64_t>(index_.run("PRAGMA user_version")[0][0]); };
  if (version() == 0) make_index();
  if (version() != kVersion)
    bad_input("{}: found a store of version {}, expected {}; it was written by another version of pendular",
              (folder / kIndex).string(), version(), kVersion);
  const auto schema =
      index_.run("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY rootpage, name");
  if (schema != std::vector<Database::Row>{{kTable}, {kByStatus}})
    bad_input(
        "{}: found tables or triggers that are not pendular's; remove it, and the next sweep makes it anew "
        "from "
        "the run folders",
        (folder / kIndex).string());
  const auto check = index_.run("PRAGMA quick_check(1)");
  if (check.size() != 1 || check[0][0] != Database::Cell("ok"))
    bad_input("{}: is damaged; remove it, and the next sweep makes it anew from the run folders",
              (folder / kIndex).string());
}

bool Store::exists(const fs::path& folder) {
  return is_there(folder / kIndex);
}

void Store::make_index() {
  Transaction transaction(index_);
  if (!index_.run("SELECT name FROM sqlite_master").empty()) return;  // another process was faster
  index_.run(kTable);
  index_.run(kByStatus);
  const std::size_t entered = enter_run_folders();
  index_.run("PRAGMA user_version = " + std::to_string(kVersion));
  transaction.commit();
  if (entered > 0)
    warn(fmt::format("{}: the store had no index; made it anew from {} run folders", folder_.string(),
                     entered));
}

std::size_t Store::enter_run_folders() {
  std::size_t entered = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "runs")) {
    const std::string hash = entry.path().stem().string();
    if (!is_there(entry.path() / "request.json")) continue;
    const std::string request = read_text(entry.path() / "request.json");
    if (sha256(request) != hash) continue;
    if (entry.path().extension() != ".part") {
      index_.run("INSERT OR REPLACE INTO runs (hash, status, request) VALUES (?, 'done', ?)",
                 {hash, request});
    } else if (is_there(entry.path() / kFailure)) {
      const auto failure = nlohmann::json::parse(read_text(entry.path() / kFailure), nullptr, false);
      if (!is_failure(failure)) continue;  // to be made again
      index_.run(
          "INSERT OR IGNORE INTO runs (hash, status, exit_status, message, request) "
          "VALUES (?, 'failed', ?, ?, ?)",
          {hash, failure["exit_status"].get<std::int64_t>(), failure["message"].get<std::string>(), request});
    } else {
      continue;
    }
    ++entered;
  }
  return entered;
}

std::vector<std::string> Store::add(std::span<const RunRequest> requests) {
  std::vector<std::string> hashes, texts;
  for (const auto& request : requests) {
    hashes.push_back(sha256(texts.emplace_back(request_text(request))));
    const auto& packing = request.packing;
    if (!packing.sha256.empty() && !is_there(packing_path(packing.sha256)))
      write_atomically(packing_path(packing.sha256),
                       [&](const fs::path& copy) { fs::copy_file(packing.file, copy); });
  }
  Transaction transaction(index_);
  for (std::size_t k = 0; k < hashes.size(); ++k) {
    index_.run("INSERT OR IGNORE INTO runs (hash, status, request) VALUES (?, 'waiting', ?)",
               {hashes[k], texts[k]});
    if (!is_there(run_folder(hashes[k])))
      index_.run("UPDATE runs SET status = 'waiting' WHERE hash = ? AND status = 'done'", {hashes[k]});
  }
  transaction.commit();
  return hashes;
}

std::map<std::string, RunRecord> Store::records(std::span<const std::string> hashes) {
  const std::set<std::string> wanted(hashes.begin(), hashes.end());
  std::map<std::string, RunRecord> found;
  for (const auto& row : index_.run(kRecord))
    if (const auto* hash = std::get_if<std::string>(&row[0]); hash && wanted.count(*hash))
      found[*hash] = record_of(row);
  return found;
}

RunRecord Store::record(const std::string& hash) {
  const auto rows = index_.run(std::string(kRecord) + " WHERE hash = ?", {hash});
  if (rows.empty()) bad_input("{}: has no run {}", folder_.string(), hash);
  return record_of(rows[0]);
}

RunRequest Store::request(const std::string& hash) {
  const auto rows = index_.run("SELECT request FROM runs WHERE hash = ?", {hash});
  if (rows.empty()) bad_input("{}: has no run {}", folder_.string(), hash);
  return parse_request(value_or<std::string>(rows[0][0], ""),
                       fmt::format("{}: run {}", folder_.string(), hash));
}

std::vector<std::pair<std::string, std::string>> Store::finished() {
  std::vector<std::pair<std::string, std::string>> runs;
  for (const auto& row : index_.run("SELECT hash, request FROM runs WHERE status = 'done'")) {
    const auto hash = value_or<std::string>(row[0], "");
    if (is_there(run_folder(hash))) runs.emplace_back(hash, value_or<std::string>(row[1], ""));
  }
  return runs;
}

bool Store::take(const std::string& hash) {
  Transaction transaction(index_);
  if (!record(hash).free()) return false;
  const WorkerId me = this_worker();
  index_.run("UPDATE runs SET status = 'running', host = ?, pid = ?, started = ?, sign = ? WHERE hash = ?",
             {me.host, me.pid, me.started, now(), hash});
  transaction.commit();
  return true;
}

void Store::give_sign(const std::string& hash) {
  index_.run("UPDATE runs SET sign = ? WHERE hash = ?", {now(), hash});
}

void Store::finish(const std::string& hash, const std::optional<Effort>& effort) {
  Database::Row values = {nullptr, nullptr, nullptr, hash};
  if (effort) values = {effort->particle_steps, effort->seconds, std::int64_t{effort->threads}, hash};
  index_.run(
      "UPDATE runs SET status = 'done', exit_status = 0, message = NULL, particle_steps = ?, wall_s = ?, "
      "threads = ? WHERE hash = ?",
      values);
}

void Store::fail(const std::string& hash, int exit_status, const std::string& message) {
  Transaction transaction(index_);
  if (record(hash).status == RunStatus::done) return;
  make_inner_folder(part_folder(hash));
  const auto rows = index_.run("SELECT request FROM runs WHERE hash = ?", {hash});
  write_text(part_folder(hash) / "request.json", value_or<std::string>(rows[0][0], ""));
  const nlohmann::ordered_json json = {{"exit_status", exit_status}, {"message", message}};
  write_text(part_folder(hash) / kFailure,
             json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  index_.run("UPDATE runs SET status = 'failed', exit_status = ?, message = ? WHERE hash = ?",
             {std::int64_t{exit_status}, message, hash});
  transaction.commit();
}

void Store::give_back(const std::string& hash) {
  index_.run("UPDATE runs SET status = 'waiting' WHERE hash = ? AND status = 'running'", {hash});
}

void Store::retry(const std::string& hash) {
  Transaction transaction(index_);
  if (record(hash).status != RunStatus::failed) return;
  fs::remove(part_folder(hash) / kFailure);
  index_.run("UPDATE runs SET status = 'waiting', exit_status = NULL, message = NULL WHERE hash = ?", {hash});
  transaction.commit();
}

std::optional<double> Store::rate() {
  const auto rows =
      index_.run("SELECT sum(particle_steps), sum(wall_s * threads) FROM runs WHERE wall_s > 0");
  const double steps = value_or<double>(rows[0][0], 0.0), seconds = value_or<double>(rows[0][1], 0.0);
  if (!(seconds > 0.0)) return std::nullopt;
  return steps / seconds;
}

}  // namespace pendular::sweep
