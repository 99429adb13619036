// Elements and time steps against what theory says; scripts/verify prints the same figures.
#include "../figures.hpp"

namespace tissue_stiffness {
namespace {

TEST(Patch, LinearFieldsAndRigidMotionsAreExact) {
  expect_all(patch_figures());
}

TEST(Cantilever, BendsAndSwingsLikeTimoshenkosBeam) {
  expect_all(cantilever_figures());
}

TEST(Refinement, ConvergesWithTheElementsOrder) {
  expect_all(refinement_figures());
}

TEST(TimeStepping, IsOfSecondOrderAndKeepsTheEnergy) {
  expect_all(time_figures());
}

}  // namespace
}  // namespace tissue_stiffness
