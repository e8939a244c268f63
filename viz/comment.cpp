#include "viz/comment.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/text_line.h"

namespace pendular::viz {
namespace {

constexpr std::size_t kPngHeader = 8 + 25;  // signature and IHDR, after which a text chunk may stand

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255u);
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& content) {
  const std::string body = type + content;
  const auto sum = ::crc32(0L, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(content.size())) + body +
         big_endian(static_cast<std::uint32_t>(sum));
}

/// A text string of PDF; a mark in front says that it is UTF-8.
std::string pdf_string(const std::string& text) {
  const bool ascii =
      std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
  std::string out = ascii ? "(" : "(\xEF\xBB\xBF";
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') out += '\\';
    out += c;
  }
  return out + ")";
}

/// The number after the last `word` of a PDF file.
std::size_t number_after(const std::string& pdf, std::string_view word) {
  const std::size_t at = pdf.rfind(word);
  std::size_t from = at == std::string::npos ? pdf.size() : at + word.size();
  while (from < pdf.size() && std::isspace(static_cast<unsigned char>(pdf[from])) != 0) ++from;
  std::size_t number = 0;
  if (std::from_chars(pdf.data() + from, pdf.data() + pdf.size(), number).ec != std::errc())
    throw ComputationFailed(fmt::format("PDF of a chart: found no {}", word));
  return number;
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  return out;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

std::string png_with_comment(std::string png, const std::string& comment) {
  if (!comment.empty()) png.insert(kPngHeader, png_chunk("tEXt", std::string("Comment\0", 8) + comment));
  return png;
}

std::string pdf_with_comment(std::string pdf, const std::string& comment) {
  constexpr std::string_view kDate = "/CreationDate (D:";
  const std::size_t date = pdf.rfind(kDate);
  if (date != std::string::npos)
    for (std::size_t k = date + kDate.size(); k < pdf.size() && pdf[k] != ')'; ++k)
      if (std::isdigit(static_cast<unsigned char>(pdf[k])) != 0) pdf[k] = '0';
  if (comment.empty()) return pdf;
  // An update of the file: another version of its information, with a table and a trailer of its own.
  const std::size_t info = number_after(pdf, "/Info"), root = number_after(pdf, "/Root"),
                    size = number_after(pdf, "/Size"), before = number_after(pdf, "startxref");
  const std::size_t object = pdf.size();
  pdf += fmt::format("{} 0 obj\n<< /Producer (pendular) /Subject {} >>\nendobj\n", info,
                     pdf_string(printable(comment)));
  const std::size_t table = pdf.size();
  return pdf + fmt::format(
                   "xref\n{} 1\n{:010} 00000 n \ntrailer\n<< /Size {} /Root {} 0 R /Info {} 0 R /Prev {} "
                   ">>\nstartxref\n{}\n%%EOF\n",
                   info, object, size, root, info, before, table);
}

std::string svg_with_comment(std::string svg, const std::string& comment) {
  constexpr std::string_view kOpen = "<desc>", kClose = "</desc>";
  const std::size_t from = svg.find(kOpen) + kOpen.size(), to = svg.find(kClose);
  if (to == std::string::npos || from > to) throw ComputationFailed("SVG of a chart: found no description");
  svg.replace(from, to - from, xml_text(printable(comment)));
  // gnuplot takes the weight for a part of the name.
  replace_all(svg, R"(font-family="Arial:Bold")", R"(font-family="Arial" font-weight="bold")");
  replace_all(svg, R"(font-family="Arial")",
              R"(font-family="Arial, Liberation Sans, Helvetica, sans-serif")");
  return svg;
}

}  // namespace pendular::viz
