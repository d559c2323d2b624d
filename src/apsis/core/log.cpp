#include <apsis/core/log.hpp>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace apsis::log {
namespace {

// The only file that sees spdlog: it is slow to compile and its macros are many.
spdlog::logger& logger() {
  static const auto instance = [] {
    auto made =
        std::make_shared<spdlog::logger>("apsis", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("%^%l%$: %v");
    return made;
  }();
  return *instance;
}

}  // namespace

void set_level(level lowest) {
  switch (lowest) {
    case level::quiet:
      logger().set_level(spdlog::level::off);
      return;
    case level::warning:
      logger().set_level(spdlog::level::warn);
      return;
    case level::info:
      logger().set_level(spdlog::level::info);
      return;
  }
}

void info(const std::string& message) {
  logger().info("{}", message);
}

void warning(const std::string& message) {
  logger().warn("{}", message);
}

}  // namespace apsis::log
