#include "sweep/database.h"

#include <sqlite3.h>

#include <memory>

#include "base/error.h"

namespace pendular::sweep {
namespace {

constexpr int kPatienceMilliseconds = 60000;

struct Binder {
  sqlite3_stmt* statement;
  int place;
  void operator()(std::nullptr_t) const { sqlite3_bind_null(statement, place); }
  void operator()(std::int64_t value) const { sqlite3_bind_int64(statement, place, value); }
  void operator()(double value) const { sqlite3_bind_double(statement, place, value); }
  void operator()(const std::string& value) const {
    sqlite3_bind_text(statement, place, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  }
};

Database::Cell cell(sqlite3_stmt* statement, int column) {
  switch (sqlite3_column_type(statement, column)) {
    case SQLITE_INTEGER:
      return std::int64_t{sqlite3_column_int64(statement, column)};
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, column);
    case SQLITE_NULL:
      return nullptr;
    default: {
      const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
      return std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement, column)));
    }
  }
}

}  // namespace

Database::Database(const fs::path& file) : file_(file) {
  // A failed opening still leaves a handle that holds the reason.
  if (sqlite3_open(file.c_str(), &handle_) != SQLITE_OK) {
    const std::string why = sqlite3_errmsg(handle_);
    sqlite3_close(handle_);
    bad_input("{}: cannot be opened: {}", file.string(), why);
  }
  sqlite3_busy_timeout(handle_, kPatienceMilliseconds);
}

Database::~Database() {
  sqlite3_close(handle_);
}

void Database::fail() const {
  const int code = sqlite3_errcode(handle_);
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB)
    bad_input("{}: is damaged; remove it, and the next sweep makes it anew from the run folders",
              file_.string());
  if (code == SQLITE_BUSY)
    throw ComputationFailed(fmt::format("{}: another process has kept it busy for a minute", file_.string()));
  throw ComputationFailed(fmt::format("{}: {}", file_.string(), sqlite3_errmsg(handle_)));
}

std::vector<Database::Row> Database::run(const std::string& statement, const Row& values) {
  sqlite3_stmt* raw = nullptr;
  if (sqlite3_prepare_v2(handle_, statement.c_str(), -1, &raw, nullptr) != SQLITE_OK) fail();
  const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> prepared(raw, sqlite3_finalize);
  for (std::size_t k = 0; k < values.size(); ++k) std::visit(Binder{raw, static_cast<int>(k) + 1}, values[k]);
  std::vector<Row> rows;
  for (;;) {
    const int state = sqlite3_step(raw);
    if (state == SQLITE_DONE) return rows;
    if (state != SQLITE_ROW) fail();
    Row& row = rows.emplace_back();
    for (int column = 0; column < sqlite3_column_count(raw); ++column) row.push_back(cell(raw, column));
  }
}

int Database::changed() const {
  return sqlite3_changes(handle_);
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const Error&) {  // the error that led here is the one to tell
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace pendular::sweep
