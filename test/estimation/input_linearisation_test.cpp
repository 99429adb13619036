// The columns of the inputs' errors are the derivatives of the rows.
#include "estimation/input_linearisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bar.hpp"
#include "estimation/basis_error.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3;
constexpr int kFrames = 40;

ModelSettings pushed(const std::string& torque = "") {
  ModelSettings model =
      box_settings({"inertia: {density: 1000}", modulus(prior(kTruth, 3)), "fixed: {region: clamp}",
                    "viscous_damping: {beta: 4.0e-3}", "traction: {region: tip, topic: /wrench" + torque + "}"});
  model.exact_inputs = false;
  return model;
}

LoadSample twisting_wrench(double time) {
  LoadSample sample = swaying_wrench(time);
  sample.value[3] = 5e-5 * std::sin(5.0 * time);
  sample.value[5] = 3e-5 * (1.0 - std::cos(3.0 * time));
  return sample;
}

struct Setting {
  ModelSettings settings;
  TetMesh mesh = bar_mesh();
  std::unique_ptr<Model> model;
  std::unique_ptr<InputModels> models;
  std::unique_ptr<MeshError::Question> question;

  explicit Setting(ModelSettings model_settings = pushed()) : settings(std::move(model_settings)) {
    Experiment bar(settings, mesh, {kTruth});
    model = std::make_unique<Model>(settings, mesh);
    model->loads().set_first_stamp(0.0);
    for (int k = 0; k < 260; ++k) {
      bar.add_load(twisting_wrench(0.005 * k));
      model->loads().courses().at("/wrench")->add(0.005 * k, twisting_wrench(0.005 * k).value);
    }
    const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, kFrames), kNoise, 7);
    models = std::make_unique<InputModels>(*model);
    const Eigen::VectorXd std = model->parameters().prior_std();
    question = std::make_unique<MeshError::Question>(*model, frames, model->parameters().prior_mean(), 1e-3 * std, std);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      question->mesh_changes.push_back(1e-4 * Eigen::VectorXd::LinSpaced(3 * mesh.node_count(), -1.0, 1.0));
    }
    models->base.loads().set_first_stamp(0.0);
    models->uncertain.loads().set_first_stamp(0.0);
    for (const auto& [topic, course] : question->courses) *models->uncertain.loads().courses().at(topic) = course;
    models->runs->restrict_output_to(observed_nodes(models->operators, frames));
  }
};

struct Rows {
  Eigen::VectorXd error;
  Eigen::MatrixXd columns;
};

Rows rows_at(InputLinearisation& linearisation, const Eigen::VectorXd& z) {
  std::vector<Rows> frames;
  Eigen::Index count = 0;
  linearisation.each_row(z, Constants::varied, [&](const InputLinearisation::Row& row, const Eigen::MatrixXd& amplitudes) {
    Eigen::MatrixXd columns(row.error.size(), z.size());
    columns << row.parameters, row.modes * amplitudes, row.direct;
    frames.push_back({row.error, columns});
    count += row.error.size();
  });
  Rows out{Eigen::VectorXd(count), Eigen::MatrixXd(count, z.size())};
  Eigen::Index first = 0;
  for (const Rows& frame : frames) {
    out.error.segment(first, frame.error.size()) = frame.error;
    out.columns.middleRows(first, frame.error.size()) = frame.columns;
    first += frame.error.size();
  }
  return out;
}

// The uncertain Poisson's ratio takes vectors of its own. Runs in a basis of its own must not differ by more than those of
// the estimator from the motion, or the study's test takes the basis for a misfit.
TEST(InputModels, HaveABasisThatLeavesOutASmallPartOfTheNoise) {
  Setting s;
  BasisOptions few;
  few.size = few.per_part = 10;
  few.largest = 20;
  s.models->runs = std::make_shared<ReducedModel>(s.models->uncertain, few);
  const auto sigmas = [&] {
    const ReducedModel& runs = s.models->linear_form();
    const FitProblem problem{s.models->base, runs, s.models->operators, s.question->frames, {0.0}};
    return basis_error(runs, problem, s.question->w, surface_nodes(s.mesh)).sigmas;
  };
  ASSERT_GT(sigmas(), kBasisShare);
  for (int k = 0; k < 4; ++k) s.models->grow_basis(*s.question);
  EXPECT_LE(sigmas(), kBasisShare);
}

class InputLinearisationOf : public testing::TestWithParam<std::string> {};

TEST_P(InputLinearisationOf, ColumnsAreTheDerivativesOfTheRows) {
  Setting setting(pushed(GetParam()));
  InputLinearisation linearisation(*setting.question, *setting.models);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(linearisation.size());
  z[0] = setting.model->parameters().prior_mean()[0];
  const Rows there = rows_at(linearisation, z);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double step = i == 0 ? 1e-3 : 0.05;
    Eigen::VectorXd high = z, low = z;
    high[i] += step;
    low[i] -= step;
    const Eigen::VectorXd change = (rows_at(linearisation, low).error - rows_at(linearisation, high).error) / (2.0 * step);
    EXPECT_LT((change - there.columns.col(i)).norm(), 0.01 * there.columns.col(i).norm() + 1e-9) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Loads, InputLinearisationOf, testing::Values("", ", torque_about: [0.14, 0.01, 0.03]"));

TEST(InputLinearisation, NamesTheErrorsOfATorqueThatActs) {
  Setting force, torque(pushed(", torque_about: [0.14, 0.01, 0.03]"));
  const auto names = [](const Setting& setting) {
    std::string out;
    for (const InputGroup& group : InputLinearisation(*setting.question, *setting.models).groups()) {
      if (group.load >= 0) out += group.error + " [" + group.unit + "] ";
    }
    return out;
  };
  EXPECT_EQ(names(force), "gain [-] bias [N] delay [s] hysteresis [N] direction [rad] noise [N] ");
  EXPECT_EQ(
      names(torque),
      "gain [-] bias [N] torque bias [N m] delay [s] hysteresis [N] torque hysteresis [N m] direction [rad] noise [N] "
      "torque noise [N m] ");
}

}  // namespace
}  // namespace tissue_stiffness
