#include <apsis/run/flow_watch.hpp>

#include <apsis/core/log.hpp>

#include <array>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Numbers the sides: first the faces of the domain, then the solid boxes.
std::size_t number_of_side(const surface& one) {
  return one.solid < 0 ? one.where.index() : face_names.size() + static_cast<std::size_t>(one.solid);
}

std::string table_of_side(std::size_t side) {
  return side < face_names.size() ? fmt::format("boundary.{}", face_names[side])
                                  : fmt::format("space.solid.{}", side - face_names.size() + 1);
}

}  // namespace

flow_watch::flow_watch(const run_setup& setup) : setup_(setup) {
  if (!setup.has_space()) return;
  const domain& space = setup.builder().space();
  for (std::size_t k = 0; k < space.surfaces().size(); ++k)
    if (const boundary* side = space.side(static_cast<int>(k)))
      if (const auto* end = dynamic_cast<const limited_flow*>(&side->undecorated()))
        ends_.emplace_back(number_of_side(space.surfaces()[k]), end);
  std::array<double, 1> any = {ends_.empty() ? 0.0 : -1.0};
  setup.processes().lowest(any);
  if (any[0] < 0.0) warned_.assign(face_names.size() + setup.config().solids.size(), false);
}

void flow_watch::update(const step_record& at) {
  if (warned_.empty()) return;
  std::vector<double> missed(warned_.size(), 0.0);
  for (const auto& [side, end] : ends_)
    if (end->take_shortfall()) missed[side] = -1.0;
  setup_.processes().lowest(missed);
  for (std::size_t side = 0; side < missed.size(); ++side) {
    if (missed[side] == 0.0 || warned_[side]) continue;
    warned_[side] = true;
    log::warning(
        fmt::format("less gas arrives at [{}] than its flux lets out (first in the step to t = {:.6g}); "
                    "nothing enters there, and less than the flux leaves",
                    table_of_side(side), at.t));
  }
}

}  // namespace apsis
