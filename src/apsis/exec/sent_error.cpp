#include <apsis/exec/sent_error.hpp>

#include <apsis/exec/interruption.hpp>

#include <new>
#include <stdexcept>

namespace apsis {

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
  } catch (const interrupted_error&) {
    set(sent_error::interrupted_early, "");
  } catch (const error& failure) {
    set(failure.code() == exit_code::interrupted ? sent_error::interrupted : sent_error::other,
        failure.what());
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

[[noreturn]] void raise_error(const sent_error& sent, const std::string& message) {
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
      throw error(exit_code::interrupted, message);
    case sent_error::interrupted_early:
      throw interrupted_error();
    case sent_error::memory:
      throw std::bad_alloc();
    default:
      throw std::runtime_error(message);
  }
}

}  // namespace apsis
