// Each kind of boundary has the right ghost rows. Transport does not depend on how a boundary provides them.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace kinds_test {

namespace {

using apsis::domain;
using apsis::face;
using apsis::field;
using apsis::grid;

/// The same boundary, but with computed instead of repeated rows.
class copied final : public apsis::boundary {
 public:
  explicit copied(std::shared_ptr<const apsis::boundary> of) : of_(std::move(of)) {}
  void fill(const face& where, double t, const apsis::pencil_end& rows) const override {
    of_->fill(where, t, rows);
  }
  bool periodic() const override { return of_->periodic(); }
  std::optional<std::vector<double>> entropy_bound() const override { return of_->entropy_bound(); }

 private:
  std::shared_ptr<const apsis::boundary> of_;
};

/// Fills ghost rows with the place and time of the call.
class recording final : public apsis::boundary {
 public:
  void fill(const face& where, double t, const apsis::pencil_end& rows) const override {
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
      double* ghost = rows.ghosts[g];
      ghost[0] = t;
      ghost[1] = where.direction + (where.upper ? 0.5 : 0.0);
      ghost[2] = static_cast<double>(g);
      ghost[3] = rows.inside[0][0];  // of the cell at the face
      for (int k = 0; k < 3; ++k) ghost[4 + k] = rows.at[static_cast<std::size_t>(k)];
    }
  }
};

field numbered(int cells, int components) {
  field u(cells, components);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) u.row(i)[k] = 100.0 * i + k;
  return u;
}

TEST(boundary, periodic_ghosts_wrap_even_when_wider_than_the_mesh) {
  const domain space = apsis::make_domain(grid::line(3, 0.0, 1.0), "periodic");
  const field u(3, 1);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 0, -4, 7, rows);
  for (int i = -4; i < 7; ++i)
    EXPECT_EQ(rows[static_cast<std::size_t>(i + 4)], u.row(((i % 3) + 3) % 3)) << i;
}

TEST(boundary, outflow_ghosts_repeat_the_nearest_cell_inside) {
  const domain space = apsis::make_domain(grid::line(3, 0.0, 1.0), "outflow");
  const field u(3, 1);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 0, -4, 7, rows);
  const std::vector<int> inside = {0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2};
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(rows[k], u.row(inside[k])) << k;
}

TEST(boundary, computed_rows_give_the_results_of_repeated_rows) {
  // The test covers every kind that repeats rows, in every direction of meshes of 1, 2 and 3 dimensions. Some
  // of the meshes are narrower than the stencil.
  for (const grid& mesh : {grid::line(5, 0, 1), grid(2, {2, 4, 1}, {0, 0, 0}, {1, 1, 1}),
                           grid(3, {4, 3, 2}, {0, 0, 0}, {1, 1, 1})})
    for (const std::string& name : apsis::boundary_names()) {
      if (apsis::find_boundary(name).variables != nullptr || !apsis::make_boundary(name)->cell_of_ghost(0, 5))
        continue;
      const auto side = std::make_shared<copied>(apsis::make_boundary(name));
      domain repeated = apsis::make_domain(mesh, name);
      domain computed(mesh,
                      std::vector<domain::faces>(static_cast<std::size_t>(mesh.dimensions()), {side, side}));
      const field u = numbered(mesh.size(), 9);
      computed.reserve(9, 2);
      computed.reserve(9, 4);
      computed.fill_ghosts(0.0, u);
      for (int direction = 0; direction < mesh.dimensions(); ++direction)
        for (int pencil = 0; pencil < mesh.pencils(direction); ++pencil) {
          const int n = mesh.cells(direction);
          std::vector<const double*> a, b;
          repeated.segment_rows(u, direction, pencil, -4, n + 4, a);
          computed.segment_rows(u, direction, pencil, -4, n + 4, b);
          for (std::size_t i = 0; i < a.size(); ++i)
            EXPECT_EQ(std::vector<double>(a[i], a[i] + 9), std::vector<double>(b[i], b[i] + 9))
                << name << " " << mesh.dimensions() << " " << direction << " " << pencil << " " << i;
        }
    }
}

TEST(boundary, receives_face_time_and_position_of_every_pencil) {
  const grid mesh(2, {2, 3, 1}, {0.0, 10.0, 0.0}, {1.0, 16.0, 0.0});
  const auto side = std::make_shared<recording>();
  domain space(mesh, {{side, side}, {side, side}});
  const field u = numbered(mesh.size(), 8);
  space.reserve(8, 2);
  space.fill_ghosts(0.25, u);
  const auto ghost = [&](int direction, int pencil, int i) {
    std::vector<const double*> rows;
    space.segment_rows(u, direction, pencil, i, i + 1, rows);
    return std::vector<double>(rows[0], rows[0] + 7);
  };
  // The last direction of the cell numbers is the fastest. So (x, y) is cell 3x + y, whose row begins with
  // 100 (3x + y).
  EXPECT_EQ(ghost(0, 1, -2), (std::vector<double>{0.25, 0.0, 1.0, 100.0, 0.0, 13.0, 0.0}));
  EXPECT_EQ(ghost(0, 2, 2), (std::vector<double>{0.25, 0.5, 0.0, 500.0, 1.0, 15.0, 0.0}));
  EXPECT_EQ(ghost(1, 1, -1), (std::vector<double>{0.25, 1.0, 0.0, 300.0, 0.75, 10.0, 0.0}));
  EXPECT_EQ(ghost(1, 0, 4), (std::vector<double>{0.25, 1.5, 1.0, 200.0, 0.25, 16.0, 0.0}));
}

TEST(boundary, periodic_on_one_side_only_is_refused) {
  const auto periodic = apsis::make_boundary("periodic"), outflow = apsis::make_boundary("outflow");
  bad_input::expect_refused({
      {[&] { domain(grid::line(4, 0, 1), {{periodic, outflow}}); },
       {"only one face of direction 1 is periodic"}},
      {[&] { domain(grid::line(4, 0, 1), {}); }, {"0 pairs of boundaries"}},
  });
}

TEST(boundary, every_name_is_found_and_an_unknown_one_gets_a_suggestion) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.velocity.max = 6.0;
  parts.velocity.points = 12;
  const auto gas = apsis::find_model("bgk").make(parts);
  for (const auto& name : apsis::boundary_names()) {
    if (name == "axis") continue;  // it needs polar velocities
    apsis::face_quantities values;
    if (name == "inflow" || name == "far-field") values = {{"rho", {1.0}}, {"T", {1.0}}};
    if (name == "pressure") values = {{"p", {1.0}}};
    if (name == "given") values = {{"f", {0.1}}};
    if (name == "mass-flow") values = {{"flux", {0.1}}};
    if (name == "radiating") values = {{"sigma", {0.1}}, {"surroundings", {1.0}}};
    EXPECT_NE(apsis::make_boundary(name, *gas, values), nullptr) << name;
  }
  bad_input::expect_refused({
      {[] { apsis::make_boundary("outfow"); },
       {"unknown boundary 'outfow' (there is no such kind); did you mean 'outflow'? valid: adiabatic, "
        "axis, diffuse, "
        "far-field, given, inflow, mass-flow, outflow, periodic, pressure, radiating, symmetry, vacuum"}},
  });
}

TEST(boundary, the_entropy_of_a_domain_is_bounded_where_that_of_all_its_faces_is) {
  const grid mesh(2, {2, 2, 1}, {0, 0, 0}, {1, 1, 1});
  const auto periodic = apsis::make_boundary("periodic"), outflow = apsis::make_boundary("outflow");
  EXPECT_TRUE(domain(mesh, {{periodic, periodic}, {periodic, periodic}}).entropy_bounds().has_value());
  EXPECT_FALSE(domain(mesh, {{periodic, periodic}, {outflow, outflow}}).entropy_bounds().has_value());
  EXPECT_TRUE(domain::point().entropy_bounds().has_value());
}

}  // namespace

}  // namespace kinds_test
