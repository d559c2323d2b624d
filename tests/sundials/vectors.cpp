// Vectors of other kinds than the serial one: a list of blocks with operations of the program, and the
// ManyVector of SUNDIALS. Callbacks copy their numbers, so that only operations of vectors differ.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nvector/nvector_manyvector.h>
#include <sundials/block_vector.hpp>
#include <sundials/line.hpp>
#include <sundials/support.hpp>

namespace sundials_vectors_test {

namespace {

using namespace sundials_test;
using line_test::line;

/// Calls f for all numbers of a vector in their order.
void for_numbers(N_Vector v, const std::function<void(double&)>& f) {
  if (v->ops->nvgetlength == block_operations::length) {
    for_blocks(
        [&](auto& all) {
          for (double& a : all) f(a);
        },
        v);
  } else if (N_VGetVectorID(v) == SUNDIALS_NVEC_MANYVECTOR) {
    for (sunindextype k = 0; k < N_VGetNumSubvectors_ManyVector(v); ++k)
      for_numbers(N_VGetSubvector_ManyVector(v, k), f);
  } else {
    for (sunindextype i = 0; i < N_VGetLength(v); ++i) f(N_VGetArrayPointer(v)[i]);
  }
}

std::vector<double> read(N_Vector v) {
  std::vector<double> all;
  for_numbers(v, [&](double& a) { all.push_back(a); });
  return all;
}

void write(N_Vector from, N_Vector to) {
  const double* next = N_VGetArrayPointer(from);
  for_numbers(to, [&](double& a) { a = *next++; });
}

/// A vector with the subvectors that it consists of.
struct any_vector {
  std::vector<vector> parts{};
  vector whole{nullptr, N_VDestroy};
};

any_vector serial_vector(const std::vector<double>& values) {
  return {{}, serial(values)};
}

any_vector block_vector(const std::vector<double>& values) {
  return {{}, blocks_of(values)};
}

/// Three subvectors; the second consists of blocks.
any_vector many_vector(const std::vector<double>& values) {
  any_vector made;
  const auto at = [&](std::size_t share) {
    return values.begin() + std::ptrdiff_t(values.size() * share / 7);
  };
  made.parts.push_back(serial({at(0), at(1)}));
  made.parts.push_back(blocks_of({at(1), at(4)}));
  made.parts.push_back(serial({at(4), at(7)}));
  N_Vector all[] = {made.parts[0].get(), made.parts[1].get(), made.parts[2].get()};
  made.whole = owned(N_VNew_ManyVector(3, all, context()));
  return made;
}

/// Returns callback(serial copies of the inputs), and copies the result to `out`.
template <class Callback>
int on_copies(N_Vector out, const std::vector<N_Vector>& inputs, const Callback& callback) {
  std::vector<vector> copies;
  std::transform(inputs.begin(), inputs.end(), std::back_inserter(copies),
                 [](N_Vector one) { return serial(read(one)); });
  const auto result = serial(read(out));
  const int returned = callback(result.get(), copies);
  write(result.get(), out);
  return returned;
}

int transport(double t, N_Vector y, N_Vector out, void* data) {
  return on_copies(out, {y}, [=](N_Vector to, const auto& from) {
    return line_test::transport(t, from[0].get(), to, data);
  });
}
int collision(double t, N_Vector y, N_Vector out, void* data) {
  return on_copies(out, {y}, [=](N_Vector to, const auto& from) {
    return line_test::collision(t, from[0].get(), to, data);
  });
}
int product(N_Vector x, N_Vector jx, double t, N_Vector y, N_Vector, void* data, N_Vector) {
  return on_copies(jx, {x, y}, [=](N_Vector to, const auto& from) {
    return line_test::product(from[0].get(), to, t, from[1].get(), nullptr, data, nullptr);
  });
}
int precondition_setup(double t, N_Vector y, N_Vector, int old, int* current, double gamma, void* data) {
  return line_test::precondition_setup(t, serial(read(y)).get(), nullptr, old, current, gamma, data);
}
int precondition(double t, N_Vector, N_Vector, N_Vector r, N_Vector z, double gamma, double delta, int side,
                 void* data) {
  return on_copies(z, {r}, [=](N_Vector to, const auto& from) {
    return line_test::precondition(t, nullptr, nullptr, from[0].get(), to, gamma, delta, side, data);
  });
}

line stiff_line(double epsilon) {
  return {.cells = 25, .begin = 0, .end = 25, .diffusion = 0.01, .epsilon = epsilon};
}

std::vector<double> start_values(const line& of) {
  const auto y = serial(std::vector<double>(2 * of.own()));
  line_test::start(of, y.get());
  return values(y.get());
}

struct task {
  const char* method;
  double epsilon;
  bool preconditioned;
};

integrator make_integrator(const task& of, line& data, N_Vector y) {
  auto s = make(of.method, transport, collision, 0.0, y, &data);
  if (of.preconditioned) {
    expect_ok(apsis_sundials_set_products(s.get(), nullptr, product));
    expect_ok(apsis_sundials_set_preconditioner(s.get(), precondition_setup, precondition));
  }
  return s;
}

/// Returns the state at the end and inside the last step, and all counters.
template <class Make>
std::vector<double> integrate(const task& of, const Make& make_vector) {
  line data = stiff_line(of.epsilon);
  const any_vector y = make_vector(start_values(data));
  const auto s = make_integrator(of, data, y.whole.get());
  expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-3, 1e-4));
  expect_ok(apsis_sundials_evolve(s.get(), 0.03, y.whole.get(), nullptr));
  auto all = read(y.whole.get());
  expect_ok(apsis_sundials_state_at(s.get(), 0.03 - 1e-4, y.whole.get()));
  const auto inside = read(y.whole.get());
  all.insert(all.end(), inside.begin(), inside.end());
  for (int k = 0; k <= APSIS_SUNDIALS_EVENTS; ++k)
    all.push_back(static_cast<double>(apsis_sundials_count(s.get(), k)));
  return all;
}

constexpr task tasks[] = {{"md-imex-5-2", 1e-4, true}, {"ark-436", 1.0, true}, {"md-imex-3-2", 1.0, false}};

/// Expects that `call` is refused because the vectors lack an operation.
void expect_missing(const char* operation, const char* needed_by, const std::function<int()>& call) {
  EXPECT_EQ(call(), APSIS_INPUT_ERROR) << operation;
  const std::string expected =
      "the vectors have no operation '" + std::string(operation) + "' (" + needed_by + ")";
  EXPECT_EQ(std::string(apsis_error_message()).find(expected), 0u) << apsis_error_message();
}

}  // namespace

TEST(sundials_vectors, of_the_program_have_the_bits_of_serial_vectors) {
  for (const task& one : tasks)
    EXPECT_EQ(integrate(one, block_vector), integrate(one, serial_vector)) << one.method;
}

TEST(sundials_vectors, that_consist_of_others_have_the_bits_of_serial_vectors) {
  for (const task& one : tasks)
    EXPECT_EQ(integrate(one, many_vector), integrate(one, serial_vector)) << one.method;
}

TEST(sundials_vectors, of_other_kinds_have_sums_of_their_own) {
  // If the sums agreed, equal bits would prove nothing.
  std::vector<double> x, ones;
  for (int i = 0; i < 50; ++i) {
    x.push_back(std::sin(i) * std::pow(10.0, i % 7));
    ones.push_back(1.0);
  }
  const double expected = N_VDotProd(serial(x).get(), serial(ones).get());
  EXPECT_NE(N_VDotProd(blocks_of(x).get(), blocks_of(ones).get()), expected);
  EXPECT_NE(N_VDotProd(many_vector(x).whole.get(), many_vector(ones).whole.get()), expected);
}

// GMRES clones its vectors. Clones with operations of their own bring back the sums of the program, which
// differ by rounding. These differences enter the directions of GMRES, and stages to a part of the tolerance.
TEST(sundials_vectors, whose_clones_do_not_copy_operations_agree_to_the_tolerance_of_stages) {
  const auto anew = [](const std::vector<double>& values) {
    return any_vector{{}, blocks_of(values, false)};
  };
  for (const task& one : tasks) {
    const auto found = integrate(one, anew), expected = integrate(one, serial_vector);
    ASSERT_EQ(found.size(), expected.size());
    const std::size_t n = 4 * stiff_line(1.0).own();
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], expected[i], 1e-5) << one.method;
  }
}

TEST(sundials_vectors, without_an_operation_are_refused_with_its_name) {
  const std::pair<const char*, std::function<void(N_Vector_Ops)>> operations[] = {
      {"nvclone", [](auto ops) { ops->nvclone = nullptr; }},
      {"nvdestroy", [](auto ops) { ops->nvdestroy = nullptr; }},
      {"nvgetlength", [](auto ops) { ops->nvgetlength = nullptr; }},
      {"nvlinearsum", [](auto ops) { ops->nvlinearsum = nullptr; }},
      {"nvconst", [](auto ops) { ops->nvconst = nullptr; }},
      {"nvprod", [](auto ops) { ops->nvprod = nullptr; }},
      {"nvscale", [](auto ops) { ops->nvscale = nullptr; }},
      {"nvabs", [](auto ops) { ops->nvabs = nullptr; }},
      {"nvinv", [](auto ops) { ops->nvinv = nullptr; }},
      {"nvaddconst", [](auto ops) { ops->nvaddconst = nullptr; }},
      {"nvdotprod", [](auto ops) { ops->nvdotprod = nullptr; }},
      {"nvmaxnorm", [](auto ops) { ops->nvmaxnorm = nullptr; }},
      {"nvl1norm", [](auto ops) { ops->nvl1norm = nullptr; }}};
  const auto m = find("md-imex-5-2");
  for (const auto& [name, remove] : operations) {
    const auto y = blocks_of({1, 2});
    const auto complete = *y->ops;
    remove(y->ops);
    apsis_sundials* made = nullptr;
    expect_missing(name, "integrations call it", [&] {
      return apsis_sundials_create(m.get(), transport, collision, 0.0, y.get(), context(), &made);
    });
    EXPECT_EQ(made, nullptr);
    EXPECT_EQ(apsis_sundials_clone(y.get()), nullptr);
    *y->ops = complete;  // the operation that destroys the vector
  }
}

TEST(sundials_vectors, without_an_operation_of_a_setting_are_refused_by_the_setting) {
  line data = stiff_line(1.0);
  const auto y = blocks_of(start_values(data));
  const auto s = make_integrator(tasks[0], data, y.get());
  expect_missing("nvconstrmask", "constraints call it",
                 [&] { return apsis_sundials_set_constraints(s.get(), y.get()); });
  expect_ok(apsis_sundials_set_constraints(s.get(), nullptr));
  expect_missing("nvmin", "tolerances of unknowns call it",
                 [&] { return apsis_sundials_set_tolerances(s.get(), 1e-3, y.get()); });
}

TEST(sundials_vectors, without_division_have_no_gmres) {
  line data = stiff_line(1.0);
  const auto y = blocks_of(start_values(data));
  y->ops->nvdiv = nullptr;
  auto s = make_integrator(tasks[0], data, y.get());
  expect_ok(apsis_sundials_set_step(s.get(), 0.01));
  expect_missing("nvdiv", "GMRES calls it",
                 [&] { return apsis_sundials_evolve(s.get(), 0.02, nullptr, nullptr); });
  // A problem without Newton's method does not need it.
  s = make("ssprk-3-3", transport, nullptr, 0.0, y.get(), &data);
  expect_ok(apsis_sundials_set_step(s.get(), 0.01));
  expect_ok(apsis_sundials_evolve(s.get(), 0.02, nullptr, nullptr));
}

}  // namespace sundials_vectors_test
