// Features of C++20 in the sources that compilers or standard libraries may lack: ApsisCompiler.cmake compiles this file.
#include <bit>
#include <charconv>
#include <compare>
#include <concepts>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <ranges>
#include <span>
#include <string_view>
#include <vector>

template <class F>
concept function_of_time = requires(F f, double t) {
  { f(t) } -> std::convertible_to<double>;
};

struct version {
  int major = 0, minor = 0;
  auto operator<=>(const version&) const = default;
};

double sum(function_of_time auto f, std::span<const double> times) {
  double total = 0;
  for (const double t : times | std::views::reverse) total += f(t);
  return total;
}

double of_text(std::string_view text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return text.starts_with('-') ? std::midpoint(value, std::numbers::pi) : value;
}

bool all() {
  std::vector<double> times{1, 2, 3};
  std::erase_if(times, [](double t) { return t > 2; });
  const auto pick = []<class T>(const T& a, const T&) { return a; };
  const version v{.minor = 1};
  return v < version{.major = 1} && sum([&](double t) { return pick(t, t); }, times) > of_text("1e3") &&
         std::bit_cast<std::uint64_t>(1.0) != 0;
}
