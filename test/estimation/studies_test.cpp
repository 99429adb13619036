#include "estimation/studies.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

class StudiesTest : public testing::Test {
 protected:
  static ModelSettings settings() {
    ModelSettings out = box_settings(bar_under_gravity(prior(50e3, 3)));
    out.mesh.discretisation_error = true;
    return out;
  }
  Model model{settings(), bar_mesh(8, 2, 2)};

  MeshError::Question question() const {
    const Experiment bar(model.settings(), model.mesh(), {30e3});
    std::mt19937 engine(1);
    MeshError::Question out(
        model, see_on(model.mesh(), corners(model.mesh()), bar, bar.film(0.0, kFilmed, 20), kNoise, engine),
        model.parameters().prior_mean(), 0.01 * model.parameters().prior_std(), model.parameters().prior_std());
    out.start = 0.0;
    return out;
  }
};

TEST_F(StudiesTest, ACheckpointEndsAStudyOfTheMeshAndOneOfTheInputs) {
  MeshError::Question asked = question();
  int calls = 0;
  asked.checkpoint = [&calls] {
    if (++calls == 3) throw NumericalError("given up");
  };
  EXPECT_THROW(MeshError(model).study(asked), NumericalError);
  EXPECT_EQ(calls, 3);
  calls = 0;
  EXPECT_THROW(InputStudy(model).study(asked), NumericalError);
  EXPECT_EQ(calls, 3);
}

TEST_F(StudiesTest, WhatWasGivenUpLeavesNoTrace) {
  Studies studies(model, ReuseSources());
  studies.begin(question(), {true, true}, false, true);
  studies.reset();
  EXPECT_FALSE(studies.under_way());
  EXPECT_EQ(studies.mesh_unknown(), "");
  studies.begin(question(), {true, true}, false, true);
  const Studies::Answers answers = studies.take();
  ASSERT_TRUE(answers.mesh);
  ASSERT_TRUE(answers.inputs);
  Studies fresh(model, ReuseSources());
  fresh.begin(question(), {true, true}, false, false);
  const Studies::Answers expected = fresh.take();
  EXPECT_EQ(answers.mesh->shift, expected.mesh->shift);
  EXPECT_EQ(answers.inputs->w, expected.inputs->w);
}

}  // namespace
}  // namespace tissue_stiffness
