#include "forward/extrapolated_model.hpp"

#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

FullModel::Options with_steps(FullModel::Options options, int factor) {
  options.step = 0.0;
  options.steps_per_frame *= factor;
  return options;
}

class ExtrapolatedTrajectory : public Trajectory {
 public:
  ExtrapolatedTrajectory(std::unique_ptr<Trajectory> coarse, std::unique_ptr<Trajectory> fine)
      : coarse_(std::move(coarse)), fine_(std::move(fine)) {}

  void advance(double time) override {
    run_side_by_side([&] { fine_->advance(time); }, [&] { coarse_->advance(time); });
  }
  double time() const override { return fine_->time(); }
  Eigen::VectorXd displacement() const override { return extrapolated(fine_->displacement(), coarse_->displacement()); }
  Eigen::VectorXd output() const override { return extrapolated(fine_->output(), coarse_->output()); }
  Eigen::VectorXd velocity() const override { return extrapolated(fine_->velocity(), coarse_->velocity()); }

 private:
  static Eigen::VectorXd extrapolated(const Eigen::VectorXd& fine, const Eigen::VectorXd& coarse) {
    return (4.0 * fine - coarse) / 3.0;
  }
  std::unique_ptr<Trajectory> coarse_, fine_;
};

}  // namespace

ExtrapolatedModel::ExtrapolatedModel(const Model& model, const FullModel::Options& options)
    : coarse_(model, with_steps(options, 1)), fine_(model, with_steps(options, 2)) {}

std::unique_ptr<Trajectory> ExtrapolatedModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<ExtrapolatedTrajectory>(coarse_.start(theta, start), fine_.start(theta, start));
}

std::string ExtrapolatedModel::description() const {
  return "extrapolated from half the steps of: " + coarse_.description();
}

}  // namespace tissue_stiffness
