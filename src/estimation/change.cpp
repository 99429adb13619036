#include "estimation/change.hpp"

#include <algorithm>
#include <cmath>

#include "fit/coordinate_scan.hpp"
#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kBack[] = {3, 4, 6, 8, 12, 16, 24, 32, 48};  // frames before the newest: instants tried first
constexpr std::size_t kNear = 3;    // frames to either side of an instant that is roughly known
constexpr int kPoints = 6;          // on either side, in the first scan of a coordinate
constexpr double kReach = 1.5;      // prior standard deviations: reach of that scan
constexpr double kWidth = 0.01;     // of the prior's standard deviation: last step of the search
constexpr double kAsLikely = 4.0;   // excess in cost up to which an instant may be the right one
constexpr int kCuts = 3;            // refinements of the time between two instants
constexpr int kPieces = 6;          // pieces that each refinement divides it into
constexpr double kShortest = 1.0;   // [s] that a change may have built up for, at least
constexpr double kEvidence = 20.0;  // fall of the cost that a change must bring
constexpr double kExplains = 0.8;   // share of the misfit's excess that it must explain

/// An instant holds a free run's motion, to go on from.
struct Instant {
  RunStart from;
  std::size_t first = 0;  ///< first frame after it
};

/// A guess is what a change at an instant would lead to.
struct Guess {
  Instant at;
  Eigen::VectorXd w;
  double cost = 0.0;  ///< of the frames after the first instant tried, and of the change itself
};

class Search {
 public:
  Search(const FitProblem& problem, const ChangeQuestion& question)
      : problem_(problem),
        question_(question),
        scanned_std_(
            (problem.model.parameters().drift().array() > 0.0).select(problem.model.parameters().prior_std(), 0.0)),
        theta_(problem.model.parameters().theta(question.w)) {}

  std::optional<Change> operator()() {
    std::vector<Instant> instants = spread_instants();
    if (instants.empty()) return std::nullopt;
    run_before(instants.front());
    Guess best = best_of(instants, question_.w, true);
    for (int cut = 0; cut < kCuts; ++cut) {
      instants = closer(instants, best);
      Guess now = best_of(instants, best.w, false);
      if (now.cost < best.cost) best = std::move(now);
    }
    const double scale = std::max(1.0, question_.misfit);
    const double gain = (total_ - best.cost) / scale, excess = total_ / scale - rows_;
    if (gain < kEvidence || gain < kExplains * excess) return std::nullopt;
    return Change{best.at.from, best.w, discrepancy(best, scale), best.at.first};
  }

 private:
  double arrival(std::size_t frame) const { return problem_.frames[frame].time - problem_.model.sensors().delay(theta_); }

  std::vector<Instant> spread_instants() const {
    std::vector<Instant> out;
    const auto run = problem_.forward.begin(theta_, problem_.start);
    for (const std::size_t frame : first_frames()) {
      problem_.checkpoint();
      run->advance(arrival(frame));
      out.push_back({{arrival(frame), problem_.forward.resume(theta_, *run)}, frame + 1});
    }
    return out;
  }

  // Returns the frames after which a change is searched first.
  std::vector<std::size_t> first_frames() const {
    const std::size_t count = problem_.frames.size();
    std::vector<std::size_t> out;
    if (!question_.near) {
      for (auto back = std::rbegin(kBack); back != std::rend(kBack); ++back) {
        if (*back + 1 < count) out.push_back(count - *back - 1);
      }
      return out;
    }
    for (std::size_t frame = 0; frame + kNear < count; ++frame) {
      const double next = arrival(std::min(frame + kNear, count - 1)), last = arrival(frame < kNear ? 0 : frame - kNear);
      if (last <= *question_.near && *question_.near <= next) out.push_back(frame);
    }
    return out;
  }

  // Runs without a change, from the first instant on. It sums up what a later change leaves before it, and altogether.
  void run_before(const Instant& at) {
    first_ = at.first;
    before_.assign(1, 0.0);
    const auto run = problem_.forward.resume(theta_, *at.from.motion);
    for (std::size_t k = first_; k < problem_.frames.size(); ++k) {
      const FreeFit fit = frame_fit(*run, k, theta_);
      before_.push_back(before_.back() + fit.cost);
      rows_ += fit.rows;
    }
    total_ = before_.back();
  }

  FreeFit frame_fit(Trajectory& run, std::size_t frame, const Eigen::VectorXd& theta) const {
    problem_.checkpoint();
    run.advance(problem_.frames[frame].time - problem_.model.sensors().delay(theta));
    return fit_frame(problem_, problem_.frames[frame], theta, run.output());
  }

  double cost_after(const Instant& at, const Eigen::VectorXd& w) const {
    const Eigen::VectorXd theta = problem_.model.parameters().theta(w);
    const auto run = problem_.forward.resume(theta, *at.from.motion);
    double cost = before_[at.first - first_];
    for (std::size_t k = at.first; k < problem_.frames.size(); ++k) cost += frame_fit(*run, k, theta).cost;
    const Eigen::VectorXd variance = drifted(problem_.model, at.from.time - problem_.start.time);
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      if (variance[i] > 0.0) cost += std::pow(w[i] - question_.w[i], 2) / variance[i];
    }
    return cost;
  }

  // Returns where the cost is least along the drifting coordinates from `w` on; `far` scans them widely first.
  Guess guess(const Instant& at, const Eigen::VectorXd& w, bool far) const {
    const auto cost_of = [&](const Eigen::VectorXd& x) { return cost_after(at, x); };
    Guess best{at, w, 0.0};
    if (far) {
      const ScanResult found = scan_coordinates(cost_of, w, w, scanned_std_, kPoints, kReach);
      best.w = found.best;
      best.cost = found.lowest;
    } else {
      best.cost = cost_of(w);
    }
    const auto attempt = [&](Eigen::Index i, double value) {
      Guess next{at, best.w, 0.0};
      next.w[i] = value;
      next.cost = cost_of(next.w);
      const double cost = next.cost;
      if (cost < best.cost) best = std::move(next);
      return cost;
    };
    for (const double width : far ? std::vector<double>{0.1, 0.03, kWidth} : std::vector<double>{kWidth}) {
      for (Eigen::Index i = 0; i < w.size(); ++i) {
        if (scanned_std_[i] == 0.0) continue;
        const double h = width * scanned_std_[i], middle = best.w[i], cost = best.cost;
        const double low = attempt(i, middle - h), high = attempt(i, middle + h);
        const double bend = low + high - 2.0 * cost;
        if (bend > 0.0) attempt(i, middle + h * std::clamp(0.5 * (low - high) / bend, -4.0, 4.0));
      }
    }
    return best;
  }

  Guess best_of(const std::vector<Instant>& instants, const Eigen::VectorXd& from, bool far) {
    std::vector<Guess> guesses(instants.size());
    for_each_index(instants.size(), [&](std::size_t i) { guesses[i] = guess(instants[i], from, far); });
    seen_.insert(seen_.end(), guesses.begin(), guesses.end());
    return *std::min_element(guesses.begin(), guesses.end(),
                             [](const Guess& a, const Guess& b) { return a.cost < b.cost; });
  }

  // Returns the uncertainty of the parameters after the change, about 1 sigma: its instant and the parameters before it are
  // not exactly known.
  Eigen::VectorXd discrepancy(const Guess& best, double scale) const {
    Eigen::VectorXd square = Eigen::VectorXd::Zero(best.w.size());
    for (const Guess& other : seen_) {
      const double worse = (other.cost - best.cost) / scale;
      if (worse < kAsLikely) square = square.cwiseMax((other.w - best.w).cwiseAbs2());
    }
    square /= kAsLikely;
    for (Eigen::Index i = 0; i < best.w.size(); ++i) {
      Eigen::VectorXd before = question_.w;
      before[i] += std::sqrt(question_.covariance(i, i));
      const auto run = problem_.forward.begin(problem_.model.parameters().theta(before), problem_.start);
      run->advance(best.at.from.time);
      const Instant moved{{best.at.from.time, problem_.forward.resume(theta_, *run)}, best.at.first};
      square += (guess(moved, best.w, false).w - best.w).cwiseAbs2();
    }
    return square.cwiseSqrt();
  }

  // Returns instants between the neighbours of the best one, because a change falls between frames.
  std::vector<Instant> closer(const std::vector<Instant>& instants, const Guess& best) const {
    const auto later =
        std::find_if(instants.begin(), instants.end(), [&](const Instant& i) { return i.from.time > best.at.from.time; });
    const double high = later == instants.end() ? best.at.from.time : later->from.time;
    const auto earlier = std::find_if(std::make_reverse_iterator(later), instants.rend(),
                                      [&](const Instant& i) { return i.from.time < best.at.from.time; });
    const Instant low = earlier == instants.rend() ? best.at : *earlier;
    std::vector<Instant> out{low};
    const auto run = problem_.forward.resume(theta_, *low.from.motion);
    for (int k = 1; k <= kPieces; ++k) {
      double time = low.from.time + (high - low.from.time) * k / kPieces;
      std::size_t first = low.first;
      while (first < problem_.frames.size() && arrival(first) <= time) ++first;
      if (problem_.model.nonlinear()) time = arrival(first - 1);  // its steps divide a frame
      if (first + 2 >= problem_.frames.size() || time <= out.back().from.time) continue;
      run->advance(time);
      out.push_back({{time, problem_.forward.resume(theta_, *run)}, first});
    }
    return out;
  }

  const FitProblem& problem_;
  const ChangeQuestion& question_;
  Eigen::VectorXd scanned_std_;  ///< the prior's; 0 where nothing drifts
  Eigen::VectorXd theta_;
  std::vector<Guess> seen_;
  std::size_t first_ = 0;
  std::vector<double> before_;  ///< cost of the frames from the first instant up to each
  double total_ = 0.0, rows_ = 0.0;
};

}  // namespace

std::optional<Change> find_change(const FitProblem& problem, const ChangeQuestion& question) {
  return Search(problem, question)();
}

Eigen::VectorXd drifted(const Model& model, double span) {
  return std::max(kShortest, span) * model.parameters().drift().cwiseAbs2();
}

}  // namespace tissue_stiffness
