#include <apsis/study/convergence_plan.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/settings.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

using texts = std::vector<std::string>;
using kind = convergence_reference::kind;

class planner {
 public:
  explicit planner(const convergence_study& study)
      : study_(study), text_(study.case_text.empty() ? read_case(study.case_name) : study.case_text) {
    for (const auto& varied : study.vary) plan_.keys.push_back(varied.key);
  }

  convergence_plan make() {
    check_keys();
    resolve_grid();
    choose_refined();
    make_blocks();
    choose_reference();
    for (auto& block : plan_.blocks)
      for (std::size_t k = 0; k < block.rows.size(); ++k) plan_reference(block, k);
    return std::move(plan_);
  }

 private:
  /// One point of the grid.
  struct point {
    texts values, settings;
    std::size_t run;
  };

  void check_keys() const {
    if (study_.vary.empty())
      throw input_error("nothing is varied (a study has at least one varied key); give --vary key=v1,v2,...");
    double runs = 1.0;
    for (const auto& varied : study_.vary) {
      if (varied.values.empty())
        throw input_error(
            fmt::format("'{}' has no values (each value makes a run); list some", shown(varied.key)));
      if (std::count(plan_.keys.begin(), plan_.keys.end(), varied.key) > 1)
        throw input_error(fmt::format("'{}' is varied twice (a key has one list of values); join the lists",
                                      shown(varied.key)));
      for (const auto& item : study_.overrides)
        if (key_of(item) == varied.key)
          throw input_error(fmt::format(
              "'{}' is both varied and set to a value (one of them would be ignored); leave one out",
              shown(varied.key)));
      if (varied.key == "title" || varied.key.rfind("output.", 0) == 0)
        throw input_error(fmt::format(
            "'{}' cannot be varied (no number of a run depends on it); vary another key", shown(varied.key)));
      runs *= static_cast<double>(varied.values.size());
    }
    if (runs > static_cast<double>(convergence::most_runs))
      throw input_error(
          fmt::format("the combinations of all values make {:.0f} runs (at most {} are possible); vary fewer "
                      "keys at a time",
                      runs, convergence::most_runs));
  }

  case_config resolve(const texts& settings) const { return parse_case(text_, study_.case_name, settings); }

  /// Returns the index of the run with these settings. Plans the run if it is new.
  std::size_t run_of(const texts& settings) {
    case_config config = resolve(settings);
    const auto [place, is_new] = known_.emplace(numerical_identity(config), plan_.runs.size());
    if (is_new) {
      const run_setup setup(config);
      // Throws errors that would otherwise appear when the run begins: data that the mesh does not support,
      // and a step that is too short for the interval.
      setup.initial_state();
      time_marcher<double>(0.0, config.time.end, config.time.dt);
      plan_.work.push_back(work(config, setup));
      plan_.runs.push_back(std::move(config));
    }
    return place->second;
  }

  static double work(const case_config& config, const run_setup& setup) {
    const double step =
        config.time.dt
            ? *config.time.dt
            : (config.time.cfl ? *config.time.cfl : config.time.safety.value_or(1.0)) * setup.cfl_length();
    const double cells = setup.has_space() ? make_mesh(config).size() : 1.0;
    return config.time.end / step * cells * setup.equation->components() *
           static_cast<double>(setup.stages());
  }

  /// Resolves every combination of values; the last key varies fastest.
  void resolve_grid() {
    std::vector<std::size_t> index(study_.vary.size(), 0);
    for (bool more = true; more;) {
      point p;
      for (std::size_t k = 0; k < index.size(); ++k) {
        p.values.push_back(study_.vary[k].values[index[k]]);
        p.settings.push_back(study_.vary[k].key + "=" + p.values.back());
      }
      p.settings = layered(study_.overrides, p.settings);
      p.run = run_of(p.settings);
      for (const auto& other : grid_)
        if (other.run == p.run)
          throw input_error(fmt::format(
              "the values {} and {} of {} make the same run (each run is compared once); remove one of them",
              fmt::join(other.values, ", "), fmt::join(p.values, ", "), fmt::join(plan_.keys, ", ")));
      grid_.push_back(std::move(p));
      more = false;
      for (std::size_t k = index.size(); k-- > 0 && !more;) {
        more = ++index[k] < study_.vary[k].values.size();
        if (!more) index[k] = 0;
      }
    }
    plan_.title = config(grid_.front()).title;
  }

  const case_config& config(const point& p) const { return plan_.runs[p.run]; }

  void choose_refined() {
    const auto all_numbers = [this](const std::string& key) {
      return std::all_of(grid_.begin(), grid_.end(),
                         [&](const point& p) { return number_of(config(p), key) > 0.0; });
    };
    for (std::size_t k = 0; k < plan_.keys.size(); ++k)
      if (is_resolution_key(plan_.keys[k])) plan_.refined = static_cast<int>(k);
    resolves_ = plan_.refined >= 0;
    for (std::size_t k = 0; k < plan_.keys.size() && !resolves_; ++k)
      if (all_numbers(plan_.keys[k])) plan_.refined = static_cast<int>(k);
    if (plan_.refined < 0) return;
    plan_.h_name = resolution_name(refined_key());
    direction_ = refined_direction();
    plan_.refined_in_time = is_step_key(refined_key());
  }

  /// Returns the first direction in which runs have different numbers of the refined cells or velocities;
  /// otherwise 0.
  std::size_t refined_direction() const {
    const auto counts = [this](const point& p) -> std::vector<int> {
      if (refined_key() == "space.cells") return config(p).space.cells;
      if (refined_key() == "velocity.points") return config(p).velocity.points.each();
      return {};
    };
    const std::vector<int> first = counts(grid_.front());
    for (std::size_t k = 0; k < first.size(); ++k)
      for (const point& p : grid_)
        if (const std::vector<int> n = counts(p); n.size() == first.size() && n[k] != first[k]) return k;
    return 0;
  }

  const std::string& refined_key() const { return plan_.keys[static_cast<std::size_t>(plan_.refined)]; }

  void make_blocks() {
    std::map<texts, std::size_t> where;
    for (const point& p : grid_) {
      texts outer, named;
      for (std::size_t k = 0; k < plan_.keys.size(); ++k) {
        if (static_cast<int>(k) == plan_.refined) continue;
        outer.push_back(p.values[k]);
        named.push_back(fmt::format("{} = {}", plan_.keys[k], p.values[k]));
      }
      // Without a refined key all runs form one block.
      if (plan_.refined < 0) outer = named = {};
      const auto [place, is_new] = where.emplace(outer, plan_.blocks.size());
      if (is_new) {
        plan_.blocks.push_back({outer, fmt::format("{}", fmt::join(named, ", ")), {}});
      }
      const double h = plan_.refined < 0 ? std::numeric_limits<double>::quiet_NaN()
                                         : resolution(config(p), refined_key(), direction_);
      plan_.blocks[place->second].rows.push_back({p.values, p.run, -1, h});
      settings_of_[p.run] = p.settings;
    }
    if (plan_.refined < 0) return;
    for (auto& block : plan_.blocks)
      std::sort(block.rows.begin(), block.rows.end(),
                [](const auto& a, const auto& b) { return std::pair(-a.h, a.run) < std::pair(-b.h, b.run); });
  }

  bool all_exact() const {
    return std::all_of(grid_.begin(), grid_.end(),
                       [this](const point& p) { return run_setup(config(p)).has_exact_state(); });
  }

  void choose_reference() {
    reference_type_ = study_.reference.type;
    const std::string model = plan_.runs.front().model.name;
    const bool on_mesh = has_space(find_model(model));
    if (reference_type_ == kind::automatic) {
      reference_type_ = all_exact() ? kind::exact : kind::next;
      if (reference_type_ == kind::next && !resolves_)
        throw input_error(
            fmt::format("there is nothing to compare with (no mesh or step is refined, and model '{}' has no "
                        "exact solution); give --reference",
                        model));
    }
    if (reference_type_ == kind::exact && !all_exact())
      throw input_error(
          fmt::format("reference 'exact' does not exist (no exact solution of model '{}' is known for these "
                      "data); choose --reference next, time or METHOD@STEP",
                      model));
    if (reference_type_ == kind::next && (!resolves_ || refined_key() == "velocity.points"))
      throw input_error(
          "reference 'next' needs a finer run (no mesh or step is refined); vary space.cells or a step, or "
          "choose another reference");
    if (reference_type_ == kind::space_time && !on_mesh)
      throw input_error(
          fmt::format("reference 'space+time' needs a mesh (model '{}' has no space); choose time", model));
    plan_.measured = reference_type_ == kind::next ? "difference" : "error";
    plan_.measure = fmt::format("{} norm of the difference{} to {}", to_string(study_.norm),
                                study_.quantity.empty() ? "" : " of " + study_.quantity, reference_name());
  }

  std::string reference_name() const {
    switch (reference_type_) {
      case kind::exact:
        return "the exact solution";
      case kind::next:
        return "the next finer run";
      case kind::time:
        return "the same mesh and method with 1/8 of the smallest step";
      case kind::space_time:
        return "a run with three times the cells and a third of the step of the finest";
      default:
        return fmt::format("the run with {}", fmt::join(study_.reference.overrides, ", "));
    }
  }

  void plan_reference(convergence_plan::block& block, std::size_t k) {
    auto& row = block.rows[k];
    if (reference_type_ == kind::exact) {
      if (!study_.quantity.empty())
        check_comparable(plan_.runs[row.run], plan_.runs[row.run], study_.quantity);
      return;
    }
    const bool last = k + 1 == block.rows.size();
    const std::size_t reference =
        reference_type_ == kind::next && !last ? block.rows[k + 1].run : run_of(reference_settings(block, k));
    check_comparable(plan_.runs[row.run], plan_.runs[reference], study_.quantity);
    row.reference = static_cast<long>(reference);
  }

  texts reference_settings(const convergence_plan::block& block, std::size_t k) const {
    const texts& own = settings_of_.at(block.rows[k].run);
    if (reference_type_ == kind::given) return layered(own, study_.reference.overrides);
    if (reference_type_ == kind::next) return layered(own, {beyond(block)});
    // Rows of one refinement share the reference of the finest.
    const bool shared = reference_type_ == kind::time ? plan_.refined_in_time : resolves_;
    const std::size_t base = shared ? block.rows.back().run : block.rows[k].run;
    const case_config& from = plan_.runs[base];
    texts changes;
    if (reference_type_ == kind::time) {
      for (const auto& key : step_keys())
        if (const double value = number_of(from, key); value > 0.0)
          changes.push_back(fmt::format("{}={:.17g}", key, value / 8.0));
    } else {
      std::vector<double> cells;
      for (const int n : from.space.cells) cells.push_back(3.0 * n);
      changes.push_back(setting_of_cells(cells));
      if (from.time.dt) changes.push_back(fmt::format("time.dt={:.17g}", *from.time.dt / 3.0));
    }
    return layered(settings_of_.at(base), changes);
  }

  static std::string setting_of_cells(const std::vector<double>& cells) {
    return cells.size() == 1 ? fmt::format("space.cells={:.0f}", cells.front())
                             : fmt::format("space.cells=[{:.0f}]", fmt::join(cells, ","));
  }

  /// Returns the refined key one refinement beyond the finest run, by the last ratio (a factor 2 if
  /// there is only one run).
  std::string beyond(const convergence_plan::block& block) const {
    const auto run = [&](std::size_t from_end) -> const case_config& {
      return plan_.runs[block.rows[block.rows.size() - from_end].run];
    };
    const bool single = block.rows.size() < 2;
    if (refined_key() == "space.cells") {
      std::vector<double> cells;
      for (std::size_t k = 0; k < run(1).space.cells.size(); ++k) {
        const double finest = run(1).space.cells[k];
        cells.push_back(std::round(finest * (single ? 2.0 : finest / run(2).space.cells.at(k))));
      }
      return setting_of_cells(cells);
    }
    const auto value = [&](std::size_t from_end) { return number_of(run(from_end), refined_key()); };
    return fmt::format("{}={:.17g}", refined_key(), value(1) * (single ? 0.5 : value(1) / value(2)));
  }

  const convergence_study& study_;
  std::string text_;
  convergence_plan plan_;
  std::map<std::string, std::size_t> known_;  ///< numerical identity of a run → its index
  std::map<std::size_t, texts> settings_of_;  ///< settings of the runs of the grid
  std::vector<point> grid_;
  std::size_t direction_ = 0;  ///< direction of the refined length
  kind reference_type_ = kind::automatic;
  bool resolves_ = false;  ///< whether the refined key is a mesh or a step
};

}  // namespace

convergence_plan make_plan(const convergence_study& study) {
  return planner(study).make();
}

}  // namespace apsis
