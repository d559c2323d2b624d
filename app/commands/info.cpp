#include "command_registry.hpp"
#include "print.hpp"

#include <apsis/core/version.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/provenance.hpp>

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace info_command {
namespace {

std::string as_text(const nlohmann::ordered_json& value, const std::string& indent = "") {
  std::string out;
  for (const auto& [key, item] : value.items()) {
    if (item.is_object())
      out += fmt::format("{}{}\n{}", indent, key, as_text(item, indent + "  "));
    else
      out +=
          fmt::format("{}{:<18}{}\n", indent, key, item.is_string() ? item.get<std::string>() : item.dump());
  }
  return out;
}

nlohmann::ordered_json devices() {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const found_device& one : found_devices()) all[one.place] = one.name;
  return all.empty() ? nlohmann::ordered_json("none") : all;
}

int info(bool json) {
  set_threads(0);
  const nlohmann::ordered_json all = {
      {"version", version()}, {"build", build_info()}, {"machine", machine_info()}, {"devices", devices()}};
  print(json ? all.dump(2) + "\n" : as_text(all));
  return 0;
}

action define(CLI::App& command) {
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "print one JSON object");
  return [json] { return info(*json); };
}

}  // namespace
}  // namespace info_command

extern const command_entry command_info;
const command_entry command_info = {.name = "info",
                                    .summary = "Version, compiler, build, machine and libraries",
                                    .place = 100,
                                    .define = info_command::define};

}  // namespace apsis::app
