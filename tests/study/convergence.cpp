// Convergence studies: known orders from case to rate, and guarantees of the study itself.
#include <apsis/study/convergence.hpp>

#include <apsis/core/errors.hpp>

#include <atomic>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace convergence_test {

using namespace apsis;
using testing::HasSubstr;
using kind = convergence_reference::kind;

namespace {

// u' = −u² from u(0) = 1 is smooth enough to show orders with coarse steps.
convergence_study decay(const std::string& methods, const std::string& steps) {
  return {.case_name = "paper/decay",
          .overrides = {"model.rate=1", "model.u0=1"},
          .vary = {parse_vary("time.method=" + methods), parse_vary("time.dt=" + steps)}};
}

// BGK at a fraction of its cost. Few velocities are still spectrally accurate for these data.
convergence_study bgk(const std::string& method, const std::string& vary) {
  return {.case_name = "paper/bgk-accuracy",
          .overrides = {"time.method=" + method, "velocity.max=9", "velocity.points=40"},
          .vary = {parse_vary(vary)}};
}

double last_rate(const convergence_block& block) {
  return block.rows.back().rate;
}

std::vector<double> numbers(const convergence_table& table) {
  std::vector<double> all;
  for (const auto& block : table.blocks)
    for (const auto& row : block.rows)
      for (const double x : {row.h, row.error, row.dt, row.min_value, static_cast<double>(row.steps)})
        all.push_back(x);
  return all;
}

}  // namespace

TEST(convergence, against_the_exact_solution_shows_orders_2_3_and_4) {
  const auto table = converge(decay("imdrk-1-2,imdrk-2-3,imdrk-5-4", "1/8..1/64"));
  ASSERT_EQ(table.blocks.size(), 3U);
  EXPECT_EQ(table.runs, 12);  // no reference is computed
  EXPECT_THAT(table.measure, HasSubstr("exact"));
  // The tolerance covers the next term of the error at these steps.
  for (int order = 2; order <= 4; ++order)
    EXPECT_NEAR(last_rate(table.blocks[static_cast<std::size_t>(order - 2)]), order, 0.15);
}

TEST(convergence, measures_the_error_of_the_same_run) {
  const auto table = converge(decay("imdrk-2-3", "1/8,1/16"));
  const auto run =
      compute_outcome("paper/decay", {"model.rate=1", "model.u0=1", "time.method=imdrk-2-3", "time.dt=1/16"});
  const auto& row = table.blocks.at(0).rows.at(1);
  EXPECT_EQ(row.error, std::abs(run.state.at(0) - 1.0 / 3.0));
  EXPECT_EQ(row.steps, 32);
  EXPECT_EQ(row.dt, 1.0 / 16.0);
  EXPECT_EQ(row.rate, std::log(table.blocks[0].rows[0].error / row.error) / std::log(2.0));
  EXPECT_TRUE(std::isnan(table.blocks[0].rows[0].rate));
}

TEST(convergence, ode_model_has_orders_2_and_3_for_every_reference) {
  for (const std::string reference : {"next", "time", "md-imex-6-3@1e-4"}) {
    for (const std::string epsilon : {"1", "1e-10"}) {
      const convergence_study study{
          .case_name = "paper/ode",
          .overrides = {"model.epsilon=" + epsilon},
          .vary = {parse_vary("time.method=md-imex-3-2,md-imex-6-3"), parse_vary("time.dt=1/64..1/256")},
          .reference = parse_reference(reference),
          .norm = error_norm::l1};
      const auto table = converge(study);
      // A reference with 1/8 of the smallest step adds up to 0.02 at second order. The next order of the
      // error adds the rest.
      EXPECT_NEAR(last_rate(table.blocks.at(0)), 2.0, 0.1) << reference << " " << epsilon;
      EXPECT_NEAR(last_rate(table.blocks.at(1)), 3.0, 0.1) << reference << " " << epsilon;
    }
  }
}

TEST(convergence, self_convergence_shows_the_fifth_order_of_space) {
  for (const std::string formulation : {"finite-volume", "finite-difference"}) {
    auto study = bgk("md-imex-6-3", "space.cells=10..40");
    study.overrides.push_back("space.formulation=" + formulation);
    study.overrides.push_back("time.cfl=0.1");
    const auto table = converge(study);
    EXPECT_EQ(table.h_name, "Δx");
    // With this step the temporal error is small on these meshes. Interpolation of an order below five would
    // be visible.
    EXPECT_GE(last_rate(table.blocks.at(0)), 4.4) << formulation;
    EXPECT_LE(last_rate(table.blocks.at(0)), 5.6) << formulation;
  }
}

TEST(convergence, macroscopic_fields_of_averages_are_compared_at_full_order) {
  // T is a nonlinear function of the averages. An average of T itself would be only second-order accurate.
  auto study = bgk("md-imex-6-3", "space.cells=10..40");
  study.overrides.push_back("time.cfl=0.1");
  study.quantity = "T";
  EXPECT_GE(last_rate(converge(study).blocks.at(0)), 4.4);
}

TEST(convergence, a_refined_step_on_one_mesh_shows_the_orders_of_time) {
  for (const auto& [method, order] : {std::pair{"md-imex-3-2", 2.0}, {"md-imex-6-3", 3.0}}) {
    for (const std::string epsilon : {"1", "1e-10"}) {
      auto study = bgk(method, "time.cfl=0.4,0.2,0.1");
      study.overrides.push_back("space.cells=10");
      // The unknowns are point values. On such a coarse mesh the collision of cell averages in the limit has
      // a spatial error that depends on the step. It would hide the third order.
      study.overrides.push_back("space.formulation=finite-difference");
      study.overrides.push_back("model.epsilon=" + epsilon);
      study.reference.type = kind::time;
      const auto table = converge(study);
      EXPECT_EQ(table.h_name, "Δt");
      EXPECT_EQ(table.runs, 4);  // one reference for all
      EXPECT_NEAR(last_rate(table.blocks.at(0)), order, 0.1) << method << " " << epsilon;
    }
  }
}

TEST(convergence, cells_and_steps_refined_together_show_the_order_of_time_where_space_is_finer) {
  // An independent program with another fifth-order reconstruction computed these errors for 80
  // and 160 cells.
  const std::map<std::string, std::vector<double>> known = {{"1", {8.0e-5, 2.0e-5}},
                                                            {"1e-8", {2.8e-5, 6.9e-6}}};
  const convergence_study study{
      .case_name = "paper/broadwell",
      .overrides = {"time.method=md-imex-3-2"},
      .vary = {parse_vary("model.epsilon=1,1e-8"), parse_vary("space.cells=80,160")}};
  for (const auto& block : converge(study).blocks)
    for (std::size_t k = 0; k < 2; ++k) {
      // The known errors have two digits. At 80 cells the spatial error is a few percent of
      // the temporal error.
      const double wanted = known.at(block.values[0])[k];
      EXPECT_NEAR(block.rows[k].error, wanted, 0.05 * wanted) << block.title;
    }
}

TEST(convergence, one_run_finer_than_all_serves_every_mesh) {
  auto study = bgk("md-imex-6-3", "space.cells=8..32");
  study.overrides.push_back("time.cfl=0.1");
  study.reference.type = kind::space_time;
  const auto table = converge(study);
  EXPECT_EQ(table.runs, 4);
  EXPECT_GE(last_rate(table.blocks.at(0)), 4.0);
}

TEST(convergence, distance_to_the_limit_scheme_falls_linearly_with_epsilon) {
  const convergence_study study{.case_name = "paper/ode",
                                .overrides = {"time.dt=1/32"},
                                .vary = {parse_vary("model.epsilon=1e-4,1e-5,1e-6")},
                                .reference = parse_reference("model.epsilon=0")};
  const auto table = converge(study);
  EXPECT_EQ(table.h_name, "model.epsilon");
  EXPECT_EQ(table.runs, 4);
  EXPECT_NEAR(last_rate(table.blocks.at(0)), 1.0, 0.02);
}

TEST(convergence, rows_go_from_coarse_to_fine_however_the_values_are_given) {
  const auto sorted = converge(decay("imdrk-2-3,imdrk-1-2", "1/8,1/16,1/32"));
  const auto mixed = converge(decay("imdrk-2-3,imdrk-1-2", "1/32,1/8,1/16"));
  EXPECT_EQ(numbers(sorted), numbers(mixed));
  EXPECT_EQ(sorted.blocks.at(0).title, "time.method = imdrk-2-3");
  EXPECT_EQ(sorted.blocks.at(1).values, std::vector<std::string>{"imdrk-1-2"});
  // The refined key may have any position.
  auto first = decay("imdrk-2-3,imdrk-1-2", "1/8,1/16,1/32");
  std::swap(first.vary[0], first.vary[1]);
  EXPECT_EQ(numbers(converge(first)), numbers(sorted));
}

TEST(convergence, the_same_run_is_computed_once) {
  // Each run is the reference of the coarser one. One additional run is finer than the finest.
  auto study = decay("imdrk-2-3", "1/8,1/16,1/32");
  study.reference.type = kind::next;
  EXPECT_EQ(converge(study).runs, 4);
  // A reference with its own method and step does not depend on the method that it replaces.
  study = decay("imdrk-1-2,imdrk-2-3", "1/8,1/16,1/32");
  study.reference = parse_reference("imdrk-5-4@1/256");
  EXPECT_EQ(converge(study).runs, 7);
}

TEST(convergence, a_failed_run_is_a_row_and_the_others_continue) {
  // One explicit method is far beyond its stability limit of Δt = O(ε). The other method has no such limit.
  auto study = bgk("md-imex-3-2", "time.method=ssprk-2-2,md-imex-3-2");
  study.overrides = {"velocity.max=9", "velocity.points=40", "space.cells=10", "model.epsilon=1e-6"};
  study.reference = parse_reference("md-imex-6-3@1/1000");
  const auto table = converge(study);
  EXPECT_TRUE(table.complete);
  EXPECT_EQ(table.failures(), 1);
  const auto& rows = table.blocks.at(0).rows;
  EXPECT_THAT(rows.at(0).problem,
              testing::ContainsRegex(
                  "no local equilibrium \\(temperature -.* is not positive\\).*\\[step [0-9]+, t = "));
  EXPECT_TRUE(std::isnan(rows.at(0).error));
  EXPECT_TRUE(rows.at(1).problem.empty());
  EXPECT_GT(rows.at(1).error, 0.0);
}

TEST(convergence, a_reference_that_fails_is_named) {
  convergence_study study{.case_name = "paper/ode",
                          .overrides = {"model.epsilon=1e-6"},
                          .vary = {parse_vary("time.dt=1/16,1/32")},
                          .reference = parse_reference("ssprk-2-2@1/64")};
  const auto table = converge(study);
  EXPECT_EQ(table.failures(), 2);
  for (const auto& row : table.blocks.at(0).rows) {
    EXPECT_TRUE(std::isnan(row.error));
    EXPECT_GT(row.steps, 0);
  }
}

TEST(convergence, a_stopped_study_shows_its_finished_runs_and_can_continue) {
  const auto study = decay("imdrk-1-2,imdrk-2-3", "1/8..1/64");
  convergence whole(study), stopped(study);
  whole.run();
  study_control control;
  // Reports come at the start and after each run.
  std::atomic<int> reports = 0;
  control.progress = [&reports](double, const std::string&) { ++reports; };
  control.stop = [&reports] { return reports > 3; };
  EXPECT_THROW(stopped.run(control), study_interrupted);
  const auto part = stopped.table();
  EXPECT_FALSE(part.complete);
  EXPECT_EQ(numbers(part).size(), 3U * 5U);
  stopped.run();
  EXPECT_TRUE(stopped.table().complete);
  EXPECT_EQ(numbers(stopped.table()), numbers(whole.table()));
}

TEST(convergence, reports_its_progress_by_work) {
  auto study = decay("imdrk-2-3", "1/8,1/1024");
  study_control control;
  std::vector<double> parts;
  control.progress = [&parts](double part, const std::string&) { parts.push_back(part); };
  converge(study, control);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts.front(), 0.0);
  // The longest run is first and is nearly all of the work.
  EXPECT_GT(parts[1], 0.99);
  EXPECT_DOUBLE_EQ(parts.back(), 1.0);
}

}  // namespace convergence_test
