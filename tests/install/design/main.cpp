// The best second-order method with three stages has the SSP coefficient s − 2 = 1.
#include <apsis/design/search.hpp>

#include <cmath>
#include <cstdio>

int main() {
  apsis::design_task task;
  task.stages = 3;
  task.demands.order = 2;
  apsis::design_search_options options;
  options.starts = 40;
  const auto found = apsis::search_methods(task, options);
  if (!found.best) return 1;
  std::printf("r = %.9g\n", found.best->r);
  return std::abs(found.best->r - 1) < 1e-6 ? 0 : 1;
}
