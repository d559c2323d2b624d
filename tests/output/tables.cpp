// Tables of numbers as text: written, read back, and damaged.
#include "support/folder.hpp"
#include "support/property.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/output/column_file.hpp>
#include <apsis/output/field_series.hpp>
#include <apsis/output/table.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace tables_test {

using namespace apsis;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

column_file read(const std::string& text) {
  const test_folder folder;
  std::ofstream(folder / "table.csv") << text;
  return read_columns(folder / "table.csv");
}

}  // namespace

TEST(a_table, is_read_back_bit_for_bit) {
  check_property("any finite double", [] {
    numeric_table table{{"step", "value"}, {}};
    const auto rows = *rc::gen::inRange(1, 20);
    for (int row = 0; row < rows; ++row) {
      const auto value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
      table.rows.push_back({static_cast<double>(row), std::isfinite(value) ? value : -0.0});
    }
    const auto columns = read(to_csv(table, {"step"})).columns;
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      for (std::size_t k = 0; k < 2; ++k)
        RC_ASSERT(std::bit_cast<std::uint64_t>(columns.at(table.columns[k])[row]) ==
                  std::bit_cast<std::uint64_t>(table.rows[row][k]));
  });
}

TEST(a_table, has_whole_numbers_without_a_point_or_exponent) {
  EXPECT_EQ(to_csv({{"step", "t"}, {{1e17, 1e17}, {3.0, 0.1}}}, {"step"}),
            "step,t\n100000000000000000,1e+17\n3,0.10000000000000001\n");
}

TEST(a_table_of_fields, has_a_row_for_each_cell_and_a_time_if_there_are_several) {
  field_series fields;
  fields.axes = {{"x", {0.25, 0.75}}, {"y", {1.0, 2.0, 3.0}}};
  fields.names = {"rho"};
  fields.snapshots = {{0.5, {{1, 2, 3, 4, 5, 6}}}};
  const auto once = to_table(fields);
  EXPECT_THAT(once.columns, ElementsAre("x", "y", "rho"));
  ASSERT_EQ(once.rows.size(), 6U);
  EXPECT_THAT(once.rows[1], ElementsAre(0.25, 2.0, 2.0)) << "the last axis is the fastest";
  EXPECT_THAT(once.rows[3], ElementsAre(0.75, 1.0, 4.0));
  fields.snapshots.push_back({1.5, {{7, 8, 9, 10, 11, 12}}});
  const auto twice = to_table(fields);
  EXPECT_THAT(twice.columns, ElementsAre("t", "x", "y", "rho"));
  ASSERT_EQ(twice.rows.size(), 12U);
  EXPECT_THAT(twice.rows[7], ElementsAre(1.5, 0.25, 2.0, 8.0));
}

TEST(a_column_file, may_have_comments_quotes_blanks_and_a_byte_order_mark) {
  const auto table = read("\xEF\xBB\xBF# made by hand\n\"x\" , rho\r\n\n1, +2.5\r\n# end\n 3,4e-1\n");
  EXPECT_THAT(table.columns.at("x"), ElementsAre(1.0, 3.0));
  EXPECT_THAT(table.columns.at("rho"), ElementsAre(2.5, 0.4));
  EXPECT_THAT(table.lines, ElementsAre(4, 6));
  EXPECT_TRUE(table.problems.empty());
}

TEST(a_column_file, names_the_first_entry_of_a_column_that_is_not_a_finite_number) {
  const auto table = read("x,note\n1,2\n2,high\n3,inf\n4,0x10\n5,1e999\n");
  EXPECT_THAT(table.columns.at("x"), ElementsAre(1, 2, 3, 4, 5));
  for (std::size_t row = 1; row < 5; ++row) EXPECT_TRUE(std::isnan(table.columns.at("note")[row])) << row;
  ASSERT_EQ(table.problems.size(), 1U);
  EXPECT_THAT(table.problems.at("note"),
              HasSubstr("table.csv:3: 'high' in column 'note' is not a finite number; change it"));
}

TEST(a_column_file, that_is_no_table_is_refused_with_the_line) {
  bad_input::expect_refused({
      {[&] { read("x,y,x\n1,2,3\n"); },
       {"table.csv:1: column 'x' appears twice (a column is found by its name); rename one of them"}},
      {[&] { read("x,y\n1,2\n\n1,2,3\n"); },
       {"table.csv:4: 3 entries (the first line names 2 columns); give 2"}},
      {[&] { read("x,y\n1\n"); }, {"table.csv:2: 1 entries"}},
      {[&] { read("# nothing\n"); }, {"the table has no rows"}},
      {[&] { read("x,y\n"); }, {"the table has no rows"}},
  });
  const test_folder folder;
  EXPECT_THROW(read_columns(folder / "absent.csv"), io_error);
}

}  // namespace tables_test
