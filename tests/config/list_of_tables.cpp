// Keys of tables in lists.
#include <apsis/config/list_of_tables.hpp>

#include <string>

#include <gtest/gtest.h>

namespace list_of_tables_test {

TEST(list_of_tables, has_keys_with_a_number_from_1_to_1000) {
  const auto split = apsis::split_key("space.body.27.shapes.2.radius", "space.body.");
  ASSERT_TRUE(split);
  EXPECT_EQ(split->number, 27U);
  EXPECT_EQ(split->key, "shapes.2.radius");
  EXPECT_EQ(apsis::split_key("output.probe.1000.name", "output.probe.")->number, 1000U);
  for (const std::string rest :
       {"1", "", ".", ".name", "0.name", "-1.name", "+1.name", "1001.name", "1x.name", "x.name", " 1.name",
        "1 .name", "1.5", "99999999999999999999.name"}) {
    const auto found = apsis::split_key("space.body." + rest, "space.body.");
    // "1.5" splits into the number 1 and the key "5", which a later check refuses.
    EXPECT_EQ(found.has_value(), rest == "1.5") << rest;
  }
}

}  // namespace list_of_tables_test
