#include "design_embedded.hpp"
#include "interrupt.hpp"
#include "method_report.hpp"
#include "method_writer.hpp"
#include "print.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/design/embedded.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

embedded_task task_of(const embedded_options& given, const method& m) {
  embedded_task task;
  if (given.order && (*given.order < 1 || *given.order >= m.claims.order))
    throw input_error(
        fmt::format("command line: --order {} is out of range (from 1 to {}: below that of '{}'); change it",
                    *given.order, m.claims.order - 1, m.name));
  task.order = given.order.value_or(0);
  if (given.cost != "nothing" && given.cost != "one-solve")
    throw input_error(fmt::format("command line: unknown --cost '{}' (there is no such cost); {}",
                                  given.cost.substr(0, 60), suggest(given.cost, {"nothing", "one-solve"})));
  task.cost = given.cost == "nothing" ? embedded_cost::nothing : embedded_cost::one_solve;
  return task;
}

std::string text_of(const embedded_attempt& tried, double least_coverage) {
  if (tried.residual < 1e-15)  // the row of u^{n+1} always satisfies the conditions
    return fmt::format("order {}{}: coverage {:.2g} of the error, at least {:.2g} needed", tried.order,
                       tried.convex ? "" : ", not convex", tried.coverage < 1e-12 ? 0.0 : tried.coverage,
                       least_coverage);
  return fmt::format("order {}{}: nearest residual {:.1e}", tried.order, tried.convex ? "" : ", not convex",
                     tried.residual);
}

}  // namespace

int design_embedded(const embedded_options& given) {
  end_on_interrupts();
  method m = find_method(given.method);
  const embedded_task task = task_of(given, m);
  method_writer file(given.out);
  const embedded_search search = search_embedded(m, task);
  if (!search.found) {
    std::vector<std::string> tried;
    for (const auto& attempt : search.attempts) tried.push_back(text_of(attempt, task.least_coverage));
    throw numerical_error(fmt::format(
        "'{}' has no embedded solution with the cost {} ({}); {}", m.name, given.cost, fmt::join(tried, "; "),
        task.cost == embedded_cost::nothing ? "try --cost one-solve" : "try a lower --order"));
  }
  m.embedded = search.found;
  m.embedded->origin = fmt::format(
      "apsis design --embedded {}{}: the {} of order {} {}whose distance to u^(n+1) is closest "
      "to 1/{} of the Taylor term of order {}",
      m.name, given.cost == "nothing" ? " --cost nothing" : "",
      m.embedded->convex ? "convex row" : "row with slightly negative weights", m.embedded->order,
      m.claims.intermediate ? "with the O(epsilon) term of the last stage " : "",
      default_parts(m.embedded->order), m.embedded->order + 1);
  m.name = file.name();
  file.write(m);
  const auto report = check_json(m);
  print(given.json ? report.dump(2) + "\n"
                   : fmt::format("written to '{}'\n\n{}", file.path(), check_text(m)));
  if (!report["claims_hold"].get<bool>())
    throw claim_error(fmt::format("the method in '{}' lacks a requested property ({}); report this",
                                  file.path(), first_failure(m)));
  return 0;
}

}  // namespace apsis::app
