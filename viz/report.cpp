#include "viz/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "viz/html_text.h"
#include "viz/thumbnail.h"

namespace pendular::viz {
namespace {

constexpr int kThumbnailWidth = 800;

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

/// The picture's file as the page may name it; empty where it is not in the page's folder or below.
std::string beside(const fs::path& page, const fs::path& picture) {
  const fs::path way =
      fs::weakly_canonical(picture).lexically_relative(fs::weakly_canonical(page).parent_path());
  return way.empty() || *way.begin() == ".." ? "" : link_to(way.generic_string());
}

std::string embedded(const fs::path& picture) {
  return picture.extension() == ".svg"
             ? "data:image/svg+xml;base64," + base64(read_text(picture))
             : "data:image/jpeg;base64," + base64(thumbnail(picture, kThumbnailWidth));
}

std::string figure(const fs::path& page, const ReportPicture& picture) {
  const std::string caption = escaped(picture.caption), file = beside(page, picture.file);
  std::string image = fmt::format("<img alt=\"{}\" src=\"{}\">", caption, embedded(picture.file));
  if (!file.empty()) image = fmt::format("<a href=\"{}\" title=\"Full size\">{}</a>", file, image);
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", image, caption);
}

bool has_specimens(const Report& report) {
  return std::any_of(report.sections.begin(), report.sections.end(),
                     [](const auto& section) { return !section.specimens.empty(); });
}

/// What stands before the body: the policy allows this style and this script by their hashes, pictures within
/// the page, and nothing else.
std::string head(const Report& report) {
  const std::string style = std::string(kStyle) + (has_specimens(report) ? view_style() : "");
  const std::string script = has_specimens(report) ? view_script() : "";
  std::string policy = "default-src 'none'; img-src data:; style-src " + policy_hash(style);
  if (!script.empty()) policy += "; script-src " + policy_hash(script);
  std::string html = fmt::format(
      "<meta charset=\"utf-8\"><meta http-equiv=\"Content-Security-Policy\" content=\"{}; base-uri 'none'; "
      "form-action 'none'\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{}</title><style>{}</style>",
      policy, escaped(report.title), style);
  if (!script.empty()) html += "<script>" + script + "</script>";
  return html;
}

}  // namespace

void write_report(const fs::path& path, const Report& report) {
  std::string html = fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head>{}</head>\n<body>\n<h1>{}</h1>\n",
                                 head(report), escaped(report.title));
  html +=
      paragraphs(" class=\"summary\"", report.summary) + to_html(report.warnings) + to_html(report.figures);
  for (const ReportSection& section : report.sections) {
    html += fmt::format("<h2>{}</h2>\n", escaped(section.heading));
    html += paragraphs("", section.text) + to_html(section.rows);
    for (const SpecimenView& specimen : section.specimens) html += to_html(specimen);
    for (const ReportPicture& picture : section.pictures) html += figure(path, picture);
    for (const ReportTable& table : section.tables) html += to_html(table);
  }
  if (!report.provenance.is_null())
    html +=
        fmt::format("<h2>Provenance</h2>\n<pre>{}</pre>\n",
                    escaped(report.provenance.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)));
  write_text(path, html + "</body></html>\n");
}

}  // namespace pendular::viz
