#include "estimation/replay_recorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ThinSurface, IsTheSurfaceWhereThatIsSmallEnough) {
  const TetMesh mesh = bar_mesh();
  const ThinSurface thin(mesh, 100000);
  EXPECT_EQ(thin.triangles.cols(), 4 * mesh.facet_count());
  const Eigen::Matrix3Xd places = thin.mean(Eigen::Map<const Eigen::VectorXd>(mesh.nodes.data(), mesh.nodes.size()));
  for (std::size_t v = 0; v < thin.members.size(); ++v) {
    ASSERT_EQ(thin.members[v].size(), 1u);
    EXPECT_EQ(places.col(static_cast<Eigen::Index>(v)), mesh.nodes.col(thin.members[v].front()));
  }
}

TEST(ThinSurface, JoinsNodesOfALargeOne) {
  const TetMesh mesh = bar_mesh(20, 4, 4);
  const std::size_t most = 200;
  const ThinSurface all(mesh, 100000), thin(mesh, most);
  ASSERT_GT(all.members.size(), most);
  EXPECT_LE(thin.members.size(), most);
  std::size_t nodes = 0;
  for (const auto& members : thin.members) nodes += members.size();
  EXPECT_EQ(nodes, all.members.size());
  EXPECT_GT(thin.triangles.cols(), 100);
  for (Eigen::Index t = 0; t < thin.triangles.cols(); ++t) {
    const Eigen::Vector3i c = thin.triangles.col(t);
    EXPECT_TRUE(c[0] != c[1] && c[1] != c[2] && c[2] != c[0]);
    EXPECT_LT(c.maxCoeff(), static_cast<int>(thin.members.size()));
  }
}

TEST(ThinSurface, TakesTheMisfitWhereThereIsOne) {
  const TetMesh mesh = bar_mesh(20, 4, 4);
  const ThinSurface thin(mesh, 200);
  Eigen::VectorXd misfit = Eigen::VectorXd::Constant(mesh.node_count(), kNaN);
  const auto large = std::find_if(thin.members.begin(), thin.members.end(), [](const auto& m) { return m.size() > 2; });
  ASSERT_NE(large, thin.members.end());
  misfit[(*large)[0]] = 3.0;
  misfit[(*large)[1]] = 4.0;
  const Eigen::VectorXd seen = thin.rms(misfit);
  EXPECT_DOUBLE_EQ(seen[large - thin.members.begin()], std::sqrt(12.5));
  EXPECT_EQ(seen.array().isFinite().count(), 1);
}

/// The long run gives frame k, in which everything moves with k; vertex 3 is lost in frame 2.
class LongRun {
 public:
  explicit LongRun(const TetMesh& mesh) : mesh_(mesh) {}
  void add_to(ReplayRecorder& recorder, int k) const {
    Observation seen;
    seen.ids = k == 2 ? Eigen::VectorXi::Constant(1, 5) : Eigen::VectorXi(Eigen::Vector2i(5, 3));
    seen.points = Eigen::Matrix3Xd::Constant(3, seen.ids.size(), 1e-3 * k);
    const Frame frame{100.0 + 0.01 * k, {seen}};
    Prediction p;
    p.measured = Eigen::VectorXd::Constant(3 * seen.ids.size(), 1e-3 * k);
    p.predicted = p.measured.array() + 2e-4;
    Misfit misfit;
    misfit.rms = k;
    misfit.node_error = misfit.node_sigmas = Eigen::VectorXd::Constant(mesh_.node_count(), k);
    const Eigen::VectorXd u = Eigen::VectorXd::Constant(3 * mesh_.node_count(), 1e-3 * k);
    recorder.add({frame, p, misfit, u, [](const Observation&) { return Eigen::Matrix4Xd(); }});
  }

 private:
  const TetMesh& mesh_;
};

TEST(ReplayRecorder, KeepsEveryFrameOfAShortRun) {
  const TetMesh mesh = bar_mesh();
  ReplayRecorder recorder(mesh, 99.0, {});
  const LongRun run(mesh);
  for (int k = 0; k < 10; ++k) run.add_to(recorder, k);
  const Replay replay = recorder.finish();
  ASSERT_EQ(replay.time.size(), 10u);
  EXPECT_NEAR(replay.time[4], 1.04, 1e-9);
  ASSERT_EQ(replay.tracks.size(), 2u);
  EXPECT_EQ(replay.tracks[0].name, "vertex 3");
  EXPECT_DOUBLE_EQ(replay.tracks[0].measured(1, 7), 7e-3);
  EXPECT_DOUBLE_EQ(replay.tracks[0].predicted(1, 7), 7.2e-3);
  EXPECT_TRUE(std::isnan(replay.tracks[0].measured(0, 2)));
  EXPECT_DOUBLE_EQ(replay.tracks[1].measured(0, 2), 2e-3);
}

TEST(ReplayRecorder, ThinsALongOneAndKeepsItsListsInStep) {
  const TetMesh mesh = bar_mesh(20, 4, 4);
  ReplayRecorder recorder(mesh, 100.0, {});
  const LongRun run(mesh);
  for (int k = 0; k < 3000; ++k) run.add_to(recorder, k);
  const Replay replay = recorder.finish();
  EXPECT_GT(replay.time.size(), 200u);
  EXPECT_LE(replay.time.size(), 480u);
  for (std::size_t i = 0; i < replay.time.size(); ++i) EXPECT_NEAR(replay.time[i], 0.01 * replay.rms[i], 1e-9);
  const ReplaySurface& surface = replay.surface;
  ASSERT_EQ(surface.frames.size(), surface.displacement.size());
  ASSERT_EQ(surface.frames.size(), surface.error.size());
  ASSERT_EQ(surface.frames.size(), surface.sigmas.size());
  EXPECT_LT(surface.frames.size(), replay.time.size());
  for (std::size_t i = 0; i < surface.frames.size(); ++i) {
    const auto k = static_cast<std::size_t>(surface.frames[i]);
    ASSERT_LT(k, replay.time.size());
    EXPECT_NEAR(surface.displacement[i](0, 0), 0.1 * replay.time[k], 1e-9);
    EXPECT_DOUBLE_EQ(surface.error[i][0], replay.rms[k]);
  }
}

TEST(ReplayRecorder, FollowsTheEdgesOfAnOutlineWhereTheModelHasThem) {
  const TetMesh mesh = bar_mesh();
  constexpr double scale = 1e-3;  // metres per pixel
  auto contour = std::make_shared<Contour>();
  contour->points.resize(2, 4);
  contour->points << 10, 50, 30, 30, 20, 20, 5, 90;
  contour->normals.resize(2, 4);
  contour->normals << -1, 1, 0, 0, 0, 0, -1, 1;
  contour->sigma = Eigen::VectorXd::Ones(4);
  Observation seen;
  seen.kind = ObservationKind::contour;
  seen.time = 7.0;
  seen.contour = contour;
  const Frame frame{7.0, {seen}};
  Prediction p;
  p.measured = Eigen::VectorXd::Zero(4);
  p.predicted = scale * Eigen::Vector4d(2.0, -3.0, 0.0, kNaN);
  p.places = Eigen::Matrix3Xd::Zero(3, 4);
  p.places.topRows<2>() = scale * contour->points;
  Misfit misfit;
  misfit.node_error = misfit.node_sigmas = Eigen::VectorXd::Zero(mesh.node_count());
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * mesh.node_count());
  ReplayRecorder recorder(mesh, 5.0, {7.0});
  recorder.add({frame, p, misfit, u, [](const Observation&) { return Eigen::Matrix4Xd::Ones(4, 2); }});
  const Replay replay = recorder.finish();
  ASSERT_EQ(replay.tracks.size(), 1u);
  const ReplayTrack& track = replay.tracks.front();
  EXPECT_EQ(track.unit, "pixel");
  EXPECT_TRUE(track.measured.col(0).isApprox(Eigen::Vector4d(10, 50, 5, 20)));  // not the 90 that the model lacks
  EXPECT_TRUE(track.predicted.col(0).isApprox(Eigen::Vector4d(8, 47, 5, 20), 1e-6));
  ASSERT_EQ(replay.outlines.size(), 1u);
  EXPECT_EQ(replay.outlines.front().time, 2.0);
  EXPECT_EQ(replay.outlines.front().predicted.cols(), 2);
}

TEST(ReplayRecorder, ShowsTheFreeRunOfAnEstimator) {
  const TetMesh mesh = bar_mesh();
  const ModelSettings settings = box_settings(bar_under_gravity(prior(60e3, 3)));
  const Experiment bar(settings, mesh, {30e3});
  const auto moments = bar.film(0.0, kFilmed, 12);
  Estimator estimator(settings, mesh);
  step_through(estimator, see_all(bar, moments, kNoise, 3));
  ReplayRecorder recorder(estimator.mesh(), 0.0, {});
  const auto misfits = estimator.free_run([&](const FreeFrame& frame) { recorder.add(frame); });
  const Replay replay = recorder.finish();
  ASSERT_EQ(replay.rms.size(), misfits.size());
  ASSERT_EQ(replay.rms.size(), moments.size());
  for (std::size_t k = 0; k < misfits.size(); ++k) EXPECT_EQ(replay.rms[k], misfits[k].rms);
  const ReplayTrack& track = replay.tracks.back();
  const int vertex = std::stoi(track.name.substr(7));
  const Eigen::Vector3d truth = mesh.nodes.col(vertex) + moments.back().displacement.segment<3>(3 * vertex);
  EXPECT_LT((track.measured.rightCols<1>() - truth).norm(), 6.0 * kNoise);
  EXPECT_LT((track.predicted.rightCols<1>() - truth).norm(), 2.0 * kNoise);
}

}  // namespace
}  // namespace tissue_stiffness
