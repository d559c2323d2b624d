#include <apsis/design/more_stages.hpp>

namespace apsis {
namespace {

/// Returns `from` with a row and a column of zeros inserted at index `at`.
matrix<double> with_gap(const matrix<double>& from, std::size_t at) {
  matrix<double> to(from.rows() + 1, from.cols() + 1);
  const auto place = [at](std::size_t i) { return i < at ? i : i + 1; };
  for (std::size_t i = 0; i < from.rows(); ++i)
    for (std::size_t j = 0; j < from.cols(); ++j) to(place(i), place(j)) = from(i, j);
  return to;
}

}  // namespace

shu_osher_form<double> with_more_stages(shu_osher_form<double> m, std::size_t stages, random_source& random,
                                        std::size_t given) {
  while (m.stages() < stages) {
    const auto at =
        static_cast<std::size_t>(random.integer(static_cast<int>(given), static_cast<int>(m.stages())));
    m.P = with_gap(m.P, at);
    m.W = with_gap(m.W, at);
    m.D = with_gap(m.D, at);
    m.P(at, at - 1) = 1.0;
    m.D(at, at) = random.uniform(0.05, 0.5);
    const double ddot = random.one_in(2) ? -random.uniform(0.01, 0.2) : 0.0;
    m.ddot.insert(m.ddot.begin() + static_cast<std::ptrdiff_t>(at), ddot);
  }
  return m;
}

shu_osher_form<double> with_previous_value(const shu_osher_form<double>& m) {
  auto out = m;
  for (auto* part : {&out.P, &out.W, &out.D}) *part = with_gap(*part, 0);
  out.ddot.insert(out.ddot.begin(), 0.0);
  return out;
}

}  // namespace apsis
