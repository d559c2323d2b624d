#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis::bench::peers {

/// Cost and accuracy of one integration.
struct outcome {
  double seconds = 0.0;         ///< CPU time of the steps, without monitoring
  double error = 0.0;           ///< at the end time
  double smallest = 0.0;        ///< smallest unknown after any step
  double smallest_final = 0.0;  ///< at the end
  long steps = 0;
  std::string failure = {};  ///< empty if the end time was reached
};

/// A point of a work–precision diagram: a contestant with a given step length or tolerance.
struct attempt {
  std::string contestant, setting;
  bool ours = false;
  std::function<outcome()> run;
  outcome measured = {};
  bool counts = false;  ///< whether it is the cheapest of its kind for some error
};

/// Work needed by each contestant to reach an error: that of the cheapest run that reaches it, whatever its
/// setting, without interpolation.
class contest {
 public:
  enum class rule {
    nonnegative,  ///< runs of Apsis count if no unknown was ever negative, those of others always;
                  ///< signs are shown
    any_sign      ///< all runs count
  };

  explicit contest(std::vector<double> errors, rule which = rule::nonnegative)
      : errors_(std::move(errors)), rule_(which) {}

  void add(attempt one) { attempts_.push_back(std::move(one)); }

  /// Runs every attempt once, and then those that count in turns, `repeats` times, if that takes less than
  /// `seconds_each` per turn; their CPU time is then the median.
  void run(int repeats, double seconds_each);

  /// After run(), returns a row for each contestant: for every error the CPU time, in brackets relative to
  /// the best of Apsis, and the smallest unknown.
  std::vector<std::vector<nlohmann::json>> rows() const;
  /// After run(), returns for every error the best of the others, relative to the best of Apsis, and its
  /// name; one row each for those that stay nonnegative, those that do up to rounding, and all.
  std::vector<std::vector<nlohmann::json>> best_of_others() const;
  /// Returns all runs, for diagrams.
  nlohmann::json points() const;
  std::vector<std::string> columns() const;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  bool reaches(const attempt& one, double error) const;
  std::size_t cheapest(double error, const std::function<bool(const attempt&)>& allowed) const;
  double best_seconds(std::size_t error) const;
  std::string ratio(std::size_t index, std::size_t error) const;
  std::string time(std::size_t index) const;
  void choose();

  std::vector<double> errors_;
  rule rule_;
  std::vector<attempt> attempts_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::size_t>> chosen_;  ///< index of the chosen run of every contestant
                                                  ///< for every error
};

}  // namespace apsis::bench::peers
