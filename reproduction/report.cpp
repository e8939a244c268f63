#include "reproduction/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "viz/gnuplot.h"

namespace pendular::reproduction {
namespace {

std::string row_of(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string rule_of(std::size_t columns) {
  return row_of(std::vector<std::string>(columns, "---"));
}

std::string comparisons_of(const std::vector<Comparison>& comparisons) {
  std::string text = row_of({"quantity", "paper", "ours (mean ± sd)", "matched"}) + rule_of(4);
  for (const auto& c : comparisons)
    text += row_of({c.quantity, c.paper, c.ours, c.matched ? "yes" : "**no**"});
  return text;
}

std::string to_markdown(const Table& table) {
  std::string text = row_of(table.columns) + rule_of(table.columns.size());
  for (const auto& row : table.rows) text += row_of(row);
  return text;
}

std::string to_markdown(const Section& section) {
  std::string text = fmt::format("\n## {}\n\n{}\n", section.heading, section.text);
  if (!section.comparisons.empty()) text += '\n' + comparisons_of(section.comparisons);
  if (section.table) text += '\n' + to_markdown(*section.table);
  for (const auto& figure : section.figures) {
    text += fmt::format("\n![{0}]({1})\n\n{0}", figure.caption, figure.picture);
    text += figure.table.empty() ? "\n" : fmt::format(" Data: [{0}]({0}).\n", figure.table);
  }
  return text;
}

std::string unmatched_of(const std::vector<Section>& sections) {
  std::string text;
  for (const auto& section : sections)
    for (const auto& c : section.comparisons)
      if (!c.matched)
        text += fmt::format("- {}: {}: {} in the paper, {} here.{}{}\n", section.heading, c.quantity, c.paper,
                            c.ours, c.why.empty() ? "" : " ", c.why);
  return text.empty() ? "Nothing that the table compares.\n" : text;
}

}  // namespace

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

std::string to_markdown(const std::vector<Section>& sections, const Provenance& provenance) {
  std::string text =
      "# Hemmerle et al. 2021, reproduced\n\n"
      "The tomograms' bead positions are not public. Packings made by this program, in cylinders of the same "
      "size and with the same number of bridges per interior bead, stand in for them. Each realisation draws "
      "the diameters anew on the same centres, as the paper does.\n";
  for (const auto& section : sections) text += to_markdown(section);
  text += "\n## What is not matched\n\n" + unmatched_of(sections);
  return text + fmt::format("\nMade by pendular {}: `{}`\n", provenance.version, provenance.command);
}

Figure Desk::keep(const std::string& name, const viz::Figure& chart, const std::string& csv,
                  const std::string& caption) const {
  viz::write_figure(chart, {out / (name + ".png"), out / (name + ".pdf")}, to_comment(provenance));
  write_text(out / (name + ".csv"), to_comment(provenance) + csv);
  return {name + ".png", name + ".csv", caption};
}

}  // namespace pendular::reproduction
