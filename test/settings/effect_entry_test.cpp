#include "settings/effect_entry.hpp"

#include <gtest/gtest.h>

#include "settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

const EffectEntry kFibres{"fibres",
                          {{"region", "tip"},
                           {"direction", Eigen::Vector3d(0.0, 1.0, -1.0 / 3.0)},
                           {"angle", normal_prior(-0.7853981634, 0.3)},
                           {"modulus", log_normal_prior(15e3, 3.0)},
                           {"force", normal_prior(Eigen::Vector3d(1.0, 2e-9, 0.0), 0.1)},
                           {"tau", 1.0 / 3.0}}};

TEST(EffectEntry, IsWrittenAsInAModelFile) {
  EXPECT_EQ(
      to_yaml(kFibres),
      "fibres: {region: tip, direction: [0, 1, -0.333333], angle: {mean: -0.785398, std: 0.3}, modulus: {prior: 15000, "
      "factor: 3}, force: {mean: [1, 2e-09, 0], std: 0.1}, tau: 0.333333}");
  EXPECT_EQ(to_yaml(EffectEntry{"gravity", {}}), "gravity: {}");
}

TEST(EffectEntry, IsTheEffectThatItsTextIs) {
  ModelSettings direct, text;
  add_effect(direct, kFibres);
  add_effect(text, to_yaml(kFibres));
  EXPECT_EQ(direct.effects.front().name, "fibres");
  EXPECT_TRUE(direct.effects.front().arguments.same(text.effects.front().arguments));
  const Value& arguments = direct.effects.front().arguments;
  EXPECT_EQ(arguments.at("tau").as_number(0.0, 1.0, "s"), 0.333333);
  const Quantity modulus = arguments.at("modulus").as_quantity(0.0, 1e9, "Pa");
  EXPECT_EQ(modulus.kind, Quantity::Kind::log_normal);
  EXPECT_EQ(modulus.value, 15e3);
  EXPECT_EQ(modulus.spread, 3.0);
}

TEST(EffectEntry, QuotesTextThatYamlWouldReadOtherwise) {
  for (const std::string name :
       {"tip", "left_lung-2.b", "/load", "true", "12", "1e3", "null", "", "a, b}", "it's", "x: y", "-"}) {
    const EffectEntry entry{"traction", {{"region", name}}};
    EXPECT_TRUE(parse_yaml(to_yaml(entry), "").at("traction").same(to_settings(entry).arguments)) << to_yaml(entry);
  }
  EXPECT_EQ(to_yaml(Argument("left_lung-2.b")), "left_lung-2.b");
  EXPECT_EQ(to_yaml(Argument("12")), "'12'");
}

TEST(EffectEntry, AreNumberedAndAppendedInOrder) {
  const ModelSettings model =
      extend_model(ModelSettings(), std::vector<EffectEntry>{{"gravity", {}}, {"inertia", {}}, {"gravity", {}}});
  ASSERT_EQ(model.effects.size(), 3U);
  EXPECT_EQ(model.effects[1].label, "inertia");
  EXPECT_EQ(model.effects[2].label, "gravity#2");
}

TEST(EffectEntry, IsComparedByItsArguments) {
  EffectEntry other = kFibres;
  EXPECT_TRUE(kFibres.same(other));
  other.arguments.back().second = 0.3333331;  // the same to six digits
  EXPECT_TRUE(kFibres.same(other));
  other.arguments.back().second = 0.34;
  EXPECT_FALSE(kFibres.same(other));
  EXPECT_TRUE(kFibres.without("tau").same(other.without("tau")));
  other.effect = "others";
  EXPECT_FALSE(kFibres.without("tau").same(other.without("tau")));
  EXPECT_EQ(kFibres.without("tau").find("tau"), nullptr);
  ASSERT_NE(kFibres.find("region"), nullptr);
  EXPECT_TRUE(kFibres.find("region")->is("tip"));
  EXPECT_FALSE(kFibres.find("tau")->is("tip"));
}

}  // namespace
}  // namespace tissue_stiffness
