#include <paper/accuracy_figure.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace apsis::paper {
namespace {

std::string error_text(double x) {
  return std::isfinite(x) ? fmt::format("{:.2e}", x) : "-";
}

}  // namespace

picture accuracy_picture(const convergence_table& table, const std::string& name, const std::string& title,
                         const std::string& caption) {
  picture p{name, title, caption, {}};
  for (const auto& block : table.blocks) {
    const std::string& method = block.values.at(0);
    if (p.panels.empty() || p.panels.back().title != method) {
      panel next;
      next.title = method;
      next.x_label = "Δt (dimensionless)";
      next.y_label = "L² error (dimensionless)";
      next.log_x = next.log_y = true;
      next.slopes = {static_cast<double>(find_method(method).claims.order)};
      p.panels.push_back(next);
    }
    curve c{"ε = " + block.values.at(1), {}, {}};
    for (const auto& row : block.rows) {
      c.x.push_back(row.dt);
      c.y.push_back(row.error);
    }
    p.panels.back().curves.push_back(std::move(c));
  }
  return p;
}

report_table accuracy_table(const convergence_table& table, const std::string& title) {
  report_table out{title, {"method", "ε"}, {}};
  for (const auto& row : table.blocks.at(0).rows) out.columns.push_back(row.values.back());
  for (const auto& block : table.blocks) {
    std::vector<std::string> cells = block.values;
    for (const auto& row : block.rows)
      cells.push_back(std::isfinite(row.rate) ? fmt::format("{} ({:.2f})", error_text(row.error), row.rate)
                                              : error_text(row.error));
    out.rows.push_back(std::move(cells));
  }
  return out;
}

const std::vector<convergence_row>& rows_of(const convergence_table& table, const std::string& method,
                                            const std::string& epsilon) {
  for (const auto& block : table.blocks)
    if (block.values.at(0) == method && block.values.at(1) == epsilon) return block.rows;
  throw input_error(fmt::format("the study has no run of '{}' with epsilon {}", method, epsilon));
}

finding slopes_near(const std::string& what, const std::vector<convergence_row>& rows, std::size_t count,
                    double order, double tolerance) {
  double farthest = rows.size() > count ? order : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = rows.size() - std::min(count, rows.size()); k < rows.size(); ++k)
    if (!(std::abs(rows[k].rate - order) <= std::abs(farthest - order))) farthest = rows[k].rate;
  return close_to(what, farthest, order, tolerance);
}

finding no_failures(const convergence_table& table) {
  return exactly("runs that failed", table.failures(), 0);
}

}  // namespace apsis::paper
