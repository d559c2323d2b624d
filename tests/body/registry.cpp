// Kinds of shapes and their keys: refused input and the words of the refusals.
#include "body/examples.hpp"

#include <apsis/core/errors.hpp>

#include <limits>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace shape_registry_test {

namespace {

using namespace body_examples;

void make(const std::string& name, const apsis::shape_values& values, int dimensions) {
  made(name, values, dimensions);
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
      // The advice for a shape of one number of dimensions names another shape, or the list for the shape.
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
  bad_input::expect_refused({
      {[&] { make("spere", {}, 3); }, {"unknown shape 'spere'", "did you mean 'sphere'"}},
  });
}

TEST(shape_registry, refuses_dimensions_that_a_shape_does_not_serve) {
  bad_input::expect_refused({
      {[&] { make("circle", {}, 3); }, {"no form in 3 dimensions", "use 'cylinder'"}},
      {[&] { make("sphere", {}, 2); }, {"use 'circle'"}},
      {[&] { make("box", {}, 1); }, {"has 1 dimensions"}},
  });
}

TEST(shape_registry, refuses_unknown_and_missing_keys) {
  bad_input::expect_refused({
      {[&] { make("circle", {{"centre", numbers{0, 0}}, {"radus", 1.0}}, 2); },
       {"no key 'radus'", "did you mean 'radius'"}},
      {[&] { make("circle", {{"centre", numbers{0, 0}}}, 2); }, {"has no 'radius' (it is the distance"}},
  });
}

TEST(shape_registry, refuses_values_of_another_kind_or_size) {
  bad_input::expect_refused({
      {[&] { make("circle", {{"centre", 0.0}, {"radius", 1.0}}, 2); },
       {"'centre' of shape 'circle' is a number (a list of numbers is needed)"}},
      {[&] { make("circle", {{"centre", numbers{0, 0, 0}}, {"radius", 1.0}}, 2); },
       {"'centre' of shape 'circle' has 3 components (it needs 2)"}},
      {[&] { make("union", {{"shapes", apsis::shape_list{}}}, 2); }, {"has 0 shapes (it needs at least 1)"}},
      {[&] { make("difference", {{"shapes", apsis::shape_list{circles().front()}}}, 2); },
       {"has 1 shapes (it needs at least 2)"}},
      {[&] { make("hollow", {{"of", circles()}}, 2); }, {"has 2 shapes (it takes at most 1)"}},
      {[&] { make("union", {{"shapes", apsis::shape_list{nullptr}}}, 2); }, {"an empty shape"}},
      {[&] { make("formula", {{"phi", apsis::level_set_function{}}}, 2); }, {"is empty"}},
  });
}

TEST(shape_registry, refuses_numbers_that_are_not_finite_positive_or_of_a_usable_size) {
  const auto circle = [](double x, double radius) {
    return make("circle", {{"centre", numbers{x, 0}}, {"radius", radius}}, 2);
  };
  bad_input::expect_refused({
      {[&] { circle(nan, 1.0); }, {"'centre' of shape 'circle' is nan (it is not finite)"}},
      {[&] { circle(0.0, infinite); }, {"is inf (it is not finite)"}},
      {[&] { circle(0.0, 0.0); }, {"is 0 (it must be positive)"}},
      {[&] { circle(0.0, -1.0); }, {"is -1 (it must be positive)"}},
      {[&] { circle(1e200, 1.0); }, {"magnitudes are at most 1e+100"}},
      {[&] { circle(0.0, 1e-200); }, {"sizes are at least 1e-100"}},
      {[&] { make("ellipse", {{"centre", numbers{0, 0}}, {"semi_axes", numbers{1, 0}}}, 2); },
       {"'semi_axes' of shape 'ellipse' is 0 (it must be positive)"}},
  });
}

TEST(shape_registry, refuses_values_that_contradict_each_other) {
  bad_input::expect_refused({
      {[&] { make("box", {{"from", numbers{0, 0}}, {"to", numbers{1, 0}}}, 2); },
       {"'to' of shape 'box' is 0 in direction y ('from' is 0)"}},
      {[&] { make("half_space", {{"point", numbers{0, 0}}, {"normal", numbers{0, 0}}}, 2); },
       {"'normal' of shape 'half_space' is 0 (it has no direction)"}},
  });
  const apsis::shape_list circle = {circles().front()};
  bad_input::expect_refused({
      {[&] { make("extruded", {{"of", circle}, {"from", 1.0}, {"to", 1.0}}, 3); },
       {"'to' of shape 'extruded' is 1 ('from' is 1)"}},
      {[&] { make("turned", {{"of", circle}, {"rotate", numbers{0, 0, 0, 90}}}, 3); },
       {"'rotate' of shape 'turned' is 0 (it has no direction)"}},
      {[&] { make("turned", {{"of", circle}, {"rotate", numbers{0, 0, 1}}}, 3); },
       {"has 3 components (it needs 4)"}},
      {[&] { make("turned", {{"of", circle}, {"rotate", 90.0}}, 3); }, {"is a number"}},
  });
}

}  // namespace shape_registry_test
