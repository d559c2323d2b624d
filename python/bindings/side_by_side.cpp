#include "arrays.hpp"
#include "side_by_side.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include <boost/coroutine2/coroutine.hpp>
#include <boost/coroutine2/pooled_fixedsize_stack.hpp>

namespace apsis::python {
namespace {

using coroutine = boost::coroutines2::coroutine<void>;
using stack_pool = boost::coroutines2::pooled_fixedsize_stack;
using extents = std::vector<py::ssize_t>;

/// Most cells that are solved side by side, and most entries of their matrices: 16 MiB for each matrix of a
/// solve.
constexpr std::size_t most_slots = 256, most_entries = std::size_t{1} << 21;
/// Bytes of a stack, for solves whose vectors and matrices are on the heap. The system provides its pages on
/// first use.
constexpr std::size_t stack_bytes = std::size_t{256} << 10;

enum class cell_function { collision, product, curvature, admissible };

/// A function that a cell needs, with its arguments.
struct cell_call {
  cell_function function{};
  std::size_t arguments = 0;
  std::array<std::span<const double>, 3> in{};
  std::span<double> out;
};

/// Q of one cell (`differentiated`); every call waits until the functions have been called.
class waiting_field {
 public:
  waiting_field(cell_call& wanted, coroutine::push_type*& pause) : wanted_(&wanted), pause_(&pause) {}

  void value(std::span<const double> u, std::span<double> out) {
    wait({cell_function::collision, 1, {u}, out});
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) {
    wait({cell_function::product, 2, {u, x}, jx});
  }
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) {
    wait({cell_function::curvature, 3, {u, k, x}, hx});
  }
  bool is_admissible(std::span<const double> u) {
    double answer = 0.0;
    wait({cell_function::admissible, 1, {u}, {&answer, 1}});
    return answer != 0.0;
  }

 private:
  void wait(const cell_call& call) {
    *wanted_ = call;
    (**pause_)();
  }

  cell_call* wanted_;
  coroutine::push_type** pause_;
};

/// The array of the numbers first, first + 1, … of cells.
py::array indices_from(std::size_t first, std::size_t count) {
  std::vector<py::ssize_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), static_cast<py::ssize_t>(first));
  return py::array_t<py::ssize_t>(static_cast<py::ssize_t>(count), numbers.data());
}

}  // namespace

/// A cell whose stage is being solved.
class collisions_side_by_side::slot {
 public:
  slot(bool limited, linear_solver solver)
      : problem_({}, waiting_field(wanted_, pause_),
                 newton_options{.solver = solver, .warns_of_cost = false}) {
    if (limited)
      problem_.with_admissible([field = waiting_field(wanted_, pause_)](std::span<const double> v) mutable {
        return field.is_admissible(v);
      });
  }
  slot(const slot&) = delete;
  slot& operator=(const slot&) = delete;

  /// Begins to solve the stage of a cell from u, up to the first function that it needs.
  void begin(std::size_t cell, std::span<const double> u, double t, double a, double b, stack_pool stack) {
    cell_ = cell;
    u_.assign(u.begin(), u.end());
    failure_.reset();
    run_.emplace(stack, [this, t, a, b](coroutine::push_type& pause) {
      pause_ = &pause;
      try {
        problem_.solve_collision(t, a, b, u_);
      } catch (const numerical_error& failure) {
        failure_site site = failure.site();
        site.cell = static_cast<long>(cell_);
        failure_.emplace(failure.problem(), site);
      }
    });
  }
  bool waits() const { return run_.has_value() && static_cast<bool>(*run_); }
  const cell_call& wanted() const { return wanted_; }
  void go_on() { (*run_)(); }
  void stop() { run_.reset(); }
  std::size_t cell() const { return cell_; }
  /// The solution. Throws numerical_error if there is none.
  const std::vector<double>& solution() const {
    if (failure_) throw numerical_error(*failure_);
    return u_;
  }

 private:
  cell_call wanted_;
  coroutine::push_type* pause_ = nullptr;
  std::size_t cell_ = 0;
  std::vector<double> u_;
  std::optional<numerical_error> failure_;
  newton_problem<no_transport, waiting_field> problem_;
  std::optional<coroutine::pull_type> run_;  // ends before all that it uses
};

struct collisions_side_by_side::stacks {
  stack_pool all{stack_bytes};
};

collisions_side_by_side::collisions_side_by_side(const collision_functions& of, std::size_t length,
                                                 linear_solver solver)
    : of_(of), length_(length), stacks_(std::make_unique<stacks>()) {
  // Each slot would warn of the cost of large cells.
  const std::size_t slots = length > most_unknowns_of_newton
                                ? 1
                                : std::clamp(most_entries / (length * length), std::size_t{1}, most_slots);
  for (std::size_t k = 0; k < slots; ++k)
    slots_.push_back(std::make_unique<slot>(of.admissible.has_value(), solver));
}

collisions_side_by_side::~collisions_side_by_side() = default;

void collisions_side_by_side::evaluate(const std::vector<double>& u, std::vector<double>& rate) const {
  const std::size_t cells = u.size() / length_;
  const extents shape = {static_cast<py::ssize_t>(cells), static_cast<py::ssize_t>(length_)};
  rate.resize(u.size());
  of_.collision.numbers(of_.collision(to_fixed_array(u, shape), indices_from(0, cells)), shape, rate);
}

bool collisions_side_by_side::are_admissible(const std::vector<double>& u) const {
  if (!of_.admissible) return true;
  const std::size_t cells = u.size() / length_;
  const extents shape = {static_cast<py::ssize_t>(cells), static_cast<py::ssize_t>(length_)};
  std::vector<double> answers(cells);
  of_.admissible->numbers((*of_.admissible)(to_fixed_array(u, shape), indices_from(0, cells)), {shape[0]},
                          answers);
  return std::all_of(answers.begin(), answers.end(), [](double answer) { return answer != 0.0; });
}

void collisions_side_by_side::solve(double t, double a, double b, std::vector<double>& u) {
  std::vector<double> solved = u;
  const std::size_t cells = u.size() / length_;
  for (std::size_t first = 0; first < cells; first += slots_.size())
    solve_cells(first, std::min(slots_.size(), cells - first), t, a, b, solved);
  u.swap(solved);
}

void collisions_side_by_side::solve_cells(std::size_t first, std::size_t count, double t, double a, double b,
                                          std::vector<double>& u) {
  // An exception of a function ends all solves, whose stacks are then unwound.
  const auto stop = [](collisions_side_by_side* all) {
    for (const auto& one : all->slots_) one->stop();
  };
  const std::unique_ptr<collisions_side_by_side, decltype(stop)> stopped_at_the_end(this, stop);
  for (std::size_t k = 0; k < count; ++k)
    slots_[k]->begin(first + k, std::span(u).subspan((first + k) * length_, length_), t, a, b, stacks_->all);
  std::vector<slot*> waiting;
  for (;;) {
    waiting.clear();
    for (std::size_t k = 0; k < count; ++k)
      if (slots_[k]->waits()) waiting.push_back(slots_[k].get());
    if (waiting.empty()) break;
    answer(waiting);
    for (slot* const one : waiting) one->go_on();
  }
  for (std::size_t k = 0; k < count; ++k)
    std::copy_n(slots_[k]->solution().begin(), length_,
                u.begin() + static_cast<std::ptrdiff_t>((first + k) * length_));
}

/// Calls each function once for all cells that wait for it.
void collisions_side_by_side::answer(const std::vector<slot*>& waiting) const {
  const auto call = [&](cell_function which, const callback& function) {
    std::vector<const slot*> these;
    for (const slot* one : waiting)
      if (one->wanted().function == which) these.push_back(one);
    if (these.empty()) return;
    const auto rows = static_cast<py::ssize_t>(these.size());
    const extents shape = {rows, static_cast<py::ssize_t>(length_)};
    py::array_t<py::ssize_t> cells(rows);
    for (std::size_t k = 0; k < these.size(); ++k)
      cells.mutable_data()[k] = static_cast<py::ssize_t>(these[k]->cell());
    py::list arguments;
    std::vector<double> numbers(these.size() * length_);
    for (std::size_t i = 0; i < these.front()->wanted().arguments; ++i) {
      for (std::size_t k = 0; k < these.size(); ++k)
        std::ranges::copy(these[k]->wanted().in[i],
                          numbers.begin() + static_cast<std::ptrdiff_t>(k * length_));
      arguments.append(to_fixed_array(numbers, shape));
    }
    arguments.append(cells);
    const std::size_t length = these.front()->wanted().out.size();
    numbers.resize(these.size() * length);
    function.numbers(function(*py::tuple(arguments)),
                     which == cell_function::admissible ? extents{rows} : shape, numbers);
    for (std::size_t k = 0; k < these.size(); ++k)
      std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k * length), length,
                  these[k]->wanted().out.data());
  };
  call(cell_function::collision, of_.collision);
  call(cell_function::product, of_.product);
  call(cell_function::curvature, of_.curvature);
  if (of_.admissible) call(cell_function::admissible, *of_.admissible);
}

}  // namespace apsis::python
