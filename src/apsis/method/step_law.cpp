#include <apsis/method/step_law.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>

#include <fmt/format.h>

namespace apsis {

const std::vector<step_law>& step_laws() {
  static const std::vector<step_law> laws = {
      {"predictive",
       "for stiff systems: a decrease of the step is expected to continue, an increase is not",
       "Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496-517; Hairer, Wanner, Solving Ordinary Differential "
       "Equations II, section IV.8",
       {},
       0.0,
       true},
      {"integral",
       "for methods without limits of stability: the last error alone decides",
       "Hairer, Norsett, Wanner, Solving Ordinary Differential "
       "Equations I, section II.4",
       {1.0, 0.0, 0.0}},
      {"pi",
       "for explicit methods: the step does not oscillate where stability limits it",
       "Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533-554, with 0.3 and 0.4",
       {0.7, -0.4, 0.0}},
      {"pid",
       "for additive methods: as pi, with three errors",
       "Kennedy, Carpenter, Appl. Numer. Math. 44 (2003) 139-181, with 0.49, 0.34 and 0.10",
       {0.49, -0.34, 0.10}},
      {"h211b",
       "for a smooth sequence of steps, with b = 4",
       "Soderlind, ACM Trans. Math. Softw. 29 (2003) 1-26",
       {0.25, 0.25, 0.0},
       0.25},
      {"h312pid",
       "for noisy errors: the steps change slowest",
       "Soderlind, ACM Trans. Math. Softw. 29 (2003) 1-26",
       {1.0 / 18.0, 1.0 / 9.0, 1.0 / 18.0}},
  };
  return laws;
}

std::vector<std::string> step_law_names() {
  std::vector<std::string> names;
  for (const step_law& law : step_laws()) names.push_back(law.name);
  return names;
}

const step_law& find_step_law(const std::string& name) {
  for (const step_law& law : step_laws())
    if (law.name == name) return law;
  throw input_error(fmt::format("unknown controller '{}' (there is no such name); {}", printable(name),
                                suggest(name, step_law_names())));
}

}  // namespace apsis
