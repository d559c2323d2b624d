#include "commands.hpp"
#include "method_report.hpp"

#include <algorithm>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/method.hpp>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>

namespace apsis::app {
namespace {

// Parsed but not certified: a method whose claims fail is to be reported on, not refused.
method read_method(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  constexpr std::size_t longest = 1'000'001;
  std::string text(longest, '\0');
  if (in) in.read(text.data(), static_cast<std::streamsize>(longest));
  if (in.bad() || (!in && in.gcount() == 0 && !in.eof()))
    throw io_error(
        fmt::format("cannot read '{}' (it is a folder or not readable) give a readable method file", path));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return parse_method(text, path);
}

int report(const method& m, bool as_json) {
  const nlohmann::ordered_json result = check_json(m);
  const bool holds = result["claims_hold"].get<bool>();
  print(as_json ? result.dump(2) + "\n" : check_text(m));
  if (holds) return 0;
  throw claim_error(fmt::format("the claims of '{}' do not hold ({}) correct the coefficients or the claims",
                                m.name, first_failure(m)));
}

int check(const std::string& what, bool as_json) {
  const std::vector<std::string> names = method_names();
  if (std::find(names.begin(), names.end(), what) != names.end()) return report(find_method(what), as_json);
  std::error_code ignored;
  if (!std::filesystem::exists(what, ignored))
    throw input_error(fmt::format("no method '{}' (neither in the catalogue nor a file) {}",
                                  what.substr(0, 60), suggest(what, names)));
  return report(read_method(what), as_json);
}

}  // namespace

void add_check(CLI::App& program, action& chosen) {
  struct options {
    std::string what;
    bool json = false;
  };
  auto given = std::make_shared<options>();
  CLI::App* command =
      program.add_subcommand("check", "Certify a method: order, SSP coefficient, structure, cost");
  command->add_option("METHOD", given->what, "a method of the catalogue or a method file")->required();
  command->add_flag("--json", given->json, "print one JSON object");
  command->callback([given, &chosen] { chosen = [given] { return check(given->what, given->json); }; });
}

}  // namespace apsis::app
