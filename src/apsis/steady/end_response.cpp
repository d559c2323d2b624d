#include <apsis/steady/end_response.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace apsis {

end_response::end_response(const phase_space& space, int stride) : velocities_(space.velocities) {
  for (auto* row : {&ghosts_[0], &ghosts_[1], &outgoing_, &incoming_})
    row->assign(static_cast<std::size_t>(stride), 0.0);
}

void end_response::values_at(const gas_end_of_segment& end, const double* inside, double* row) {
  const auto speeds = velocities_.speeds(end.where.direction);
  const double sign = end.where.upper ? -1.0 : 1.0;
  const std::array<const double*, 3> rows = {inside, inside, inside};
  const std::array<double*, most_ghosts> ghosts = {ghosts_[0].data(), ghosts_[1].data()};
  const pencil_end at_end{rows, ghosts, velocities_, velocities_.components(), end.at};
  constexpr double t = 0.0;  // the conditions are those of a steady state
  end.side->fill(end.where, t, at_end);
  const double* enters = ghosts_[0].data();
  if (!end.side->is_axis() && end.side->prescribes_incoming(most_ghosts, most_ghosts)) {
    for (std::size_t k = 0; k < speeds.size(); ++k) outgoing_[k] = sign * speeds[k] > 0.0 ? 0.0 : inside[k];
    const std::array<const double*, most_ghosts> filled = {ghosts_[0].data(), ghosts_[1].data()};
    std::fill(incoming_.begin(), incoming_.end(), 0.0);
    end.side->incoming_given_outgoing(end.where, t, end.at, outgoing_.data(), filled, incoming_.data());
    enters = incoming_.data();
  }
  for (std::size_t k = 0; k < speeds.size(); ++k) row[k] = sign * speeds[k] > 0.0 ? enters[k] : inside[k];
}

}  // namespace apsis
