#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/files.h"

struct sqlite3;

namespace pendular::sweep {

/// An SQLite file. A damaged one is BadInput, any other trouble ComputationFailed; both name the file.
class Database {
 public:
  using Cell = std::variant<std::nullptr_t, std::int64_t, double, std::string>;
  using Row = std::vector<Cell>;

  /// Opens or creates the file. Other processes' writes are waited for, up to a minute.
  explicit Database(const fs::path& file);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// One statement, with values for its question marks; the rows it gives.
  std::vector<Row> run(const std::string& statement, const Row& values = {});

  /// Rows changed by the last statement.
  int changed() const;

 private:
  [[noreturn]] void fail() const;

  fs::path file_;
  sqlite3* handle_ = nullptr;
};

/// Statements that count together or not at all; no other process writes in between.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace pendular::sweep
