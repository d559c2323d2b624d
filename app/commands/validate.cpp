#include "command_registry.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"
#include "print.hpp"
#include "progress_bar.hpp"
#include "threads_option.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/core/warning_record.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/output/result_folder.hpp>

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <validation/comparison.hpp>
#include <validation/quantity.hpp>

namespace apsis::app {
namespace validate_command {
namespace {

using namespace apsis::validation;

using json = nlohmann::ordered_json;

constexpr const char* document_name = "validate.json";

struct options {
  std::vector<std::string> words;
  std::string out = "results/validate";
  std::optional<int> threads;
  bool json = false;
};

/// Computes one value for parameters of the user.
int compute_one(const options& given, const quantity_entry& quantity,
                const std::vector<std::string>& settings) {
  const warning_record warnings;
  progress_bar bar;
  const std::string label = fmt::format("{} {}", quantity.name, fmt::join(settings, " "));
  const double value = compute_quantity(quantity, settings, [&](double part) {
    bar.update(std::min(part, 1.0), label);
    return interrupted();
  });
  bar.finish();
  if (given.json) {
    print(json_text(json{{"name", quantity.name},
                         {"settings", settings},
                         {"value", value},
                         {"warnings", warnings.messages()}}) +
          "\n");
  } else {
    print(fmt::format("{:.6g}   {}\n", value, quantity.description));
  }
  return 0;
}

std::string line(const compared_value& one) {
  return fmt::format("{:<6} {:<12} {:<24} {:>10.6g}  {:<9} {:>9.6g}  difference {:+.1e} (tolerance {:.0e})\n",
                     one.holds() ? "holds" : "FAILS", one.quantity->name,
                     fmt::format("{}", fmt::join(settings_of(one.reference->at), " ")), one.value,
                     to_string(one.reference->from), one.reference->value, one.difference(),
                     one.reference->tolerance);
}

/// A comparison of some quantities with all their reference values. It writes the values to disk as they
/// are computed.
class comparison {
 public:
  comparison(const options& given, std::vector<const quantity_entry*> chosen)
      : given_(given), chosen_(std::move(chosen)), folder_(given.out) {
    for (const quantity_entry* quantity : chosen_) expected_ += quantity->references.size();
  }

  /// Computes all values; returns false if it was interrupted.
  bool run() {
    progress_bar bar;
    for (const quantity_entry* quantity : chosen_)
      for (const auto& reference : quantity->references) {
        const std::string label = fmt::format("{} ({} of {})", quantity->name, done_.size() + 1, expected_);
        try {
          done_.push_back(compare_with_reference(*quantity, reference, [&](double part) {
            bar.update(
                (static_cast<double>(done_.size()) + std::min(part, 1.0)) / static_cast<double>(expected_),
                label);
            return interrupted();
          }));
        } catch (const quantity_interrupted&) {
          return false;
        }
        bar.finish();
        folder_.publish_text(document_name, json_text(document()) + "\n");
        if (!given_.json) print(line(done_.back()));
      }
    return true;
  }

  /// Returns the values computed so far, by quantity.
  json document() const {
    json quantities = json::array();
    double wall = 0.0;
    for (const quantity_entry* quantity : chosen_) {
      std::vector<compared_value> own;
      for (const auto& one : done_)
        if (one.quantity == quantity) own.push_back(one);
      if (!own.empty()) quantities.push_back(to_json(*quantity, own));
    }
    for (const auto& one : done_) wall += one.wall_s;
    return {{"version", version()}, {"build", build_info()},    {"machine", machine_info()},
            {"wall_s", wall},       {"quantities", quantities}, {"warnings", warnings_.messages()}};
  }

  /// Returns how many reference values are computed, and how many are not met.
  std::pair<std::size_t, std::size_t> counts() const {
    const auto failed =
        std::count_if(done_.begin(), done_.end(), [](const auto& one) { return !one.holds(); });
    return {done_.size(), static_cast<std::size_t>(failed)};
  }

 private:
  warning_record warnings_;
  const options& given_;
  std::vector<const quantity_entry*> chosen_;
  result_folder folder_;
  std::vector<compared_value> done_;
  std::size_t expected_ = 0;
};

int compare(const options& given, const std::vector<const quantity_entry*>& chosen) {
  comparison all(given, chosen);
  const bool complete = all.run();
  const auto [computed, failed] = all.counts();
  if (given.json) print(json_text(all.document()) + "\n");
  if (!complete) {
    log::warning(
        fmt::format("interrupted ({} values are in '{}'; the one in progress is lost)", computed, given.out));
    return static_cast<int>(exit_code::interrupted);
  }
  std::string drawing_problem;
  try {
    draw("report", {given.out});
  } catch (const io_error& problem) {
    drawing_problem = problem.what();
  } catch (const interruption&) {
    log::warning(
        fmt::format("interrupted (all values are computed); apsis report {} makes the page", given.out));
    return static_cast<int>(exit_code::interrupted);
  }
  if (!given.json)
    print(fmt::format("{} of {} reference values are met; see {}/{}\n", computed - failed, computed,
                      given.out, drawing_problem.empty() ? "report.html" : document_name));
  if (failed > 0) {
    if (!drawing_problem.empty()) log::warning(drawing_problem);
    throw claim_error(
        fmt::format("{} reference value(s) are not met (differences exceed their tolerances); see "
                    "the values in '{}'",
                    failed, given.out));
  }
  if (!drawing_problem.empty()) throw io_error(drawing_problem);
  return 0;
}

int validate(const options& given) {
  watch_for_interrupts("the current step");
  set_threads(given.threads.value_or(default_threads()));
  const auto is_setting = [](const std::string& word) { return word.find('=') != std::string::npos; };
  std::vector<const quantity_entry*> chosen;
  std::vector<std::string> settings;
  for (const auto& word : given.words) {
    if (is_setting(word)) {
      settings.push_back(word);
    } else {
      chosen.push_back(&find_quantity(word));
    }
  }
  if (!settings.empty() && chosen.size() != 1)
    throw input_error(
        fmt::format("'{}' sets a parameter of {} quantities (one is needed); write for example apsis "
                    "validate couette delta=2",
                    settings.front(), chosen.size()));
  try {
    if (!settings.empty()) return compute_one(given, *chosen.front(), settings);
    return compare(given, chosen.empty() ? quantity_entries() : chosen);
  } catch (const quantity_interrupted&) {
    log::warning("interrupted (the value in progress is lost)");
    return static_cast<int>(exit_code::interrupted);
  }
}

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.add_option("QUANTITY", given->words,
                     "quantities (apsis list quantities), default all; or one with parameters as key=value");
  command.add_option("--out", given->out, "folder for report.html, validate.json and pictures")
      ->capture_default_str();
  add_threads(command, given->threads, "threads to use", "all processors");
  command.add_flag("--json", given->json, "print only JSON on standard output");
  return [given] { return validate(*given); };
}

}  // namespace
}  // namespace validate_command

extern const command_entry command_validate;
const command_entry command_validate = {
    .name = "validate",
    .summary = "Compare the solver with reference values of gas flows, or compute one for other parameters",
    .place = 65,
    .completion = completed_from_list("quantities"),
    .define = validate_command::define};

}  // namespace apsis::app
