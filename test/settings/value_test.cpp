#include "tissue_stiffness/settings/value.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "settings/suggestion.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double positive = std::numeric_limits<double>::min();

template <class Function>
std::string message_of(const Function& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_contains(const std::string& text, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments) {
    EXPECT_NE(text.find(fragment), std::string::npos) << "`" << fragment << "` is not in: " << text;
  }
}

TEST(Value, KnowsItsTypeAndPath) {
  const Value root = parse_yaml("a: 1.5\nb:\n  - {c: yes}\n  - [1, true, '3', ~]\n", "model.yaml");
  EXPECT_EQ(root.path(), "model.yaml");
  EXPECT_EQ(root.keys(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(root.at("a").path(), "model.yaml:1: a");
  EXPECT_EQ(root.at("b").path(), "model.yaml:2: b");
  const Value& b = root.at("b");
  EXPECT_EQ(b.items()[0].at("c").path(), "model.yaml:3: b[0].c");
  EXPECT_EQ(b.items()[0].at("c").as_text(), "yes");
  const std::vector<Value>& row = b.items()[1].items();
  EXPECT_EQ(row[0].type(), Value::Type::number);
  EXPECT_EQ(row[1].type(), Value::Type::boolean);
  EXPECT_EQ(row[2].type(), Value::Type::text);
  EXPECT_EQ(row[3].type(), Value::Type::null);
  EXPECT_EQ(b.shown(), "[{c: `yes`}, [1, true, `3`, nothing]]");
}

TEST(Value, ReadsNumbersAsPeopleWriteThem) {
  const std::vector<std::pair<std::string, double>> numbers = {
      {"30e3", 30e3}, {"1.0e-06", 1e-6}, {"-.5", -0.5}, {"+2", 2.0}, {"7.", 7.0}, {"1E2", 100.0}, {"0", 0.0}};
  for (const auto& [text, number] : numbers) {
    EXPECT_EQ(parse_yaml("x: " + text, "m").at("x").as_number(-infinity, infinity, ""), number) << text;
  }
  for (const std::string text : {".nan", ".inf", "nan", "0x10", "1e999", "1,5", "5 kPa", "'1'"}) {
    EXPECT_EQ(parse_yaml("x: " + text, "m").at("x").type(), Value::Type::text) << text;
  }
}

TEST(Value, QuantitiesAreKnownLogNormalOrNormal) {
  const Value root = parse_yaml("a: 3\nb: {prior: 30e3, factor: 3}\nc: {mean: -1, std: 0.5, drift: 0.2}\n", "m");
  const Quantity a = root.at("a").as_quantity(-infinity, infinity, "Pa");
  const Quantity b = root.at("b").as_quantity(0.0, infinity, "Pa");
  const Quantity c = root.at("c").as_quantity(-infinity, infinity, "Pa");
  EXPECT_FALSE(a.estimated());
  EXPECT_EQ(a.value, 3.0);
  EXPECT_EQ(b.kind, Quantity::Kind::log_normal);
  EXPECT_EQ(b.value, 30e3);
  EXPECT_EQ(b.spread, 3.0);
  EXPECT_EQ(c.kind, Quantity::Kind::normal);
  EXPECT_EQ(c.value, -1.0);
  EXPECT_EQ(c.spread, 0.5);
  EXPECT_EQ(b.drift, 0.0);
  EXPECT_EQ(c.drift, 0.2);
  EXPECT_NO_THROW(root.require_all_read());
}

TEST(Value, ConversionsSayWhatIsAllowed) {
  const auto read = [](const std::string& text, const auto& convert) {
    return message_of([&] { convert(parse_yaml("x: " + text, "m.yaml").at("x")); });
  };
  const auto number = [](const Value& v) { v.as_number(0.0, 0.5, "Pa"); };
  const auto quantity = [](const Value& v) { v.as_quantity(positive, infinity, "Pa"); };
  EXPECT_EQ(read("0.7", number), "m.yaml:1: x: found 0.7; allowed: a number from 0 to 0.5 [Pa]");
  EXPECT_EQ(read("stiff", number), "m.yaml:1: x: found `stiff`; allowed: a number from 0 to 0.5 [Pa]");
  EXPECT_EQ(read("-1", quantity), "m.yaml:1: x: found -1; allowed: a number > 0 [Pa]");
  EXPECT_EQ(read("[1]", quantity),
            "m.yaml:1: x: found [1]; allowed: a number > 0 [Pa], {prior, factor} or {mean, std}, "
            "with `drift` when it changes, or {value, tolerance}");
  expect_contains(read("{prior: 1}", quantity), {"m.yaml:1: x: found {prior: 1}", "{prior, factor}"});
  expect_contains(read("{prior: 1, std: 1}", quantity), {"found {prior: 1, std: 1}", "{mean, std}"});
  expect_contains(read("{}", quantity), {"found {}", "{mean, std}"});
  expect_contains(read("{prior: 0, factor: 2}", quantity), {"m.yaml:1: x.prior: found 0", "> 0 [Pa]"});
  expect_contains(read("{prior: 1, factor: 1}", quantity), {"m.yaml:1: x.factor: found 1", "> 1"});
  expect_contains(read("{prior: 1, factor: 2, drift: -1}", quantity), {"m.yaml:1: x.drift: found -1", ">= 0"});
  expect_contains(read("{mean: 1, std: 0}", quantity), {"m.yaml:1: x.std: found 0", "> 0"});
  expect_contains(read("1.5", [](const Value& v) { v.as_integer(1, 2); }), {"found 1.5", "whole number from 1 to 2"});
  expect_contains(read("1", [](const Value& v) { v.as_boolean(); }), {"found 1", "true or false"});
  expect_contains(read("''", [](const Value& v) { v.as_text(); }), {"found ``", "a text"});
  expect_contains(read("[1, 2]", [](const Value& v) { v.as_vector3("m"); }), {"found [1, 2]", "three numbers", "[m]"});
  expect_contains(read("[1, 2, a]", [](const Value& v) { v.as_vector3("m"); }), {"x[2]: found `a`", "a number [m]"});
  expect_contains(read("linaer",
                       [](const Value& v) {
                         v.as_choice({"linear", "neo_hookean"});
                       }),
                  {"found `linaer` (did you mean `linear`?)", "allowed: linear, neo_hookean"});
  expect_contains(read("3", [](const Value& v) { v.items(); }), {"found 3", "a list"});
  expect_contains(read("3", [](const Value& v) { v.at("k"); }), {"found 3", "a map with the key `k`"});
}

TEST(Value, UnreadKeysAreErrorsWithWhatWasAskedFor) {
  const Value root = parse_yaml("mesh:\n  file: m.vtk\n  sclae: 2\n", "m.yaml");
  const Value& mesh = root.at("mesh");
  mesh.at("file").as_text();
  EXPECT_EQ(mesh.number_or("scale", 1.0, positive, infinity, ""), 1.0);
  EXPECT_EQ(message_of([&] { root.require_all_read(); }),
            "m.yaml:3: mesh.sclae: found an unknown key `sclae` (did you mean `scale`?); allowed: file, scale");
  root.mark_read_deep();
  EXPECT_NO_THROW(root.require_all_read());
}

TEST(Value, IsTheSameWhereverItWasWritten) {
  const std::string text = "{a: [1, two, true], b: {c: }}";
  const auto value = [](const std::string& of) { return parse_yaml("x: 0\ny: " + of, "m.yaml").at("y"); };
  EXPECT_TRUE(parse_yaml("y: " + text, "other.yaml").at("y").same(value(text)));
  for (const char* other : {"{a: [1, two, false], b: {c: }}", "{a: [1, two], b: {c: }}", "{a: [1.5, two, true], b: {c: }}",
                            "{a: [1, two, true], b: {d: }}", "{a: [1, two, true]}", "1"}) {
    EXPECT_FALSE(value(text).same(value(other))) << other;
    EXPECT_FALSE(value(other).same(value(text))) << other;
  }
}

TEST(Value, UnreadKeysInsideListsAreFound) {
  const Value root = parse_yaml("a:\n- {b: 1}\n- {b: 1, c: 2}\n", "m.yaml");
  for (const Value& item : root.at("a").items()) item.at("b").as_integer(0, 9);
  EXPECT_EQ(message_of([&] { root.require_all_read(); }),
            "m.yaml:3: a[1].c: found an unknown key `c` (did you mean "
            "`b`?); allowed: b");
}

TEST(Value, MissingKeysNameTheKeysThatAreThere) {
  const Value root = parse_yaml("meesh: 1\neffects: 2\n", "m.yaml");
  EXPECT_EQ(message_of([&] { root.at("mesh"); }),
            "m.yaml: found no key `mesh` among meesh, effects (did you mean "
            "`meesh`?); allowed: `mesh` is required here");
}

TEST(Yaml, WrongTextIsRefusedWithItsLine) {
  const auto parse = [](const std::string& text) { return message_of([&] { parse_yaml(text, "m.yaml"); }); };
  expect_contains(parse("a: 1\nb: 2\na: 3\n"), {"m.yaml:3: a", "the key `a` twice"});
  expect_contains(parse("x:\n  a: {b: 1, b: 2}\n"), {"m.yaml:2: x.a.b", "twice"});
  expect_contains(parse("a: 1\nb: [1, 2\n"), {"m.yaml:", "allowed: YAML"});
  expect_contains(parse("a: *nowhere\n"), {"m.yaml:1", "allowed: YAML"});
  expect_contains(parse("a: 1\n---\nb: 1\n"), {"2 YAML documents"});
  expect_contains(parse("a: 1\n---\n---\nb: 1\n"), {"2 YAML documents"});
  EXPECT_EQ(parse("a: 1\n---\n"), "no error");
  for (const char* text : {", a", ", a: 1}}\nb: 2\n"})  // where yaml-cpp's parser stands still
    expect_contains(parse(text), {"m.yaml:1", "belongs to no value", "allowed: YAML"});
  expect_contains(parse("[1, 2]: 3\n"), {"a key that is not a plain word"});
  expect_contains(parse("a: &x [*x]\n"), {"less nesting"});
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 8; ++i) {
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) bomb += (j ? ", *a" : "*a") + std::to_string(i - 1);
    bomb += "]\n";
  }
  expect_contains(parse(bomb), {"more than 1000000 values"});
  expect_contains(message_of([] { load_yaml("/no/such/model.yaml"); }), {"/no/such/model.yaml", "no readable file"});
  expect_contains(message_of([] { load_yaml("/tmp"); }), {"/tmp", "no readable file"});
  EXPECT_EQ(parse_yaml("", "m").type(), Value::Type::null);
}

TEST(Suggestion, OnlyNearWordsAreSuggested) {
  EXPECT_EQ(closest_word("elastcity", {"inertia", "elasticity"}), "elasticity");
  EXPECT_EQ(closest_word("gravtiy", {"gravity", "traction"}), "gravity");
  EXPECT_EQ(closest_word("pressure", {"inertia", "fixed"}), "");
  EXPECT_EQ(join_words({}), "nothing");
}

}  // namespace
}  // namespace tissue_stiffness
