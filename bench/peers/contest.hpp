#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis::bench::peers {

/// What one integration cost and gave.
struct outcome {
  double seconds = 0.0;         ///< CPU time of the steps, without what looks at them
  double error = 0.0;           ///< at the end
  double smallest = 0.0;        ///< of the unknowns, after any step
  double smallest_final = 0.0;  ///< at the end
  long steps = 0;
  std::string failure = {};  ///< empty where the end was reached
};

/// One point of a work–precision diagram: a contestant with one step length or tolerance.
struct attempt {
  std::string contestant, setting;
  bool ours = false;
  std::function<outcome()> run;
  outcome seen = {};
  bool counts = false;  ///< the cheapest of some kind for some error
};

/// Who reaches an error with how much work. Of the runs of a contestant that reach an error, the cheapest
/// counts, with whatever setting: no interpolation.
class contest {
 public:
  enum class rule {
    nonnegative,  ///< runs of Apsis count where no unknown was ever negative, those of others always; signs
                  ///< are shown
    any_sign      ///< all count
  };

  explicit contest(std::vector<double> errors, rule how = rule::nonnegative)
      : errors_(std::move(errors)), rule_(how) {}

  void add(attempt one) { attempts_.push_back(std::move(one)); }

  /// Every attempt once, then those that count again in turns, `repeats` times, where that takes less than
  /// `seconds_each` a time; their CPU time is then the median.
  void run(int repeats, double seconds_each);

  /// After run(): a row for each contestant, for every error the CPU time, in brackets relative to the best
  /// of Apsis, and the smallest unknown.
  std::vector<std::vector<nlohmann::json>> rows() const;
  /// After run(): for every error the best of the others, relative to the best of Apsis, and its name; a row
  /// each for those that stay nonnegative, those that do up to rounding, and all.
  std::vector<std::vector<nlohmann::json>> best_of_others() const;
  /// All runs, for diagrams.
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
  std::vector<std::vector<std::size_t>> chosen_;  ///< of every contestant for every error
};

}  // namespace apsis::bench::peers
