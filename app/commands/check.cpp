#include "command_registry.hpp"
#include "file_kind.hpp"
#include "integrator_report.hpp"
#include "interrupt.hpp"
#include "method_report.hpp"
#include "print.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/integrator_kind_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/study/observed_limits.hpp>
#include <apsis/study/profile_errors.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace check_command {
namespace {

/// Throws input_error with a message of its own if the text is a case instead of a method.
void refuse_case(const std::string& text, const std::string& path) {
  if (const int line = line_of_model(text); line > 0)
    throw input_error(
        {path, line, 1},
        "a case is no method (it has a table [model]); apsis run checks a case before its first step");
}

struct options {
  std::string what;
  std::vector<std::string> overrides;
  std::optional<std::string> profile;
  bool json = false, observe = false;
};

std::string limit_text(const step_limit& limit) {
  if (std::isinf(limit.lost)) return fmt::format("> {:.4g}", limit.kept);
  return limit.kept > 0.0 ? fmt::format("{:.4f}", limit.kept) : fmt::format("< {:.4g}", limit.lost);
}

std::string observed_text(const std::vector<observed_limit>& all) {
  std::string text = fmt::format("{:<86}{:>8}   {}\n", "largest observed steps that preserve a property",
                                 "dt/dt_FE", "worst");
  for (const auto& one : all)
    text += fmt::format("  {:<84}{:>8}   {}\n", one.problem + ": " + one.property, limit_text(one.limit),
                        one.worst);
  return text;
}

nlohmann::ordered_json to_json(const observed_limit& one) {
  const auto number = [](double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
  };
  return {{"problem", one.problem},           {"property", one.property},
          {"promised", number(one.promised)}, {"kept", number(one.limit.kept)},
          {"lost", number(one.limit.lost)},   {"worst", one.worst}};
}

std::optional<profile_errors> predicted(const options& given) {
  constexpr int halvings = 3;
  if (!given.profile) {
    if (given.overrides.empty()) return std::nullopt;
    throw input_error(
        fmt::format("command line: '{}' has no case to change (apsis check reads one only for "
                    "--epsilon-profile); add --epsilon-profile CASE",
                    given.overrides.front().substr(0, 60)));
  }
  std::vector<std::string> overrides = given.overrides;
  overrides.push_back("time.method=" + given.what);
  return predict_profile_errors(load_case(*given.profile, overrides), halvings);
}

std::string profile_text(const profile_errors& errors, const std::string& profile) {
  std::string text = fmt::format(
      "predicted errors of the O(epsilon) terms of {} on point values, l2 norms over space; "
      "epsilon/C = {:.3g} ... {:.3g}\n  {:<12}{:<20}",
      profile, errors.smallest_epsilon, errors.largest_epsilon, "dt", "viscosity");
  for (const auto& name : errors.invariants) text += fmt::format("{:<12}", name);
  for (const auto& row : errors.rows) {
    text += fmt::format("\n  {:<12.4g}{:<20}", row.dt,
                        fmt::format("{:.4f} ... {:.4f}", row.least_flux, row.largest_flux));
    for (const double error : row.of_moments) text += fmt::format("{:<12.3g}", error);
  }
  return text + "\n";
}

nlohmann::ordered_json to_json(const profile_errors& errors) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : errors.rows) {
    nlohmann::ordered_json of_moments;
    for (std::size_t k = 0; k < row.of_moments.size(); ++k)
      of_moments[errors.invariants[k]] = row.of_moments[k];
    rows.push_back({{"dt", row.dt},
                    {"least_viscosity", row.least_flux},
                    {"largest_viscosity", row.largest_flux},
                    {"error", of_moments}});
  }
  return {{"smallest_epsilon", errors.smallest_epsilon},
          {"largest_epsilon", errors.largest_epsilon},
          {"rows", rows}};
}

int report(const method& m, const options& given) {
  nlohmann::ordered_json result = check_json(m);
  const auto profile = predicted(given);
  if (profile) result["epsilon_profile"] = to_json(*profile);
  std::vector<observed_limit> observed;
  if (given.observe) {
    observed = observe_limits(m);
    result["observed"] = nlohmann::ordered_json::array();
    for (const auto& one : observed) result["observed"].push_back(to_json(one));
  }
  print(given.json ? result.dump(2) + "\n"
                   : check_text(m) + (given.observe ? observed_text(observed) : "") +
                         (profile ? profile_text(*profile, *given.profile) : ""));
  if (!result["claims_hold"].get<bool>())
    throw claim_error(
        fmt::format("the claims of '{}' do not hold ({}); correct the coefficients or the claims", m.name,
                    first_failure(m)));
  for (const auto& one : observed)
    if (!one.keeps_promise())
      throw claim_error(
          fmt::format("the SSP coefficient {:.6g} of '{}' does not hold ({}: {} is lost at {:.6g} dt_FE); "
                      "this is a bug of the certificate, or of the problem",
                      one.promised, m.name, one.problem, one.property, one.limit.lost));
  return 0;
}

/// Reports an integrator that is not a method of one step.
int report_several_steps(const time_integrator& m, const options& given) {
  if (given.observe || given.profile)
    throw input_error(fmt::format(
        "command line: --observe and --epsilon-profile need a method of one step ('{}' takes several); "
        "leave them out",
        m.name));
  const auto result = integrator_json(m);
  print(given.json ? result.dump(2) + "\n" : integrator_text(m));
  if (!result["claims_hold"].get<bool>())
    throw claim_error(
        fmt::format("the claims of '{}' do not hold ({}); correct the coefficients or the claims", m.name,
                    result["failures"].front().get<std::string>()));
  return 0;
}

int check(const options& given) {
  end_on_interrupts();
  const std::string& what = given.what;
  if (is_method_name(what)) return report(find_method(what), given);
  const auto several = names_of_several_steps();
  if (std::find(several.begin(), several.end(), what) != several.end())
    return report_several_steps(find_integrator(what), given);
  std::error_code ignored;
  if (!std::filesystem::exists(what, ignored))
    throw input_error(fmt::format("no method '{}' (neither in the catalogue nor a file); {}",
                                  what.substr(0, 60), suggest(what, integrator_names())));
  // Parses without certifying: a method whose claims fail is reported, not rejected. A modified copy of a
  // catalogue file may retain its name here; a run rejects it.
  const std::string text = read_method_text(what);
  refuse_case(text, what);
  const method m = parse_any_method(text, what);
  if (m.steps > 1) return report_several_steps(*integrator_of_file(m), given);
  if (const auto problem = taken_name(m); !problem.empty()) log::warning(what + ": " + problem);
  return report(m, given);
}

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.add_option("METHOD", given->what, "a method of the catalogue or a method file")->required();
  command.add_flag("--json", given->json, "print one JSON object");
  command.add_flag(
      "--observe", given->observe,
      "also search for the largest steps that preserve positivity, total variation, entropy, ...");
  command.add_option(
      "--epsilon-profile", given->profile,
      "also predict the errors of the O(epsilon) terms, viscosity and initial layer, for the epsilon(x), "
      "data "
      "and step of this case and for three halvings of the step, without running it with METHOD");
  command.add_option("key=value", given->overrides, "override key=value of the case of --epsilon-profile");
  return [given] { return check(*given); };
}

}  // namespace
}  // namespace check_command

extern const command_entry command_check;
const command_entry command_check = {.name = "check",
                                     .summary = "Certify a method: order, SSP coefficient, structure, cost",
                                     .place = 50,
                                     .completion = completed_from_list("methods"),
                                     .define = check_command::define};

}  // namespace apsis::app
