// The table of a study has the same numbers as text, CSV, JSON and picture.
#include <apsis/study/convergence_report.hpp>

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace convergence_report_test {

using namespace apsis;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using json = nlohmann::ordered_json;

namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::vector<std::vector<std::string>> csv_of(const convergence_table& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(to_csv(table));
  for (std::string line; std::getline(in, line);) rows.push_back(cells_of(line));
  return rows;
}

convergence_table example() {
  convergence_study study{.case_name = "paper/ode",
                          .vary = {parse_vary("model.epsilon=1,1/100"), parse_vary("time.method=md-imex-3-2"),
                                   parse_vary("time.dt=1/8,1/16,1/48")}};
  return converge(study);
}

}  // namespace

TEST(convergence_report, csv_and_json_hold_every_bit_of_the_table) {
  const auto table = example();
  const auto csv = csv_of(table);
  const json rows = to_json(table);
  ASSERT_EQ(csv.size(), 7U);
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_THAT(csv[0], ElementsAre("model.epsilon", "time.method", "time.dt", "error", "rate", "steps", "dt",
                                  "wall_s", "cpu_s", "min_value", "problem"));
  std::size_t k = 0;
  for (const auto& block : table.blocks) {
    for (const auto& row : block.rows) {
      EXPECT_EQ(rows[k]["error"].get<double>(), row.error);
      EXPECT_EQ(rows[k]["dt"].get<double>(), row.dt);
      for (std::size_t c = 0; c < csv[0].size(); ++c) {
        const std::string& cell = csv[k + 1][c];
        if (!rows[k].contains(csv[0][c]) || rows[k][csv[0][c]].is_null())
          EXPECT_EQ(cell, "") << csv[0][c];
        else if (rows[k][csv[0][c]].is_number())
          EXPECT_EQ(std::stod(cell), rows[k][csv[0][c]].get<double>()) << csv[0][c];
        else
          EXPECT_EQ(cell, rows[k][csv[0][c]].get<std::string>());
      }
      ++k;
    }
  }
  // Keys are the values of the case, in any notation.
  EXPECT_EQ(rows[5]["time.dt"].get<double>(), 1.0 / 48.0);
  EXPECT_EQ(rows[5]["model.epsilon"].get<double>(), 0.01);
  EXPECT_TRUE(rows[3]["rate"].is_null());
}

TEST(convergence_report, text_has_a_block_for_every_combination) {
  const std::string text = to_text(example());
  EXPECT_THAT(text, HasSubstr("ODE model, accuracy test\nl2 norm of the difference to the next finer run\n"));
  EXPECT_THAT(text, HasSubstr("\nmodel.epsilon = 1/100, time.method = md-imex-3-2\n"));
  EXPECT_THAT(text, HasSubstr("1/48"));
}

TEST(convergence_report, a_difference_to_the_next_finer_run_is_not_called_an_error) {
  const auto of = [](const std::string& reference) {
    return converge({.case_name = "paper/ode",
                     .vary = {parse_vary("time.dt=1/8,1/16")},
                     .reference = parse_reference(reference)});
  };
  const auto next = of("next"), known = of("md-imex-6-3@1/256");
  EXPECT_THAT(to_text(next), HasSubstr("  difference "));
  EXPECT_THAT(to_text(next), Not(HasSubstr("error")));
  EXPECT_EQ(to_picture(next).panels.at(0).y_label, "difference (dimensionless)");
  EXPECT_THAT(to_text(known), HasSubstr("  error "));
  EXPECT_EQ(to_picture(known).panels.at(0).y_label, "error (dimensionless)");
}

TEST(convergence_report, picture_has_a_curve_for_every_block_and_the_orders_as_slopes) {
  const auto table = example();
  const picture p = to_picture(table);
  const panel& axes = p.panels.at(0);
  EXPECT_TRUE(axes.log_x && axes.log_y);
  EXPECT_EQ(axes.x_label, "Δt (dimensionless)");
  EXPECT_THAT(axes.slopes, ElementsAre(2.0));
  ASSERT_EQ(axes.curves.size(), 2U);
  EXPECT_EQ(axes.curves[1].label, "ε = 1/100, md-imex-3-2");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(axes.curves[1].x.at(k), table.blocks[1].rows[k].dt);
    EXPECT_EQ(axes.curves[1].y.at(k), table.blocks[1].rows[k].error);
  }
}

TEST(convergence_report, picture_of_two_keys_has_a_panel_for_each_value_of_the_shorter_list) {
  const convergence_study study{.case_name = "paper/ode",
                                .vary = {parse_vary("model.epsilon=1,2,3"), parse_vary("time.dt=1/8,1/16"),
                                         parse_vary("time.method=md-imex-6-3,md-imex-3-2")}};
  const picture p = to_picture(converge(study));
  ASSERT_EQ(p.panels.size(), 2U);
  EXPECT_EQ(p.panels[0].title, "md-imex-6-3");
  EXPECT_THAT(p.panels[0].slopes, ElementsAre(3.0));
  EXPECT_THAT(p.panels[1].slopes, ElementsAre(2.0));
  ASSERT_EQ(p.panels[1].curves.size(), 3U);
  EXPECT_EQ(p.panels[1].curves[2].label, "ε = 3");
}

TEST(convergence_report, runs_without_an_error_have_their_reason_everywhere) {
  auto table = example();
  auto& row = table.blocks[0].rows[1];
  row.error = row.rate = std::nan("");
  row.problem = "stage 2, \"cell 3\" is not admissible";
  EXPECT_THAT(to_text(table), HasSubstr(row.problem));
  EXPECT_THAT(to_csv(table), HasSubstr("\"stage 2, \"\"cell 3\"\" is not admissible\""));
  const json rows = to_json(table);
  EXPECT_EQ(rows[1]["problem"], row.problem);
  EXPECT_TRUE(rows[1]["error"].is_null());
  EXPECT_FALSE(rows[0].contains("problem"));
}

TEST(convergence_report, without_a_refined_key_there_is_no_picture_and_no_rate) {
  const convergence_study study{.case_name = "paper/ode",
                                .vary = {parse_vary("time.method=md-imex-3-2,md-imex-6-3")},
                                .reference = parse_reference("md-imex-6-3@1/1024")};
  const auto table = converge(study);
  EXPECT_EQ(table.refined, -1);
  ASSERT_EQ(table.blocks.size(), 1U);
  EXPECT_TRUE(to_picture(table).panels.empty());
  EXPECT_THAT(to_text(table), HasSubstr("md-imex-3-2"));
  for (const auto& row : to_json(table)) EXPECT_TRUE(row["rate"].is_null());
}

}  // namespace convergence_report_test
