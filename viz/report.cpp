#include "viz/report.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace pendular::viz {
namespace {

constexpr std::string_view kStyle =
    "body{font:16px/1.5 sans-serif;color:#1a1a1a;background:#fff;max-width:60rem;margin:2rem auto;padding:0 "
    "1rem}"
    "h1{font-size:1.7rem;line-height:1.25}h2{font-size:1.25rem;margin-top:2.2rem;border-bottom:1px solid "
    "#ccc}"
    ".summary{font-size:1.05rem}table{border-collapse:collapse}td,th{padding:.25rem 1.2rem .25rem "
    "0;text-align:left;"
    "border-bottom:1px solid #e4e4e4}td.value{text-align:right;font-variant-numeric:tabular-nums}"
    "figure{margin:1.5rem 0}img{max-width:100%;height:auto;border:1px solid "
    "#e4e4e4}figcaption{color:#444;font-size:.95rem}"
    "pre{white-space:pre-wrap;overflow-wrap:anywhere;background:#f6f6f6;padding:.8rem;font-size:.85rem}";

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

std::string table(const std::vector<ReportRow>& rows) {
  std::string out = "<table><tr><th>Quantity</th><th>Value</th><th>Unit</th></tr>\n";
  for (const ReportRow& row : rows)
    out += fmt::format("<tr><td>{}</td><td class=\"value\">{}</td><td>{}</td></tr>\n", escaped(row.quantity),
                       escaped(row.value), escaped(row.unit));
  return out + "</table>\n";
}

std::string figure(const ReportPicture& picture) {
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(picture.caption), base64(read_text(picture.file)));
}

}  // namespace

void write_report(const fs::path& path, const Report& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\"><title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
      "<p class=\"summary\">{2}</p>\n",
      escaped(report.title), kStyle, escaped(report.summary));
  for (const ReportSection& section : report.sections) {
    html += fmt::format("<h2>{}</h2>\n", escaped(section.heading));
    if (!section.text.empty()) html += fmt::format("<p>{}</p>\n", escaped(section.text));
    if (!section.rows.empty()) html += table(section.rows);
    for (const ReportPicture& picture : section.pictures) html += figure(picture);
  }
  if (!report.provenance.is_null())
    html += fmt::format("<h2>Provenance</h2>\n<pre>{}</pre>\n", escaped(report.provenance.dump(2)));
  write_text(path, html + "</body></html>\n");
}

}  // namespace pendular::viz
