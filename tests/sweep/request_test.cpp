#include "sweep/request.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/error.h"
#include "packing/bridges.h"
#include "packing/vtp.h"
#include "scratch.h"

namespace pendular::sweep {
namespace {

using test::ScratchFolder;

RunRequest plain() {
  RunRequest request;
  request.packing = generated_packing(5);
  request.seed = 9;
  return request;
}

TEST(Request, TextReadsBackToTheSameRequest) {
  RunRequest request = plain();
  request.sample.bridges.youngs_modulus = 1e6 / 3.0;
  request.sample.compression.unload_at = {0.01};
  request.keep_all = true;
  const RunRequest again = parse_request(request_text(request), "test");
  EXPECT_EQ(request_text(again), request_text(request));
  EXPECT_EQ(again.sample.bridges.youngs_modulus, 1e6 / 3.0);
  EXPECT_EQ(again.packing.seed, 5u);
  EXPECT_EQ(again.seed, 9u);
  EXPECT_TRUE(again.keep_all);
  EXPECT_THROW(parse_request("{\"sample\": 3}", "test"), BadInput);
}

TEST(Request, HashTellsEveryDifference) {
  std::vector<RunRequest> others(4, plain());
  others[0].seed = 10;
  others[1].packing = generated_packing(6);
  others[2].keep_all = true;
  others[3].packing.sha256 = std::string(64, 'a');
  for (const auto& key : sample_keys()) {
    const double value = std::isfinite(key.highest) ? 0.3 * key.lowest + 0.7 * key.highest : 1234.5;
    set_sample_key(others.emplace_back(plain()).sample, key.name, value);
  }
  std::set<std::string> hashes = {content_hash(plain())};
  for (const auto& other : others)
    EXPECT_TRUE(hashes.insert(content_hash(other)).second) << request_text(other);
}

TEST(Request, KeysYoungerThanStoresShowOnlyWhereTheyAreUsed) {
  const std::string text = request_text(plain());
  EXPECT_EQ(text.find("contact.glass"), std::string::npos);
  EXPECT_EQ(text.find("bridges.breaking"), std::string::npos);
  RunRequest other = plain();
  other.sample.contact.glass = Glass::hertz;
  other.sample.bridges.breaking = Breaking::limits;
  const RunRequest again = parse_request(request_text(other), "test");
  EXPECT_EQ(again.sample.contact.glass, Glass::hertz);
  EXPECT_EQ(again.sample.bridges.breaking, Breaking::limits);
}

TEST(Request, APackingFileCountsByItsContentNotItsName) {
  ScratchFolder folder;
  Packing packing;
  for (int k = 0; k < 3; ++k) {
    Bead bead;
    bead.id = k;
    bead.centre = Vec3(0.0, 0.0, 201e-6 * k);
    bead.diameter = 200e-6;
    packing.beads.push_back(bead);
  }
  packing.specimen = {300e-6, 700e-6, 0.0, 0.0, 0.0};
  packing.bridges = candidate_bridges(packing.beads, 10e-6);
  write_packing(folder / "a.vtp", packing);
  fs::copy_file(folder / "a.vtp", folder / "b.vtp");
  RunRequest a = plain(), b = plain();
  a.packing = packing_file(folder / "a.vtp");
  b.packing = packing_file(folder / "b.vtp");
  EXPECT_EQ(a.packing.beads, 3u);
  EXPECT_EQ(content_hash(a), content_hash(b));
  EXPECT_NE(content_hash(a), content_hash(plain()));
}

TEST(Request, GeneratedBeadsAreSharedByRunsThatDifferInOtherThings) {
  RunRequest stiffer = plain(), taller = plain();
  stiffer.sample.bridges.youngs_modulus *= 2.0;
  stiffer.seed = 77;
  taller.sample.specimen.height *= 2.0;
  EXPECT_EQ(packing_hash(stiffer), packing_hash(plain()));
  EXPECT_NE(packing_hash(taller), packing_hash(plain()));
}

}  // namespace
}  // namespace pendular::sweep
