// Conserved fields follow from macroscopic ones, which are found by name, whatever their order.
#include <apsis/study/conserved_fields.hpp>

#include <apsis/core/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace conserved_fields_test {

using testing::ElementsAre;

TEST(conserved_fields, are_those_of_density_velocity_and_temperature_in_any_order) {
  const apsis::field_table fields{
      {0.5, 1.5}, {"T", "rho", "u"}, {"", "", ""}, {{2.0, 1.0}, {4.0, 1.0}, {-0.5, 2.0}}};
  const auto conserved = apsis::conserved(fields);
  EXPECT_THAT(conserved[0], ElementsAre(4.0, 1.0));
  EXPECT_THAT(conserved[1], ElementsAre(-2.0, 2.0));
  EXPECT_THAT(conserved[2], ElementsAre(4.5, 2.5));
}

TEST(conserved_fields, of_several_velocity_dimensions_are_refused) {
  const apsis::field_table plane{
      {0.5}, {"rho", "u_x", "u_y", "T"}, {"", "", "", ""}, {{1.0}, {0.25}, {0.5}, {2.0}}};
  bad_input::expect_refused(
      {{[&] { static_cast<void>(apsis::conserved(plane)); }, {"there is no field 'u'"}}});
}

}  // namespace conserved_fields_test
