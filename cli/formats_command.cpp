#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/sample_reference.h"
#include "cli/command.h"
#include "diagnosis/kinds/kind.h"
#include "effects/list.h"

// What the program knows of its own files, as Markdown that scripts/formats-docs puts into the pages of
// docs/.

namespace pendular::cli {
namespace {

void begin(const std::string& name, const std::vector<std::string>& columns) {
  fmt::print("<!-- generated: {} -->\n\n| {} |\n|{}\n", name, fmt::join(columns, " | "),
             fmt::join(std::vector<std::string>(columns.size(), "---|"), ""));
}

void row(const std::vector<std::string>& cells) {
  fmt::print("| {} |\n", fmt::join(cells, " | "));
}

void end() {
  fmt::print("\n<!-- end of generated -->\n");
}

void print_sample_keys() {
  std::string section;
  for (const auto& key : sample_reference()) {
    const auto dot = key.name.find('.');
    if (key.name.substr(0, dot) != section) {
      if (!section.empty()) end();
      section = key.name.substr(0, dot);
      begin("sample " + section, {"key", "values", "where absent", "meaning"});
    }
    row({"`" + key.name.substr(dot + 1) + "`", key.values, key.absent, key.meaning});
  }
  end();
}

std::string names(const std::vector<std::string>& columns) {
  return columns.empty() ? "" : fmt::format("`{}`", fmt::join(columns, "`, `"));
}

std::string keys_of(const diagnosis::Kind& kind) {
  std::vector<std::string> told;
  for (const auto& key : kind.keys)
    told.push_back(key.words.empty() ? fmt::format("`{}`: {:g} to {:g} ({:g})", key.name, key.lowest,
                                                   key.highest, key.otherwise)
                                     : fmt::format("`{}`: `{}`", key.name, fmt::join(key.words, "`, `")));
  return fmt::format("{}", fmt::join(told, "; "));
}

void print_kinds() {
  begin("kinds", {"kind", "required columns", "optional columns", "least rows",
                  "own keys (default first or in brackets)"});
  for (const auto* kind : diagnosis::all_kinds())
    row({"`" + kind->name + "`", names(kind->required), names(kind->optional),
         std::to_string(kind->least_rows), keys_of(*kind)});
  end();
}

void print_effects() {
  begin("effects", {"id", "θ", "unit", "range", "range of a bank"});
  for (const auto& effect : effects::all_effects())
    row({"`" + effect.id + "`", effect.meaning, effect.unit,
         fmt::format("{:g} to {:g}", effect.lowest, effect.highest),
         fmt::format("{:g} to {:g}", effect.bank_from, effect.bank_to)});
  end();
}

}  // namespace

void add_formats(CLI::App& app) {
  auto* command =
      app.add_subcommand("formats", "Tables of keys and columns for the documentation")->group("");
  command->callback([] {
    print_sample_keys();
    print_kinds();
    print_effects();
  });
}

}  // namespace pendular::cli
