#include <apsis/study/convergence.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/study/convergence_plan.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace apsis {

struct convergence::impl {
  convergence_study study;
  convergence_plan plan;
  std::vector<std::optional<outcome>> results = {};  ///< results by run
  std::vector<std::string> failures = {};            ///< failures by run; "" without one

  convergence_row row_of(const convergence_plan::row& planned) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    convergence_row row;
    row.values = planned.values;
    row.config = plan.runs[planned.run];
    row.h = planned.h;
    row.error = row.rate = row.min_value = none;
    const auto& result = results[planned.run];
    if (!result) {
      row.problem = failures[planned.run];
      return row;
    }
    const run_summary& done = result->summary;
    if (plan.refined_in_time && done.steps > 0) row.h = done.dt;
    row.steps = done.steps;
    row.dt = done.dt;
    row.wall_s = done.wall_s;
    row.cpu_s = done.cpu_s;
    row.min_value = done.min_value;
    measure(planned, *result, row);
    return row;
  }

  void measure(const convergence_plan::row& planned, const outcome& result, convergence_row& row) const {
    const auto other = static_cast<std::size_t>(planned.reference);
    if (planned.reference < 0) {
      row.error = difference_norm(result, result.exact, study.norm, study.quantity);
    } else if (results[other]) {
      row.error = difference_norm(result, *results[other], study.norm, study.quantity);
    } else {
      row.problem = failures[other].empty() ? "its reference was not computed"
                                            : fmt::format("its reference failed: {}", failures[other]);
    }
    if (row.problem.empty() && !std::isfinite(row.error)) row.problem = "the result is not finite";
  }

  bool is_done(const convergence_plan::row& planned) const {
    return results[planned.run] || !failures[planned.run].empty();
  }
};

namespace {

void add_rates(convergence_block& block) {
  for (std::size_t k = 1; k < block.rows.size(); ++k) {
    const auto &before = block.rows[k - 1], &now = block.rows[k];
    const double rate = std::log(before.error / now.error) / std::log(before.h / now.h);
    if (std::isfinite(rate)) block.rows[k].rate = rate;
  }
}

}  // namespace

long convergence_table::failures() const {
  long count = 0;
  for (const auto& block : blocks)
    count +=
        std::count_if(block.rows.begin(), block.rows.end(), [](const auto& r) { return !r.problem.empty(); });
  return count;
}

convergence::convergence(convergence_study study) : impl_(std::make_unique<impl>()) {
  impl_->study = std::move(study);
  impl_->plan = make_plan(impl_->study);
  impl_->results.resize(impl_->plan.runs.size());
  impl_->failures.resize(impl_->plan.runs.size());
}
convergence::~convergence() = default;
convergence::convergence(convergence&&) noexcept = default;
convergence& convergence::operator=(convergence&&) noexcept = default;

void convergence::run(const study_control& control) {
  impl& all = *impl_;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < all.plan.runs.size(); ++k)
    if (!all.results[k] && all.failures[k].empty()) order.push_back(k);
  const auto& work = all.plan.work;
  std::sort(order.begin(), order.end(),
            [&work](auto a, auto b) { return std::pair(-work[a], a) < std::pair(-work[b], b); });
  const double total = std::accumulate(order.begin(), order.end(), 0.0,
                                       [&work](double sum, std::size_t k) { return sum + work[k]; });
  std::atomic<double> done = 0.0;
  study_control by_work = control;
  if (control.progress)
    by_work.progress = [&](double part, const std::string& what) {
      control.progress(total > 0.0 && std::isfinite(total) ? done.load() / total : part, what);
    };
  study_control stop_only;
  stop_only.stop = control.stop;
  run_all(by_work, fmt::format("{} runs", order.size()), static_cast<int>(order.size()), [&](int job) {
    const std::size_t k = order[static_cast<std::size_t>(job)];
    try {
      all.results[k] = compute_outcome(all.plan.runs[k], stop_only);
    } catch (const numerical_error& failure) {
      all.failures[k] = failure.what();
    }
    done.fetch_add(work[k]);
  });
}

long convergence::finished_runs() const {
  long count = 0;
  for (std::size_t k = 0; k < impl_->plan.runs.size(); ++k)
    if (impl_->results[k] || !impl_->failures[k].empty()) ++count;
  return count;
}

convergence_table convergence::table() const {
  const convergence_plan& plan = impl_->plan;
  convergence_table table;
  table.title = plan.title;
  table.keys = plan.keys;
  table.refined = plan.refined;
  table.h_name = plan.h_name;
  table.measure = plan.measure;
  table.measured = plan.measured;
  table.runs = static_cast<long>(plan.runs.size());
  for (const auto& planned : plan.blocks) {
    convergence_block block{planned.values, planned.title, {}};
    for (const auto& row : planned.rows) {
      if (impl_->is_done(row))
        block.rows.push_back(impl_->row_of(row));
      else
        table.complete = false;
    }
    if (plan.refined >= 0) add_rates(block);
    if (!block.rows.empty()) table.blocks.push_back(std::move(block));
  }
  for (std::size_t k = 0; k < plan.runs.size(); ++k)
    table.complete = table.complete && (impl_->results[k] || !impl_->failures[k].empty());
  return table;
}

convergence_table converge(const convergence_study& study, const study_control& control) {
  convergence all(study);
  all.run(control);
  return all.table();
}

}  // namespace apsis
