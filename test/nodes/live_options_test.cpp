#include "nodes/live_options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "expect_input_error.hpp"
#include "nodes/node_keys.hpp"

namespace tissue_stiffness {
namespace {

const std::string kWhere = "parameters of /estimator_node";

LiveOptions others() {
  LiveOptions out;
  out.check = {0.0, 7.0};
  out.limits = {0.05, 1.5};
  out.colour_limit = 6.0;
  return out;
}

void expect_same(const LiveOptions& a, const LiveOptions& b) {
  EXPECT_EQ(a.check.period, b.check.period);
  EXPECT_EQ(a.check.window, b.check.window);
  EXPECT_EQ(a.limits.converged_within, b.limits.converged_within);
  EXPECT_EQ(a.limits.stale_after, b.limits.stale_after);
  EXPECT_EQ(a.colour_limit, b.colour_limit);
}

TEST(LiveOptions, ComeBackFromDynamicReconfigure) {
  expect_same(to_live_options(to_config(others()), kWhere), others());
}

TEST(LiveOptions, HaveTheDefaultsOfTheGeneratedConfiguration) {
  const LiveOptions start = read_live_options(Value::map({}, kWhere), StateLimits().stale_after);
  expect_same(start, to_live_options(EstimatorConfig::__getDefault__(), kWhere));
  expect_same(start, [] {
    LiveOptions out;
    out.check = {10.0, 20.0};
    return out;
  }());
}

TEST(LiveOptions, TakeStaleAfterFromTheModelWhereTheNodeHasNone) {
  EXPECT_EQ(read_live_options(Value::map({}, kWhere), 5.0).limits.stale_after, 5.0);
  const Value own = Value::map({{"stale_after", Value::number(0.5, kWhere + ": stale_after")}}, kWhere);
  EXPECT_EQ(read_live_options(own, 5.0).limits.stale_after, 0.5);
}

TEST(LiveOptions, AreDescribedAsInTheNodesKeys) {
  const auto description = EstimatorConfig::__getDescriptionMessage__();
  ASSERT_EQ(description.groups.size(), 1U);
  ASSERT_EQ(description.groups[0].parameters.size(), 5U);
  for (const auto& parameter : description.groups[0].parameters) {
    EXPECT_EQ(parameter.description, find_key(node_keys("estimator_node"), parameter.name).meaning) << parameter.name;
  }
}

TEST(LiveOptions, RefuseWhatIsOutOfRange) {
  const auto refused = [](double EstimatorConfig::*member, double value, const std::vector<std::string>& parts) {
    EstimatorConfig config = to_config(others());
    config.*member = value;
    expect_input_error([&] { to_live_options(config, kWhere); }, parts);
  };
  refused(&EstimatorConfig::diagnosis_window, -1.0, {kWhere + ": diagnosis_window", "-1", "from 1 to 100000 [s]"});
  refused(&EstimatorConfig::diagnosis_period, -0.5, {kWhere + ": diagnosis_period", "-0.5", "0 to"});
  refused(&EstimatorConfig::converged_within, 0.5, {kWhere + ": converged_within", "0.5", "0.001 to 0.2"});
  refused(&EstimatorConfig::stale_after, 0.0, {kWhere + ": stale_after", "0"});
  refused(&EstimatorConfig::colour_limit, std::nan(""), {kWhere + ": colour_limit", "nan", "0.1 to 1000"});
}

TEST(LiveOptions, AllowTheEndsOfTheirRanges) {
  EXPECT_NO_THROW(to_live_options(least_config(), kWhere));
  EstimatorConfig largest = largest_config();
  EXPECT_EQ(largest.converged_within, 0.2) << "a looser limit than the default would call less certain estimates converged";
  EXPECT_EQ(largest.stale_after, std::numeric_limits<double>::infinity());
  largest.stale_after = 1e9;
  EXPECT_NO_THROW(to_live_options(largest, kWhere));
}

}  // namespace
}  // namespace tissue_stiffness
