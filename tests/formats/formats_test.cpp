#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "base/sample.h"
#include "base/sample_reference.h"
#include "diagnosis/kinds/kind.h"
#include "documented.h"
#include "program.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::columns_of;
using test::documented;
using test::expect_documented_keys;
using test::shell;

std::set<std::string> as_set(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

/// Names of the arrays of a .vtp file, without those of VTK itself.
std::set<std::string> arrays_of(const fs::path& path) {
  const std::string text = read_text(path);
  const std::regex name("<(?:DataArray|Array)[^>]* Name=\"([^\"]+)\"");
  std::set<std::string> names;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), name); it != std::sregex_iterator(); ++it)
    names.insert((*it)[1]);
  for (const char* own : {"Points", "connectivity", "offsets"}) names.erase(own);
  return names;
}

constexpr const char* kSample =
    "[bridges]\nnormal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n"
    "[specimen]\ndiameter_um = 1100\nheight_um = 1100\nvolume_fraction = 0.55\n"
    "[phantom]\nvoxel_um = 10\nwall_thickness_um = 60\nmargin_um = 80\n"
    "[compression]\nmax_strain = 0.02\nframes = 2\n";

constexpr const char* kSweep =
    "[sweep]\nsample = \"s.toml\"\npacking = \"packing.vtp\"\n[grid]\n\"contact.friction\" = [0.5]\n";

/// Every file of a small chain.
void make_files(const test::ScratchFolder& folder) {
  write_text(folder / "s.toml", test::sample_file(kSample));
  write_text(folder / "sweep.toml", kSweep);
  for (const char* command :
       {"phantom s.toml -o v.mha --truth truth.vtp", "segment v.mha -o beads.csv --bridges bridges.csv",
        "pack beads.csv --sample s.toml -o packing.vtp", "compress packing.vtp --sample s.toml -o run",
        "modulus packing.vtp --sample s.toml --strain 0.005 -o modulus.json",
        "bridge --d-um 70 -o bridge.csv", "track beads.csv beads.csv -o track.csv",
        "sweep sweep.toml -o sweep"}) {
    const auto outcome = shell(folder.path(), std::string("$P ") + command);
    ASSERT_EQ(outcome.status, 0) << command << ": " << outcome.errors;
  }
}

void expect_tables_have_the_columns_of_the_page(const test::ScratchFolder& folder) {
  for (const auto& [path, heading] : {std::pair{"beads.csv", "`beads.csv`"},
                                      {"bridges.csv", "`bridges.csv`"},
                                      {"track.csv", "`track.csv`"},
                                      {"run/curve.csv", "`curve.csv`"},
                                      {"run/events.csv", "`events.csv`"},
                                      {"run/avalanches.csv", "`avalanches.csv`"},
                                      {"bridge.csv", "`bridge` table"}})
    EXPECT_EQ(columns_of(folder / path), documented(heading)) << path;
  auto results = documented("`results.csv`");
  results.insert(results.begin() + 1, "contact.friction");
  EXPECT_EQ(columns_of(folder / "sweep/results.csv"), results);
}

void expect_keys_of_the_page_are_there(const test::ScratchFolder& folder) {
  std::set<std::string> keys;
  test::add_keys(nlohmann::json::parse(read_text(folder / "run/result.json")), "", keys);
  for (const auto& name : documented("`result.json`")) {
    if (name == "relaxation") continue;  // of another control
    EXPECT_TRUE(
        std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return test::stands_for(name, key); }))
        << "docs/formats.md names " << name << ", which result.json has not";
  }
}

void expect_arrays_of_the_page(const test::ScratchFolder& folder) {
  EXPECT_EQ(arrays_of(folder / "packing.vtp"), as_set(documented("`packing.vtp`")));
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder / "run/frames")) frames.push_back(entry.path());
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(arrays_of(frames.front()), as_set(documented("`frames/*.vtp`")));
}

TEST(Formats, FilesOfAChainAreAsThePageSays) {
  const test::ScratchFolder folder;
  ASSERT_NO_FATAL_FAILURE(make_files(folder));
  expect_tables_have_the_columns_of_the_page(folder);
  expect_documented_keys(folder / "beads.json", "`beads.json`");
  expect_documented_keys(folder / "track.json", "`track.json`");
  expect_documented_keys(folder / "packing.json", "`packing.json`");
  expect_documented_keys(folder / "run/result.json", "`result.json`");
  expect_documented_keys(folder / "modulus.json", "`modulus.json`");
  expect_keys_of_the_page_are_there(folder);
  expect_arrays_of_the_page(folder);
}

TEST(Formats, EveryColumnAndKeyOfAKindIsDefined) {
  const auto columns = as_set(documented("Columns of observations")), keys = as_set(documented("Own keys"));
  std::set<std::string> known;
  for (const auto* kind : diagnosis::all_kinds()) {
    for (const auto* names : {&kind->required, &kind->optional})
      for (const auto& name : *names) {
        known.insert(name);
        EXPECT_TRUE(columns.contains(name)) << kind->name << ": " << name;
      }
    for (const auto& key : kind->keys) EXPECT_TRUE(keys.contains(key.name)) << kind->name << ": " << key.name;
  }
  for (const auto& name : columns) EXPECT_TRUE(known.contains(name)) << name << " is of no kind";
}

TEST(Formats, EveryKeyOfASampleHasAMeaning) {
  std::set<std::string> told;
  for (const auto& key : sample_reference()) {
    EXPECT_FALSE(key.meaning.empty()) << key.name;
    EXPECT_TRUE(told.insert(key.name).second) << key.name << " is told twice";
  }
  EXPECT_EQ(told, as_set(sample_key_names()));
}

}  // namespace
}  // namespace pendular
