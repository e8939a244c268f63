#include "base/csv.h"

#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <array>
#include <charconv>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/columns.h"
#include "base/error.h"

namespace pendular {
namespace {

// The library fixes the number of columns at compile time; unused ones get names no file can hold.
constexpr unsigned kMaxColumns = 24;
using Reader = io::CSVReader<kMaxColumns, io::trim_chars<' ', '\t', '\r'>, io::double_quote_escape<',', '"'>,
                             io::throw_on_overflow, io::single_and_empty_line_comment<'#'>>;

std::array<std::string, kMaxColumns> padded_names(std::vector<std::string> names) {
  std::array<std::string, kMaxColumns> all;
  for (unsigned k = 0; k < kMaxColumns; ++k)
    all[k] = k < names.size() ? names[k] : std::string("\x01") + std::to_string(k);
  return all;
}

/// `where`: gives the place in words.
template <typename T, typename Where>
T parse(const std::string& text, const Where& where, const std::string& column, const char* expected) {
  T value{};
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last)
    bad_input("{}: column {}: found \"{}\", expected {}", where(), column, text, expected);
  return value;
}

/// The library looks for the end of a last line beyond the text, at whatever lies there.
std::string ended_lines(std::string text) {
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

}  // namespace

std::string CsvTable::where(std::size_t row) const {
  return fmt::format("{}:{}", path_.string(), lines_[row]);
}

std::vector<double> CsvTable::numbers(const std::string& column, bool empty_is_nan) const {
  const auto& cells = cells_.at(column);
  const Range range = range_of(column);
  std::vector<double> values(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    if (empty_is_nan && cells[row].empty()) {
      values[row] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    values[row] = parse<double>(
        cells[row], [&] { return where(row); }, column, "a number");
    if (!range.holds(values[row])) require_in_range(where(row), "column " + column, range, values[row]);
  }
  return values;
}

std::vector<long long> CsvTable::integers(const std::string& column) const {
  const auto& cells = cells_.at(column);
  std::vector<long long> values(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row)
    values[row] = parse<long long>(
        cells[row], [&] { return where(row); }, column, "an integer");
  return values;
}

CsvTable read_csv(const fs::path& path, const std::vector<std::string>& required,
                  const std::vector<std::string>& optional) {
  const std::string text = ended_lines(read_text(path));
  std::vector<std::string> names = required;
  names.insert(names.end(), optional.begin(), optional.end());
  if (names.size() > kMaxColumns) throw std::logic_error("read_csv: more columns asked for than it can read");
  const auto all = padded_names(names);
  CsvTable table;
  table.path_ = path;
  try {
    Reader reader(path.string(), text.data(), text.data() + text.size());
    std::apply(
        [&](const auto&... name) {
          reader.read_header(io::ignore_missing_column | io::ignore_extra_column, name...);
        },
        all);
    for (const auto& name : required)
      if (!reader.has_column(name)) bad_input("{}: column {} is missing", path.string(), name);
    std::vector<std::pair<std::size_t, std::vector<std::string>*>> columns;  // that the file has
    for (std::size_t k = 0; k < names.size(); ++k)
      if (reader.has_column(names[k])) columns.emplace_back(k, &table.cells_[names[k]]);
    std::array<char*, kMaxColumns> cells{};
    while (std::apply([&](auto&... cell) { return reader.read_row(cell...); }, cells)) {
      table.lines_.push_back(reader.get_file_line());
      for (const auto& [k, column] : columns) column->emplace_back(cells[k]);
    }
  } catch (const io::error::base& error) {
    throw BadInput(fmt::format("{}: {}", path.string(), error.what()));
  }
  return table;
}

std::string csv_cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string csv_cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + '"';
}

}  // namespace pendular
