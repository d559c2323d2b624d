#pragma once

#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>

/// Settings of a small gas with the collision model BGK. An empty text leaves its key out.
struct small_gas {
  std::string epsilon = "0.3", degrees = "3";
  std::string velocity = "max = 7\npoints = 12\n";  ///< keys of [velocity]
  std::string method = "md-imex-3-2", end = "0.1";
};

/// Returns the tables [model], [velocity] and [time] of a gas in steps of time.safety = 1.
inline std::string gas_tables(const small_gas& of) {
  const auto key = [](const char* name, const std::string& value) {
    return value.empty() ? std::string() : fmt::format("{} = {}\n", name, value);
  };
  return "[model]\nname = \"bgk\"\n" + key("epsilon", of.epsilon) + key("degrees_of_freedom", of.degrees) +
         "[velocity]\n" + of.velocity +
         fmt::format("[time]\nmethod = \"{}\"\nend = {}\nsafety = 1\n", of.method, of.end);
}

/// Returns the run of a case at its end.
inline apsis::simulation finished(const std::string& text, const std::vector<std::string>& overrides = {}) {
  apsis::simulation run(apsis::parse_case(text, "case.toml", overrides));
  while (!run.finished()) run.advance();
  return run;
}
