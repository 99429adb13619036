#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effects/load_error.hpp"
#include "estimation/force_noise.hpp"
#include "estimation/input_models.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/normal_equations.hpp"

namespace tissue_stiffness {

/// Columns of z that hold one kind of error of one input, in units of its tolerance.
struct InputGroup {
  std::string input;       ///< topic
  std::string error;       ///< gain, bias, delay, ...
  std::string unit;        ///< of the tolerance
  double tolerance = 0.0;  ///< 1 sigma of one column; 0: the error does not occur
  Eigen::Index first = 0, count = 0;
  int load = -1;          ///< number of the load that all these errors belong to; -1: of no load
  bool pressure = false;  ///< of a pressure, whose force grows with the area
};

/// The linearisation gives a recording's rows as functions of the parameters, the loads' and poses' errors and the
/// constants. The runs start anew for each point, from rest or the initial velocity.
class InputLinearisation {
 public:
  /// A row object holds the rows of one frame. The columns of the loads' errors are `modes` times their modal amplitudes.
  struct Row {
    Eigen::VectorXd error, precision;
    Eigen::VectorXi nodes;                          ///< as Prediction has them
    Eigen::Matrix3Xd places;                        ///< where each row was measured [m]
    Eigen::MatrixXd parameters, constants, direct;  ///< d row / d each; direct: by poses, force sensors, mesh
    std::vector<Eigen::Index> forces;               ///< rows of force sensors
    Eigen::MatrixXd modes;  ///< d row / d amplitude of each mode, and then by each reaction of a run's output
  };
  struct Load {
    std::string topic;
    std::shared_ptr<Course> course;
    LoadErrorBasis basis;
    Eigen::Index first;  ///< first of its columns in z
  };
  struct Pose {
    int source;
    double rotation, offset;  ///< tolerances [rad], [m]
    Eigen::Index first;
  };
  /// A sensor of forces. Its columns are gain, offset (3) and rotation (3).
  struct ForceSensor {
    int source;
    double gain, bias, rotation;  ///< tolerances [-], [N], [rad]
    Eigen::Index first;
  };
  using Visitor = std::function<void(const Row&, const Eigen::MatrixXd& amplitudes)>;

  InputLinearisation(const MeshError::Question& question, InputModels& models);
  /// Restores the courses of the loads as they were measured.
  ~InputLinearisation();
  InputLinearisation(const InputLinearisation&) = delete;
  InputLinearisation& operator=(const InputLinearisation&) = delete;

  Eigen::Index size() const { return size_; }
  double repeated() const { return repeated_; }  ///< recorded frames for each used one
  const std::vector<Load>& loads() const { return loads_; }
  /// Returns all columns of z between the parameters and the mesh, in their order.
  std::vector<InputGroup> groups() const;
  /// Returns the first of the columns that say what the mesh may change; they are the last of z.
  Eigen::Index first_of_mesh() const { return size_ - mesh_columns_; }

  /// Sets by how much the variance of a force sensor's noise is larger than stated. NormalEquations tell it.
  void set_force_noise(int source, double variance) { force_noise_.set(source, variance); }
  /// Returns the normal equations at z, those of the constants only where these are varied. Throws NumericalError when
  /// runs diverge.
  NormalEquations at(const Eigen::VectorXd& z, Constants constants);
  /// Visits every used frame in the order of time. Rows have no columns of constants that are held.
  void each_row(const Eigen::VectorXd& z, Constants constants, const Visitor& visit);

 private:
  void add_load(const std::string& topic, const std::shared_ptr<Course>& course);
  void add_pose(std::size_t source);
  void add_force_sensor(std::size_t source);
  void correct_loads(const Eigen::VectorXd& z);
  std::vector<Eigen::VectorXd> points(const Eigen::VectorXd& w, Constants constants) const;
  Eigen::MatrixXd modes_seen(const Frame& frame, const Eigen::VectorXd& theta, const Eigen::MatrixXd& seen,
                             const ReducedModes& modes) const;
  /// `u`: the output of a run for each theta; `offset`: that of the body whose surface lies further out, or empty.
  Row row(std::size_t index, const std::vector<Eigen::VectorXd>& thetas, const Eigen::MatrixXd& u,
          const Eigen::VectorXd& offset, const ReducedModes& modes, const Eigen::VectorXd& z);
  const Eigen::MatrixXd& motions_seen(const Frame& frame, const Eigen::VectorXd& theta, const Eigen::VectorXd& u);
  Eigen::MatrixXd sensor_columns(const Frame& frame, const Prediction& there, const Eigen::VectorXd& u,
                                 const Eigen::MatrixXd& rigid) const;
  Eigen::MatrixXd mesh_columns(std::size_t frame, const Eigen::MatrixXd& modes, const Eigen::VectorXd& precision) const;
  Eigen::Index sensor_column_count() const {
    return 6 * static_cast<Eigen::Index>(poses_.size()) + 7 * static_cast<Eigen::Index>(force_sensors_.size());
  }
  Eigen::Index direct_columns() const { return sensor_column_count() + mesh_columns_; }
  Eigen::Index load_columns() const { return size_ - p_ - direct_columns(); }
  const MeshError::Question& q_;
  InputModels& models_;
  std::vector<std::size_t> frames_;  ///< indices of the used frames
  double repeated_ = 1.0;
  Eigen::Index p_ = 0, size_ = 0, mesh_columns_ = 0;
  std::vector<Load> loads_;
  std::vector<Pose> poses_;
  std::vector<ForceSensor> force_sensors_;
  ForceNoise force_noise_;
  Eigen::MatrixXd motions_;                            ///< the runs' basis, then the rigid motions
  std::map<std::vector<int>, Eigen::MatrixXd> named_;  ///< rows / amplitude of each motion, by the named nodes seen
  Eigen::MatrixXd seen_;                               ///< rows / amplitude of each motion, for any other frame
};

}  // namespace tissue_stiffness
