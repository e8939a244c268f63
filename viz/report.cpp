#include "viz/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string_view>

namespace pendular::viz {
namespace {

constexpr std::string_view kStyle = R"(
body{font:16px/1.5 "Helvetica Neue",Arial,"Liberation Sans",sans-serif;color:#1a1a1a;background:#fff;
max-width:60rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem;line-height:1.25}
h2{font-size:1.25rem;margin-top:2.4rem;border-bottom:1px solid #ccc}
.summary{font-size:1.1rem}
.warnings{border-left:4px solid #d66a14;background:#fdf4ec;padding:.5rem 1rem .5rem 2rem;margin:1rem 0}
.wide{overflow-x:auto;margin:1.2rem 0}
table{border-collapse:collapse;font-size:.92rem}
caption{text-align:left;color:#444;padding-bottom:.3rem}
th{vertical-align:bottom}
td{vertical-align:top}
td,th{padding:.25rem 1.1rem .25rem 0;text-align:left;border-bottom:1px solid #e4e4e4}
.value{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
figure{margin:1.5rem 0}
img{max-width:100%;height:auto;border:1px solid #e4e4e4}
figcaption{color:#444;font-size:.95rem}
pre{white-space:pre-wrap;overflow-wrap:anywhere;background:#f6f6f6;padding:.8rem;font-size:.85rem}
@media print{body{font-size:11pt;max-width:none;margin:0;padding:0}figure,tr{break-inside:avoid}
h2{break-after:avoid}img{max-height:22cm}.wide{overflow:visible}table{font-size:.8em}}
)";

std::string escaped(std::string_view text) {
  std::string out;
  for (char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 | (b < left ? static_cast<std::uint8_t>(bytes[k + b]) : 0u);
    for (std::size_t d = 0; d < 4; ++d) out += d <= left ? kDigits[group >> (18 - 6 * d) & 63u] : '=';
  }
  return out;
}

bool starts_as_number(std::string_view cell) {
  for (const std::string_view sign : {"-", "+", "\u2212", "\u00b1", "<", ">"})
    if (cell.starts_with(sign)) cell.remove_prefix(sign.size());
  return !cell.empty() && cell.front() >= '0' && cell.front() <= '9';
}

/// Whether a column has numbers, beside empty cells, and nothing else.
bool is_numeric(const ReportTable& table, std::size_t column) {
  bool any = false;
  for (const auto& row : table.rows) {
    if (!row[column].empty() && !starts_as_number(row[column])) return false;
    any = any || !row[column].empty();
  }
  return any;
}

std::string cell(std::string_view tag, bool numeric, const std::string& text) {
  return fmt::format("<{0}{1}>{2}</{0}>", tag, numeric ? " class=\"value\"" : "", escaped(text));
}

std::string to_html(const ReportTable& table) {
  std::vector<bool> numeric;
  for (std::size_t k = 0; k < table.columns.size(); ++k) numeric.push_back(is_numeric(table, k));
  const auto line = [&](std::string_view tag, const std::vector<std::string>& cells) {
    std::string out = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k) out += cell(tag, numeric[k], cells[k]);
    return out + "</tr>\n";
  };
  std::string out = "<div class=\"wide\"><table>";
  if (!table.caption.empty()) out += fmt::format("<caption>{}</caption>", escaped(table.caption));
  out += "\n<thead>" + line("th", table.columns) + "</thead><tbody>\n";
  for (const auto& row : table.rows) out += line("td", row);
  return out + "</tbody></table></div>\n";
}

std::string to_html(const std::vector<ReportRow>& rows) {
  if (rows.empty()) return "";
  const bool units =
      std::any_of(rows.begin(), rows.end(), [](const ReportRow& row) { return !row.unit.empty(); });
  ReportTable table{"", {"Quantity", "Value"}, {}};
  if (units) table.columns.push_back("Unit");
  for (const ReportRow& row : rows) {
    table.rows.push_back({row.quantity, row.value});
    if (units) table.rows.back().push_back(row.unit);
  }
  return to_html(table);
}

std::string paragraphs(std::string_view style, const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) out += fmt::format("<p{}>{}</p>\n", style, escaped(line));
  return out;
}

std::string to_html(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string out = "<ul class=\"warnings\">\n";
  for (const std::string& warning : warnings) out += fmt::format("<li>{}</li>\n", escaped(warning));
  return out + "</ul>\n";
}

/// As an image, in which a browser runs no script and follows no reference, whatever the file holds.
std::string figure(const ReportPicture& picture) {
  const char* kind = picture.file.extension() == ".svg" ? "svg+xml" : "png";
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/{1};base64,{2}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(picture.caption), kind, base64(read_text(picture.file)));
}

}  // namespace

void write_report(const fs::path& path, const Report& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\"><title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n",
      escaped(report.title), kStyle);
  html +=
      paragraphs(" class=\"summary\"", report.summary) + to_html(report.warnings) + to_html(report.figures);
  for (const ReportSection& section : report.sections) {
    html += fmt::format("<h2>{}</h2>\n", escaped(section.heading));
    html += paragraphs("", section.text) + to_html(section.rows);
    for (const ReportPicture& picture : section.pictures) html += figure(picture);
    for (const ReportTable& table : section.tables) html += to_html(table);
  }
  if (!report.provenance.is_null())
    html +=
        fmt::format("<h2>Provenance</h2>\n<pre>{}</pre>\n",
                    escaped(report.provenance.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)));
  write_text(path, html + "</body></html>\n");
}

}  // namespace pendular::viz
