#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "forward/forward_model.hpp"
#include "forward/reduced_basis.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// A body with known parameters, filmed: recordings from the estimator's own mesh and integrator, so that nothing but the
/// noise is between the model and the measurement.
class Experiment {
 public:
  /// `truth`: values of the model's free parameters, in their order and units. `basis`: that it moves in.
  Experiment(const ModelSettings& settings, const TetMesh& mesh, const std::vector<double>& truth,
             const BasisOptions& basis = {});

  void set_truth(const std::vector<double>& truth);

  /// Loads are fed before film().
  void add_load(const LoadSample& sample);
  void clear_loads();

  struct Moment {
    double time;                   ///< [s]
    Eigen::VectorXd displacement;  ///< 3n [m]
  };
  /// At `first` [s], where the body is at rest, and every `interval` [s] after it; `count` moments.
  std::vector<Moment> film(double first, double interval, int count) const;

  const Model& model() const { return model_; }
  const TetMesh& mesh() const { return model_.mesh(); }

 private:
  Model model_;
  std::unique_ptr<ForwardModel> forward_;
  Eigen::VectorXd theta_;
};

/// 3 x count normal numbers of standard deviation `sigma`.
Eigen::Matrix3Xd draw(Eigen::Index count, double sigma, std::mt19937& engine);

/// A frame of tracked mesh vertices (`ids`), each coordinate off by normal noise [m].
Frame see_vertices(const Experiment& experiment, const Experiment::Moment& moment, const std::vector<int>& ids,
                   double noise, std::mt19937& engine);

/// Every moment of a body on a finer mesh seen at the vertices `ids` of a coarser one. Throws std::invalid_argument where
/// the finer mesh has no vertex there.
std::vector<Frame> see_on(const TetMesh& coarse, const std::vector<int>& ids, const Experiment& finer,
                          const std::vector<Experiment::Moment>& moments, double noise, std::mt19937& engine);

/// 0, 1, ... of all corner vertices.
std::vector<int> corners(const TetMesh& mesh);

/// Every moment seen like that, all corner vertices of the mesh.
std::vector<Frame> see_all(const Experiment& experiment, const std::vector<Experiment::Moment>& moments, double noise,
                           unsigned seed);

}  // namespace tissue_stiffness
