#include <apsis/verify/strong_stability.hpp>

namespace apsis {

double promised_coefficient(const certificate& c) {
  if (c.kind != method_kind::implicit_only) return c.ssp_coefficient.convert_to<double>();
  return c.unconditional ? std::numeric_limits<double>::infinity()
                         : c.radius_of_implicit_part.convert_to<double>();
}

step_limit search_step(std::size_t count, double unit, const step_search& how,
                       const std::function<double(std::size_t, double)>& excess) {
  if (how.unit > 0.0) unit = how.unit;
  if (count == 0) throw input_error("no data to step from (the list is empty); give at least one state");
  if (!(unit > 0.0) || std::isinf(unit))
    throw input_error("steps have no unit (the transport sets no forward Euler step); set step_search::unit");
  step_limit limit;
  limit.unit = unit;
  const auto keeps = [&](double step) {
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t k = (limit.data + n) % count;  // the data that lost it last are tested first
      const double found = excess(k, step * unit);
      if (!(found <= 0.0)) {
        limit.lost = step;
        limit.data = k;
        limit.excess = found;
        return false;
      }
    }
    return true;
  };
  for (double step = how.lowest; step <= how.highest; step *= how.rung) {
    if (!keeps(step)) break;
    limit.kept = step;
  }
  if (limit.kept > 0.0 && limit.kept < how.promised && how.promised < limit.lost && keeps(how.promised))
    limit.kept = how.promised;
  while (limit.kept > 0.0 && std::isfinite(limit.lost) &&
         limit.lost - limit.kept > how.accuracy * limit.lost) {
    const double middle = 0.5 * (limit.kept + limit.lost);
    if (keeps(middle)) limit.kept = middle;
  }
  return limit;
}

}  // namespace apsis
