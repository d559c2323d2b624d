// A modified built-in case. The density decays to its mean and the mass stays constant.
#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <cstdio>
#include <numeric>

double mass(const apsis::simulation& run) {
  const auto fields = run.fields();
  return std::accumulate(fields.values.at(0).begin(), fields.values.at(0).end(), 0.0);
}

int main() {
  apsis::simulation run(apsis::load_case("paper/bgk-mixed", {"velocity.points=30", "space.cells=10"}));
  const double before = mass(run);
  for (int step = 0; step < 3; ++step) run.advance();
  std::printf("mass %.15g, after three steps %.15g\n", before, mass(run));
  return before > 1 && std::abs(mass(run) / before - 1) < 1e-12 ? 0 : 1;
}
