#include "tissue_stiffness/diagnosis/first_look.hpp"

#include <algorithm>
#include <utility>

#include "tissue_stiffness/forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kAdequate = 1.1;       // rms in sigmas up to which a residual may be noise
constexpr double kNumerics = 0.8;       // of the structured part, from which a finer mesh explains it
constexpr double kExplains = 0.85;      // of it: less is no explanation
constexpr double kNearly = 0.8;         // unless what is left is little beside the noise
constexpr double kLittle = 0.1;         // of the noise's sum of squares
constexpr double kPairExplains = 0.97;  // two effects imitate most of a third: gravity with a delay 94 % of viscoelasticity

// Of the sum of squares: a mesh's change that would add more to it is none of the error's. The fit on the finer mesh has
// ended in another minimum, or what is missing has led both fits astray.
constexpr double kElsewhere = 0.2;

}  // namespace

FirstLook::FirstLook(const Fitted& fitted, const DiagnosisOptions& options, FinerMesh earlier, Library known_library)
    : base(fitted),
      rows(fitted.rows.count()),
      cost(fitted.rows.error.squaredNorm()),
      first(earlier.change.size() == 0),
      library(std::move(known_library)),
      finer(std::move(earlier)) {
  const std::string step = "tangents of the library, and what a finer mesh would change";
  options.progress(step, 0, 0);
  const Study::Rows& r = base.rows;
  const auto worsens = [&](const Eigen::VectorXd& by) { return (r.error - by).squaredNorm() > (1.0 + kElsewhere) * cost; };
  const bool within_noise = noise() && options.add.empty();  // who asks for effects by name may have any
  run_side_by_side(
      [&] {
        candidates = find_candidates(
            *base.study, base.fit.w, within_noise, options.ignore,
            [&](std::size_t done, std::size_t total) { options.progress(step, done, total); }, library);
        known = base_tangents(*base.study, base.fit.w, base.fit.covariance.diagonal().cwiseSqrt(), r);
      },
      [&] {
        if (!finer.change.any() || worsens(finer.change)) finer = finer_mesh(base, finer.study.get());
      });
  if (worsens(finer.change)) finer.change.setZero();
  by_mesh = cost - (r.error - finer.change).squaredNorm();
  floor = Scorer(r.error, known, r.offsets, 1.0).remaining(finer.change);
  // An effect has to explain what the mesh does not.
  scorer = std::make_unique<Scorer>(r.error - finer.change, known, r.offsets, 1.0, kRemainder * finer.change);
  ranked = rank(*scorer, candidates, kRemainder * floor);
}

double FirstLook::structured() const {
  return std::max(0.0, cost - rows);
}

double FirstLook::unavoidable() const {
  return unavoidable_mean_square(floor) * rows;
}

bool FirstLook::noise() const {
  return cost < kAdequate * kAdequate * rows;
}

bool FirstLook::numerics() const {
  return by_mesh > kNumerics * structured();
}

bool FirstLook::explained_by(const Refit& refit) const {
  const double of_mesh = floor * floor * rows;
  const auto takes = [&](double share, double left) { return left < std::max((1.0 - share) * structured(), of_mesh); };
  const double left = refit.cost - rows;
  const double alone = left < of_mesh + kLittle * rows ? kNearly : kExplains;
  return takes(refit.effects.size() > 1 ? kPairExplains : alone, left) ||
         takes(kPairExplains, refit.cost_beside_steps - rows);
}

}  // namespace tissue_stiffness
