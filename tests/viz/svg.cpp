#include "svg.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "base/files.h"
#include "base/temporary_folder.h"
#include "viz/gnuplot.h"

namespace pendular::test {
namespace {

std::string without_spaces(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text;
}

SvgPoints points_of(std::string text) {
  for (char& c : text)
    if (c == ',' || c == 'M' || c == 'L' || c == 'Z') c = ' ';
  std::istringstream numbers(text);
  SvgPoints points;
  for (double x = 0.0, y = 0.0; numbers >> x >> y;) points.emplace_back(x, y);
  return points;
}

template <typename Use>
void each_match(const std::string& text, const std::string& pattern, const Use& use) {
  const std::regex regex(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) use(*at);
}

std::string unescaped(std::string text) {
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, from.size(), to);
  return text;
}

std::pair<double, double> range(const SvgPoints& points, double std::pair<double, double>::*axis) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& point : points) low = std::min(low, point.*axis), high = std::max(high, point.*axis);
  return {low, high};
}

}  // namespace

std::string svg_of(const viz::Figure& figure) {
  const TemporaryFolder folder;
  viz::write_figure(figure, {folder.path() / "figure.svg"});
  return read_text(folder.path() / "figure.svg");
}

double SvgArea::width() const {
  const auto [low, high] = range(points, &std::pair<double, double>::first);
  return high - low;
}
double SvgArea::height() const {
  const auto [low, high] = range(points, &std::pair<double, double>::second);
  return high - low;
}
double SvgArea::left() const {
  return range(points, &std::pair<double, double>::first).first;
}
double SvgArea::area() const {
  double twice = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [x0, y0] = points[k];
    const auto& [x1, y1] = points[(k + 1) % points.size()];
    twice += x0 * y1 - x1 * y0;
  }
  return 0.5 * std::abs(twice);
}

std::vector<SvgArea> areas(const std::string& svg) {
  std::vector<SvgArea> found;
  each_match(svg,
             "<polygon fill = '(?:rgb\\(([^)]*)\\)|[^']*)'(?: fill-opacity = '([^']*)')? points = '([^']*)'",
             [&](const std::smatch& m) {
               found.push_back({without_spaces(m[1]), m[2].matched ? std::stod(m[2]) : 1.0, points_of(m[3])});
             });
  return found;
}

std::vector<SvgArea> areas(const std::string& svg, const std::string& colour) {
  auto found = areas(svg);
  std::erase_if(found, [&](const SvgArea& area) { return area.colour != colour; });
  return found;
}

std::vector<SvgPoints> lines(const std::string& svg, const std::string& colour) {
  std::vector<SvgPoints> found;
  each_match(svg, "<path stroke='rgb\\(([^)]*)\\)'[^>]*? d='([^']*)'", [&](const std::smatch& m) {
    if (without_spaces(m[1]) != colour) return;
    std::istringstream parts(m[2]);
    for (std::string part; std::getline(parts, part, 'M');)
      if (const auto points = points_of(part); !points.empty()) found.push_back(points);
  });
  return found;
}

SvgPoints markers(const std::string& svg, const std::string& colour) {
  SvgPoints found;
  each_match(svg,
             "<use xlink:href='#gpPt[0-9]+' transform='translate\\(([^)]*)\\)[^']*' color='rgb\\(([^)]*)\\)'",
             [&](const std::smatch& m) {
               if (without_spaces(m[2]) == colour) found.push_back(points_of(m[1]).front());
             });
  return found;
}

std::vector<SvgWords> words(const std::string& svg) {
  std::vector<SvgWords> found;
  each_match(
      svg,
      "<g transform=\"translate\\(([^)]*)\\)[^\"]*\" [^>]*font-family=\"[^\"]*\"( font-weight=\"bold\")? "
      "font-size=\"([^\"]*)\"  text-anchor=\"([a-z]*)\">\\s*<text>([^\\n]*)</text>",
      [&](const std::smatch& m) {
        const auto [x, y] = points_of(m[1]).front();
        found.push_back({unescaped(m[5]), m[4], x, y, std::stod(m[3]), m[2].matched});
      });
  return found;
}

}  // namespace pendular::test
