// Every effect of the library describes itself and refuses what is wrong: a new one is tested here without a new test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "every_effect.hpp"

namespace tissue_stiffness {
namespace {

std::string refused(const std::string& name, const Arguments& arguments, const std::string& law = "linear") {
  static const TetMesh mesh = bar_mesh(2);
  return refusal([&] { const Model model(box_settings(bar_with(name, arguments, law)), mesh); });
}

std::string refused(const EffectSpec& spec, const Arguments& arguments) {
  return refused(spec.name, arguments, fitting_law(spec));
}

TEST(EveryEffect, IsDescribedAndHasAFileOfItsName) {
  std::set<std::string> names;
  for (const EffectSpec& spec : effect_specs()) {
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name << " twice";
    const std::string file = std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/src/effects/" + spec.name + ".cpp";
    EXPECT_TRUE(std::ifstream(file).good()) << file;
    EXPECT_FALSE(spec.summary.empty()) << spec.name;
    EXPECT_FALSE(spec.formula.empty()) << spec.name;
    EXPECT_FALSE(spec.source.empty()) << spec.name;
    bool topic = false;
    for (const auto& key : spec.keys) {
      EXPECT_FALSE(key.second.empty()) << spec.name << "." << key.first;
      topic = topic || key.first == "topic";
    }
    EXPECT_EQ(topic, spec.load.has_value()) << spec.name << ": nodes and checks ask what its topic carries";
  }
  EXPECT_GE(names.size(), 10U);
}

TEST(EveryEffect, HasUnitsAndBounds) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const ParameterSpec& p : spec.parameters) {
      const std::string name = spec.name + "." + p.name;
      EXPECT_FALSE(p.name.empty() || p.symbol.empty() || p.unit.empty()) << name;
      EXPECT_LT(p.lower, p.upper) << name;
      EXPECT_TRUE(std::isfinite(p.lower) && std::isfinite(p.upper)) << name;
      EXPECT_TRUE(p.components == 1 || p.components == 3) << name;
      if (p.presence == ParameterSpec::Default::optional) {
        EXPECT_TRUE(p.value >= p.lower && p.value <= p.upper) << name;
      }
    }
  }
}

TEST(EveryEffect, IsBuiltFromItsSpec) {
  for (const EffectSpec& spec : effect_specs()) {
    EXPECT_EQ(refused(spec, example_arguments(spec)), "") << spec.name;
  }
}

TEST(EveryEffect, RefusesAnUnknownKey) {
  for (const EffectSpec& spec : effect_specs()) {
    Arguments arguments = example_arguments(spec);
    arguments["colour"] = "1";
    EXPECT_NE(refused(spec, arguments).find(spec.name + ".colour"), std::string::npos) << spec.name;
  }
}

TEST(EveryEffect, RefusesAMissingKey) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const auto& argument : example_arguments(spec)) {
      const auto named = [&](const ParameterSpec& p) { return p.name == argument.first && optional(p); };
      if (std::any_of(spec.parameters.begin(), spec.parameters.end(), named)) continue;
      Arguments without = example_arguments(spec);
      without.erase(argument.first);
      const std::string message = refused(spec, without);
      EXPECT_NE(message.find(argument.first), std::string::npos) << entry(spec.name, without) << " -> '" << message << "'";
      EXPECT_NE(message.find(spec.name), std::string::npos) << message;
    }
  }
}

TEST(EveryEffect, RefusesAValueOutOfBounds) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const ParameterSpec& p : spec.parameters) {
      const double beyond = 0.1 * (p.upper - p.lower);
      for (const double value : {p.lower - beyond, p.upper + beyond}) {
        Arguments arguments = example_arguments(spec);
        arguments[p.name] = text(p, value);
        const std::string message = refused(spec, arguments);
        EXPECT_NE(message.find(spec.name + "." + p.name), std::string::npos)
            << entry(spec.name, arguments) << " -> '" << message << "'";
        EXPECT_NE(message.find("allowed"), std::string::npos) << message;
      }
      Arguments arguments = example_arguments(spec);
      arguments[p.name] = "soft";
      EXPECT_NE(refused(spec, arguments).find(spec.name + "." + p.name), std::string::npos) << spec.name;
    }
  }
}

TEST(EveryEffect, RefusesARegionThatIsNotThere) {
  int checked = 0;
  for (const EffectSpec& spec : effect_specs()) {
    for (const auto& key : spec.keys) {
      if (key.first != "region") continue;
      Arguments arguments = example_arguments(spec);
      arguments["region"] = "tail";
      const std::string message = refused(spec, arguments);
      EXPECT_NE(message.find("tail"), std::string::npos) << spec.name;
      EXPECT_NE(message.find("clamp"), std::string::npos) << "names no region that there is: " << message;
      ++checked;
    }
  }
  EXPECT_GE(checked, 4);
}

// Whoever implements an interface must hand it out: otherwise the model would never call it.
TEST(EveryEffect, HandsOutTheInterfacesThatItImplements) {
  const TetMesh mesh = bar_mesh(2);
  int more = 0;
  for (const EffectSpec& spec : effect_specs()) {
    const std::string law = fitting_law(spec);
    const Model model(box_settings(bar_with(spec.name, example_arguments(spec, law, "skin"), law)), mesh);
    const Effect* effect = model.parts().back().effect.get();
    EXPECT_EQ(effect->nonlinear_force(), dynamic_cast<const NonlinearForce*>(effect)) << spec.name;
    EXPECT_EQ(effect->contact(), dynamic_cast<const Contact*>(effect)) << spec.name;
    EXPECT_EQ(effect->finite_strain(), dynamic_cast<const FiniteStrainForm*>(effect)) << spec.name;
    EXPECT_EQ(effect->support(), dynamic_cast<const Support*>(effect)) << spec.name;
    EXPECT_EQ(effect->sensor_model(), dynamic_cast<const SensorModel*>(effect)) << spec.name;
    more += effect->sensor_model() != nullptr || effect->support() != nullptr ? 1 : 0;
  }
  EXPECT_GE(more, 6);
}

TEST(LawOfFiniteStrain, IsRefusedAtSmallStrain) {
  int refused_laws = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!spec.of_finite_strain) continue;
    const std::string message = refused(spec.name, example_arguments(spec), "linear");
    EXPECT_NE(message.find(spec.name), std::string::npos) << message;
    EXPECT_NE(message.find("neo_hookean"), std::string::npos) << message;
    ++refused_laws;
  }
  EXPECT_EQ(refused_laws, 3);
}

TEST(UnknownEffect, IsRefusedWithTheLibrary) {
  const std::string message = refused("elasticty", {});
  EXPECT_NE(message.find("elasticty"), std::string::npos);
  EXPECT_NE(message.find("viscous_damping"), std::string::npos) << message;
}

}  // namespace
}  // namespace tissue_stiffness
