#include <paper/reproduce.hpp>

#include "command_registry.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"
#include "print.hpp"
#include "progress_bar.hpp"
#include "threads_option.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/output/result_folder.hpp>

#include <chrono>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <paper/claim_registry.hpp>

namespace apsis::app {
namespace reproduce_command {
namespace {

using namespace apsis::paper;

using json = nlohmann::ordered_json;

constexpr const char* document_name = "reproduce.json";

struct options {
  std::vector<std::string> claims;
  std::string out = "results/reproduce";
  std::optional<int> threads;
  bool json = false, resume = false;
};

/// A reproduction, which writes its claims to disk as they are checked.
class reproduction {
 public:
  explicit reproduction(const options& given)
      : options_(given), chosen_(find_claims(given.claims)), folder_(given.out) {
    if (given.resume) load();
  }

  /// Checks the claims that are not known yet; returns false if it was interrupted.
  bool run() {
    progress_bar bar;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const claim_entry& claim = *chosen_[k];
      if (known(claim.id) == nullptr) {
        study_control control;
        control.stop = interrupted;
        control.progress = [&](double part, const std::string& what) {
          bar.update((static_cast<double>(k) + part) / static_cast<double>(chosen_.size()),
                     fmt::format("{} ({} of {})  {}", claim.id, k + 1, chosen_.size(), what));
        };
        try {
          control.report(0.0, claim.statement);
          done_.push_back(check_claim(claim, control));
        } catch (const study_interrupted&) {
          return false;
        }
        save();
      }
      bar.finish();
      if (!options_.json) print(line(*known(claim.id)));
    }
    return true;
  }

  /// Returns the results of the requested claims, in the order of the registry.
  json document() const {
    json claims = json::array();
    for (const claim_entry* claim : chosen_)
      if (const json* found = known(claim->id)) claims.push_back(*found);
    double wall = 0.0;
    for (const auto& claim : claims) wall += claim["wall_s"].get<double>();
    return {{"version", version()},
            {"paper",
             "S. Gottlieb, Z. J. Grant, J. Hu, R. Shu, High order strong stability preserving "
             "multi-derivative implicit and IMEX Runge-Kutta methods with asymptotic preserving properties"},
            {"build", build_info()},
            {"machine", machine_info()},
            {"wall_s", wall},
            {"claims", claims}};
  }

  std::vector<std::string> failed() const {
    std::vector<std::string> ids;
    for (const auto& claim : done_)
      if (!claim["holds"].get<bool>()) ids.push_back(claim["id"]);
    return ids;
  }

 private:
  const json* known(const std::string& id) const {
    for (const auto& claim : done_)
      if (claim["id"] == id) return &claim;
    return nullptr;
  }

  void save() { folder_.publish_text(document_name, json_text(document()) + "\n"); }

  /// Loads the claims that hold from an earlier run of the same version. Throws input_error for
  /// another version.
  void load() {
    std::ifstream in(folder_.path() / document_name, std::ios::binary);
    if (!in) return;
    const json earlier = json::parse(in, nullptr, false);
    if (!earlier.is_object() || earlier.value("version", "") != version() || !earlier.contains("claims"))
      throw input_error(
          fmt::format("'{}' cannot be resumed (its {} is of another version or damaged); leave out --resume",
                      options_.out, document_name));
    for (const auto& claim : earlier["claims"])
      for (const claim_entry* wanted : chosen_)
        if (claim.value("id", "") == wanted->id && claim.value("holds", false)) done_.push_back(claim);
  }

  static std::string line(const json& claim) {
    return fmt::format("{:<4} {:<6} {:6.1f} s  {}\n", claim["id"].get<std::string>(),
                       claim["holds"].get<bool>() ? "holds" : "FAILS", claim["wall_s"].get<double>(),
                       claim["statement"].get<std::string>());
  }

  options options_;
  std::vector<const claim_entry*> chosen_;
  result_folder folder_;
  std::vector<json> done_;
};

int reproduce(const options& given) {
  watch_for_interrupts("the current step or run; finished claims are retained");
  set_threads(given.threads.value_or(default_threads()));
  reproduction all(given);
  const bool complete = all.run();
  const json document = all.document();
  if (given.json) print(json_text(document) + "\n");
  if (!complete) {
    log::warning(fmt::format("interrupted ({} claims are in '{}'); --resume continues",
                             document["claims"].size(), given.out));
    return static_cast<int>(exit_code::interrupted);
  }
  const auto failed = all.failed();
  std::string drawing_problem;
  try {
    draw("report", {given.out});
  } catch (const io_error& problem) {
    drawing_problem = problem.what();
  } catch (const interruption&) {
    log::warning(
        fmt::format("interrupted (all claims are checked); apsis report {} makes the page", given.out));
    return static_cast<int>(exit_code::interrupted);
  }
  if (!given.json)
    print(fmt::format("{} of {} claims hold; see {}/{}\n", document["claims"].size() - failed.size(),
                      document["claims"].size(), given.out,
                      drawing_problem.empty() ? "report.html" : document_name));
  if (!failed.empty()) {
    if (!drawing_problem.empty()) log::warning(drawing_problem);
    throw claim_error(fmt::format("{} claim(s) of the paper do not hold here ({}); see the findings in '{}'",
                                  failed.size(), fmt::join(failed, ", "), given.out));
  }
  if (!drawing_problem.empty()) throw io_error(drawing_problem);
  return 0;
}

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.add_option("CLAIM", given->claims, "claims such as C22 (apsis list claims); default all");
  command.add_option("--out", given->out, "folder for report.html, reproduce.json and pictures")
      ->capture_default_str();
  command.add_flag("--resume", given->resume,
                   "retain the claims that hold in an earlier run in the same folder, and check the others");
  add_threads(command, given->threads, "threads to use", "all processors");
  command.add_flag("--json", given->json, "print only reproduce.json on standard output");
  return [given] { return reproduce(*given); };
}

}  // namespace
}  // namespace reproduce_command

extern const command_entry command_reproduce;
const command_entry command_reproduce = {.name = "reproduce",
                                         .summary = "Check every claim of the paper and redraw its figures",
                                         .place = 60,
                                         .completion = completed_from_list("claims"),
                                         .define = reproduce_command::define};

}  // namespace apsis::app
