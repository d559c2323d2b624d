#include <apsis/exec/agreement.hpp>

#include <apsis/exec/sent_error.hpp>

#include <array>
#include <limits>
#include <string>

namespace apsis {
namespace {

/// Returns the cell of an error: the error in the lowest cell is thrown. An error without a cell (−1)
/// concerns the whole run and precedes all others. Infinity means no error.
double priority(const std::exception_ptr& mine) {
  if (!mine) return std::numeric_limits<double>::infinity();
  std::string message;
  return static_cast<double>(describe(mine, message).site.cell);
}

}  // namespace

void agree_on_errors(communicator& processes, const std::exception_ptr& mine) {
  if (processes.is_single()) {
    if (mine) std::rethrow_exception(mine);
    return;
  }
  std::array<double, 1> first = {priority(mine)};
  const double own = first[0];
  processes.lowest(first);
  if (first[0] == std::numeric_limits<double>::infinity()) return;
  std::array<double, 1> rank = {own == first[0] ? static_cast<double>(processes.rank())
                                                : std::numeric_limits<double>::infinity()};
  processes.lowest(rank);
  const int from = static_cast<int>(rank[0]);
  sent_error sent;
  std::string message;
  if (processes.rank() == from) sent = describe(mine, message);
  processes.broadcast(std::as_writable_bytes(std::span(&sent, 1)), from);
  message.resize(static_cast<std::size_t>(sent.length));
  processes.broadcast(std::as_writable_bytes(std::span(message.data(), message.size())), from);
  if (processes.rank() == from) std::rethrow_exception(mine);
  raise_error(sent, message);
}

}  // namespace apsis
