#include <apsis/exec/agreement.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/interruption.hpp>

#include <array>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace apsis {
namespace {

/// An error as it is sent to the other processes.
struct sent_error {
  enum kind : int { other, memory, input, numerical, output, claim, interrupted };
  int what = other;
  std::int64_t length = 0;  ///< of the message
  failure_site site;
};

sent_error describe(const std::exception_ptr& mine, std::string& message) {
  sent_error sent;
  const auto set = [&](int what, const std::string& text) {
    sent.what = what;
    message = text;
  };
  try {
    std::rethrow_exception(mine);
  } catch (const numerical_error& failure) {
    set(sent_error::numerical, failure.problem());
    sent.site = failure.site();
  } catch (const input_error& failure) {
    set(sent_error::input, failure.what());
  } catch (const io_error& failure) {
    set(sent_error::output, failure.what());
  } catch (const claim_error& failure) {
    set(sent_error::claim, failure.what());
  } catch (const interrupted_error& failure) {
    set(sent_error::interrupted, failure.what());
  } catch (const std::bad_alloc&) {
    set(sent_error::memory, "");
  } catch (const std::exception& failure) {
    set(sent_error::other, failure.what());
  } catch (...) {
    set(sent_error::other, "an exception without a message");
  }
  sent.length = static_cast<std::int64_t>(message.size());
  return sent;
}

[[noreturn]] void raise(const sent_error& sent, const std::string& message) {
  switch (sent.what) {
    case sent_error::numerical:
      throw numerical_error(message, sent.site);
    case sent_error::input:
      throw input_error(message);
    case sent_error::output:
      throw io_error(message);
    case sent_error::claim:
      throw claim_error(message);
    case sent_error::interrupted:
      throw interrupted_error();
    case sent_error::memory:
      throw std::bad_alloc();
    default:
      throw std::runtime_error(message);
  }
}

/// Errors without a cell come first: they concern the whole run.
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
  raise(sent, message);
}

}  // namespace apsis
