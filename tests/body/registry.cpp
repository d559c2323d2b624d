// Kinds of shapes and their keys: what is refused, and with which words.
#include "body/examples.hpp"

#include <apsis/core/errors.hpp>

#include <limits>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shape_registry_test {

namespace {

using namespace body_examples;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal_of(const std::string& name, const apsis::shape_values& values, int dimensions) {
  try {
    made(name, values, dimensions);
  } catch (const apsis::input_error& failure) {
    return failure.what();
  }
  return "accepted";
}

constexpr double infinite = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST(shape_registry, describes_every_kind_and_its_keys) {
  std::set<std::string> names;
  for (const auto* entry : apsis::shape_entries()) {
    EXPECT_TRUE(names.insert(entry->name).second) << entry->name;
    EXPECT_FALSE(entry->description.empty()) << entry->name;
    EXPECT_NE(entry->make, nullptr) << entry->name;
    EXPECT_FALSE(entry->dimensions.empty()) << entry->name;
    if (entry->dimensions.size() == 1) {
      // Another shape, or the shape in its list.
      const std::string& advice = entry->alternative;
      if (entry->keys.front().kind == apsis::shape_value_kind::shapes) {
        EXPECT_THAT(advice,
                    testing::StartsWith("give the shape in its list '" + entry->keys.front().name + "'"));
      } else {
        ASSERT_THAT(advice, testing::MatchesRegex("use '[a-z-]+'")) << entry->name;
        EXPECT_NO_THROW(apsis::find_shape(advice.substr(5, advice.size() - 6))) << entry->name;
      }
    }
    std::set<std::string> keys;
    for (const int dimensions : entry->dimensions)
      for (const auto& key : apsis::common_shape_keys(dimensions)) keys.insert(key.name);
    for (const auto& key : entry->keys) {
      EXPECT_TRUE(keys.insert(key.name).second) << entry->name << ": " << key.name;
      EXPECT_FALSE(key.doc.empty()) << entry->name << ": " << key.name;
      if (key.value) {
        EXPECT_EQ(key.value->index(), static_cast<std::size_t>(key.kind)) << key.name;
      }
    }
    EXPECT_EQ(&apsis::find_shape(entry->name), entry);
  }
}

TEST(shape_registry, suggests_the_nearest_name_of_an_unknown_kind) {
  EXPECT_THAT(refusal_of("spere", {}, 3),
              AllOf(HasSubstr("unknown shape 'spere'"), HasSubstr("did you mean 'sphere'")));
}

TEST(shape_registry, refuses_dimensions_that_a_shape_does_not_serve) {
  EXPECT_THAT(refusal_of("circle", {}, 3),
              AllOf(HasSubstr("no form in 3 dimensions"), HasSubstr("use 'cylinder'")));
  EXPECT_THAT(refusal_of("sphere", {}, 2), HasSubstr("use 'circle'"));
  EXPECT_THAT(refusal_of("box", {}, 1), HasSubstr("has 1 dimensions"));
}

TEST(shape_registry, refuses_unknown_and_missing_keys) {
  EXPECT_THAT(refusal_of("circle", {{"centre", numbers{0, 0}}, {"radus", 1.0}}, 2),
              AllOf(HasSubstr("no key 'radus'"), HasSubstr("did you mean 'radius'")));
  EXPECT_THAT(refusal_of("circle", {{"centre", numbers{0, 0}}}, 2),
              HasSubstr("has no 'radius' (it is the distance"));
}

TEST(shape_registry, refuses_values_of_another_kind_or_size) {
  EXPECT_THAT(refusal_of("circle", {{"centre", 0.0}, {"radius", 1.0}}, 2),
              HasSubstr("'centre' of shape 'circle' is a number (a list of numbers is needed)"));
  EXPECT_THAT(refusal_of("circle", {{"centre", numbers{0, 0, 0}}, {"radius", 1.0}}, 2),
              HasSubstr("'centre' of shape 'circle' has 3 components (it needs 2)"));
  EXPECT_THAT(refusal_of("union", {{"shapes", apsis::shape_list{}}}, 2),
              HasSubstr("has 0 shapes (it needs at least 1)"));
  EXPECT_THAT(refusal_of("difference", {{"shapes", apsis::shape_list{circles().front()}}}, 2),
              HasSubstr("has 1 shapes (it needs at least 2)"));
  EXPECT_THAT(refusal_of("hollow", {{"of", circles()}}, 2), HasSubstr("has 2 shapes (it takes at most 1)"));
  EXPECT_THAT(refusal_of("union", {{"shapes", apsis::shape_list{nullptr}}}, 2), HasSubstr("an empty shape"));
  EXPECT_THAT(refusal_of("formula", {{"phi", apsis::level_set_function{}}}, 2), HasSubstr("is empty"));
}

TEST(shape_registry, refuses_numbers_that_are_not_finite_positive_or_of_a_usable_size) {
  const auto circle = [](double x, double radius) {
    return refusal_of("circle", {{"centre", numbers{x, 0}}, {"radius", radius}}, 2);
  };
  EXPECT_THAT(circle(nan, 1.0), HasSubstr("'centre' of shape 'circle' is nan (it is not finite)"));
  EXPECT_THAT(circle(0.0, infinite), HasSubstr("is inf (it is not finite)"));
  EXPECT_THAT(circle(0.0, 0.0), HasSubstr("is 0 (it must be positive)"));
  EXPECT_THAT(circle(0.0, -1.0), HasSubstr("is -1 (it must be positive)"));
  EXPECT_THAT(circle(1e200, 1.0), HasSubstr("magnitudes are at most 1e+100"));
  EXPECT_THAT(circle(0.0, 1e-200), HasSubstr("sizes are at least 1e-100"));
  EXPECT_THAT(refusal_of("ellipse", {{"centre", numbers{0, 0}}, {"semi_axes", numbers{1, 0}}}, 2),
              HasSubstr("'semi_axes' of shape 'ellipse' is 0 (it must be positive)"));
}

TEST(shape_registry, refuses_values_that_contradict_each_other) {
  EXPECT_THAT(refusal_of("box", {{"from", numbers{0, 0}}, {"to", numbers{1, 0}}}, 2),
              HasSubstr("'to' of shape 'box' is 0 in direction y ('from' is 0)"));
  EXPECT_THAT(refusal_of("half_space", {{"point", numbers{0, 0}}, {"normal", numbers{0, 0}}}, 2),
              HasSubstr("'normal' of shape 'half_space' is 0 (it has no direction)"));
  const apsis::shape_list circle = {circles().front()};
  EXPECT_THAT(refusal_of("extruded", {{"of", circle}, {"from", 1.0}, {"to", 1.0}}, 3),
              HasSubstr("'to' of shape 'extruded' is 1 ('from' is 1)"));
  EXPECT_THAT(refusal_of("turned", {{"of", circle}, {"rotate", numbers{0, 0, 0, 90}}}, 3),
              HasSubstr("'rotate' of shape 'turned' is 0 (it has no direction)"));
  EXPECT_THAT(refusal_of("turned", {{"of", circle}, {"rotate", numbers{0, 0, 1}}}, 3),
              HasSubstr("has 3 components (it needs 4)"));
  EXPECT_THAT(refusal_of("turned", {{"of", circle}, {"rotate", 90.0}}, 3), HasSubstr("is a number"));
}

}  // namespace shape_registry_test
