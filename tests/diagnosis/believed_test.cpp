#include "diagnosis/experiment/believed.h"

#include <gtest/gtest.h>

#include "micromechanics/stiffness.h"

namespace pendular::diagnosis {
namespace {

Sample stated() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  return sample;
}

TEST(Believed, StatedStiffnessFollowsThePolymer) {
  const Sample soft = changed_sample(stated(), [](Sample& s) { s.bridges.youngs_modulus *= 0.1; });
  EXPECT_NEAR(*soft.bridges.normal_stiffness, 576.0, 1e-6 * 576.0);
  EXPECT_NEAR(*soft.bridges.tangential_stiffness, 32.5, 1e-6 * 32.5);
}

TEST(Believed, StatedStiffnessFollowsTheGapAsFiniteElementsDo) {
  const Sample near = changed_sample(stated(), [](Sample& s) { s.bridges.gap = 1e-6; });
  // Guide: from 2 to 1 um kn rises by about 1.65, kt by about 1.31.
  EXPECT_NEAR(*near.bridges.normal_stiffness / 5760.0, 1.65, 0.02);
  EXPECT_NEAR(*near.bridges.tangential_stiffness / 325.0, 1.31, 0.02);
}

TEST(Believed, AStiffnessThatIsStatedAnewStays) {
  const Sample other = changed_sample(stated(), [](Sample& s) {
    s.bridges.youngs_modulus = 6.4e5;
    s.bridges.normal_stiffness = 2345.0;
    s.bridges.tangential_stiffness = 131.0;
  });
  EXPECT_EQ(other.bridges.normal_stiffness, 2345.0);
  const Sample rough = changed_sample(stated(), [](Sample& s) { s.contact.friction = 0.3; });
  EXPECT_EQ(rough.bridges.normal_stiffness, 5760.0);
}

TEST(Believed, WithoutAStatedStiffnessNothingIsAdded) {
  const Sample other = changed_sample(Sample{}, [](Sample& s) { s.bridges.youngs_modulus = 1e5; });
  EXPECT_FALSE(other.bridges.normal_stiffness);
}

}  // namespace
}  // namespace pendular::diagnosis
