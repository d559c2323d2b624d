#pragma once

#include "measure/table.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis::bench::peers {

/// Cost and accuracy of one integration.
struct outcome {
  double seconds = 0.0;         ///< CPU time of the steps, without monitoring
  double error = 0.0;           ///< error at the end time
  double smallest = 0.0;        ///< smallest unknown over all steps
  double smallest_final = 0.0;  ///< smallest unknown at the end
  long steps = 0;
  std::string failure = {};  ///< empty if the end time was reached
};

/// Returns the names of all IMEX methods of the catalogue and of the extrapolated Euler steps of orders 2
/// to 8.
std::vector<std::string> imex_contestants();
/// Returns the names of all explicit methods of the catalogue.
std::vector<std::string> explicit_contestants();

/// Returns tolerances from `loosest` to `tightest`, two in each decade.
std::vector<double> two_per_decade(double loosest, double tightest);

/// The integrators of other_integrators() in words, for the notes of tables.
inline constexpr const char* words_of_others =
    "two-step methods, IMEX-BDF of orders 2 to 5, and a method with exact collisions";

/// Class of contestants. Each row of best results covers one or several classes.
enum class league {
  ssp,       ///< methods of Apsis with an SSP coefficient, also of two steps, equal steps; count only without
             ///< negative unknowns
  any_sign,  ///< methods of the catalogue without an SSP coefficient, also explicit ones, equal steps
  adaptive,  ///< methods of Apsis, steps chosen by a tolerance
  baseline,  ///< methods of the literature in the library: IMEX-BDF and exact collisions, equal steps
  other      ///< other programs, and explicit SSP methods, the usual choice without stiffness
};

/// Returns the class of an integrator of the library with equal steps (integrators.hpp).
league league_of(const std::string& method);

/// A point of a work–precision diagram: a contestant with a given step length or tolerance.
struct attempt {
  std::string contestant, setting;
  league of = league::other;
  std::function<outcome()> run;
  outcome measured = {};
  bool counts = false;  ///< whether it is the cheapest of its kind for some error

  /// Whether it is a method of the catalogue, of a family or of two steps.
  bool ours() const { return of != league::other && of != league::baseline; }
};

/// The work that each contestant needs to reach an error: that of its cheapest run that reaches the error,
/// whatever the setting, without interpolation.
class contest {
 public:
  /// `unit`: "s", or "µs" for short runs; `signs`: whether tables show the smallest unknown, and compare runs
  /// that stay nonnegative.
  contest(std::vector<double> errors, std::string unit, bool signs)
      : errors_(std::move(errors)), unit_(std::move(unit)), signs_(signs) {}

  void add(attempt one) { attempts_.push_back(std::move(one)); }

  /// Runs every attempt once. Attempts that count and take less than `seconds_each` then run in turns,
  /// `repeats` times; their CPU time is the median.
  void run(int repeats, double seconds_each);

  /// After run(), adds columns, rows and runs to a table. Rows are the best of Apsis, every contestant or
  /// only the others, the best of the others, and the best of the baselines. If ε is given, it is the
  /// first column.
  void add_to(result_table& result, std::optional<double> epsilon, bool only_others) const;

  /// After run(), returns a row for each contestant, or only for the others. For every error it has the CPU
  /// time, and in brackets the time relative to the best of Apsis. If signs are shown, it has the smallest
  /// unknown too. The best of Apsis then has nonnegative unknowns.
  std::vector<std::vector<nlohmann::json>> rows(bool only_others) const;
  /// After run(), returns for every error the time and the method of the best run of Apsis. Three rows are
  /// for all methods, for those with an SSP coefficient, and for steps chosen by a tolerance. Rows without
  /// any run are left out.
  std::vector<std::vector<nlohmann::json>> best_of_ours() const;
  /// After run(), returns for every error the name of the best of the others, and its relative time. This is
  /// relative to the best of Apsis with the same lower bound of the unknowns. If signs are shown, three rows
  /// are for runs that stay nonnegative, for those that do up to rounding, and for all.
  std::vector<std::vector<nlohmann::json>> best_of_others() const;
  /// Does the same for the baselines; no rows without baselines.
  std::vector<std::vector<nlohmann::json>> best_of_baselines() const;
  /// Returns all runs, for diagrams.
  nlohmann::json points() const;
  std::vector<std::string> columns() const;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  using filter = std::function<bool(const attempt&)>;

  std::size_t cheapest(double error, const filter& allowed) const;
  double best_seconds(std::size_t error, double floor) const;
  std::vector<std::vector<nlohmann::json>> best_of(league these, const std::string& label) const;
  std::string ratio(std::size_t index, std::size_t error, double floor) const;
  std::string time(std::size_t index) const;
  std::vector<double> floors() const;
  void choose();

  std::vector<double> errors_;
  std::string unit_;
  bool signs_;
  std::vector<attempt> attempts_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::size_t>> chosen_;  ///< index of the chosen run of every contestant
                                                  ///< for every error
};

}  // namespace apsis::bench::peers
