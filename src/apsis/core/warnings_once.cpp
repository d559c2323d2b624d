#include <apsis/core/warnings_once.hpp>

#include <mutex>
#include <set>
#include <string_view>

namespace apsis {
namespace {

struct seen_warnings {
  std::mutex mutex;
  int users = 0;
  std::set<std::string> seen;
};

seen_warnings& warnings_so_far() {
  static seen_warnings instance;
  return instance;
}

/// Removes numbers except those in quoted names such as 'md-imex-6-3'.
std::string without_numbers(const std::string& message) {
  constexpr std::string_view in_numbers = "0123456789.+-e";
  const auto is_digit = [&](std::size_t k) {
    return k < message.size() && message[k] >= '0' && message[k] <= '9';
  };
  std::string text;
  bool quoted = false, in_number = false;
  for (std::size_t k = 0; k < message.size(); ++k) {
    const char c = message[k];
    if (c == '\'') quoted = !quoted;
    const bool begins = is_digit(k) || ((c == '-' || c == '+') && is_digit(k + 1));
    in_number = !quoted && (begins || (in_number && in_numbers.find(c) != std::string_view::npos));
    if (!in_number) text += c;
  }
  return text;
}

}  // namespace

warnings_once::warnings_once() {
  const std::lock_guard lock(warnings_so_far().mutex);
  ++warnings_so_far().users;
}

warnings_once::~warnings_once() {
  const std::lock_guard lock(warnings_so_far().mutex);
  if (--warnings_so_far().users == 0) warnings_so_far().seen.clear();
}

bool warnings_once::is_new(const std::string& message) {
  const std::lock_guard lock(warnings_so_far().mutex);
  return warnings_so_far().users == 0 || warnings_so_far().seen.insert(without_numbers(message)).second;
}

}  // namespace apsis
