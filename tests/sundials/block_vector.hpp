// A vector that a program defines itself: a list of blocks. It has the operations that Apsis needs alone, and
// no array to point into.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <sundials/support.hpp>

namespace sundials_test {

/// Numbers, and the next block.
struct block {
  std::vector<double> numbers;
  std::unique_ptr<block> next{};
};

/// The content of the vector. If `copies_operations` is false, a clone has the operations of a new vector
/// instead of those of its origin.
struct block_list {
  std::unique_ptr<block> first{};
  bool copies_operations = true;
};

inline block_list& list_of(N_Vector v) {
  return *static_cast<block_list*>(v->content);
}

template <class Apply, class... Blocks>
void walk(const Apply& apply, block* first, Blocks*... rest) {
  while (first != nullptr) {
    apply(first->numbers, rest->numbers...);
    first = first->next.get();
    ((rest = rest->next.get()), ...);
  }
}

/// Calls apply(a, b, …) for each block of the vectors.
template <class Apply, class... More>
void for_blocks(const Apply& apply, N_Vector v, More... more) {
  walk(apply, list_of(v).first.get(), list_of(more).first.get()...);
}

/// Sets z_i ← apply(x_i, y_i, …).
template <class Apply, class... Inputs>
void set_each(N_Vector z, const Apply& apply, Inputs... inputs) {
  for_blocks(
      [&](std::vector<double>& to, const auto&... from) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = apply(from[i]...);
      },
      z, inputs...);
}

struct block_operations {
  static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    // Compilers may fuse a product and a sum. The serial vector therefore computes these numbers.
    for_blocks(
        [=](std::vector<double>& of_x, std::vector<double>& of_y, std::vector<double>& of_z) {
          const auto view = [](std::vector<double>& all) {
            return owned(N_VMake_Serial(static_cast<sunindextype>(all.size()), all.data(), context()));
          };
          N_VLinearSum(a, view(of_x).get(), b, view(of_y).get(), view(of_z).get());
        },
        x, y, z);
  }
  static void constant(double c, N_Vector z) {
    set_each(z, [c] { return c; });
  }
  static void product(N_Vector x, N_Vector y, N_Vector z) {
    set_each(z, [](double a, double b) { return a * b; }, x, y);
  }
  static void quotient(N_Vector x, N_Vector y, N_Vector z) {
    set_each(z, [](double a, double b) { return a / b; }, x, y);
  }
  static void scale(double c, N_Vector x, N_Vector z) {
    set_each(z, [c](double a) { return c * a; }, x);
  }
  static void absolute(N_Vector x, N_Vector z) {
    set_each(z, [](double a) { return std::abs(a); }, x);
  }
  static void inverse(N_Vector x, N_Vector z) {
    set_each(z, [](double a) { return 1.0 / a; }, x);
  }
  static void add(N_Vector x, double c, N_Vector z) {
    set_each(z, [c](double a) { return a + c; }, x);
  }
  /// Adds blocks from the last to the first, in another order than the serial vector.
  static double dot_of(const block* x, const block* y) {
    if (x == nullptr) return 0.0;
    const double rest = dot_of(x->next.get(), y->next.get());
    double own = 0.0;
    for (std::size_t i = 0; i < x->numbers.size(); ++i) own += x->numbers[i] * y->numbers[i];
    return rest + own;
  }
  static double dot(N_Vector x, N_Vector y) { return dot_of(list_of(x).first.get(), list_of(y).first.get()); }
  static double largest(N_Vector x) {
    double found = 0.0;
    for_blocks(
        [&](const auto& all) {
          for (const double a : all) found = std::max(found, std::abs(a));
        },
        x);
    return found;
  }
  static double sum_of_absolutes(N_Vector x) {
    double sum = 0.0;
    for_blocks(
        [&](const auto& all) {
          for (const double a : all) sum += std::abs(a);
        },
        x);
    return sum;
  }
  static sunindextype length(N_Vector x) {
    std::size_t n = 0;
    for_blocks([&](const auto& all) { n += all.size(); }, x);
    return static_cast<sunindextype>(n);
  }
  static N_Vector make() {
    N_Vector made = N_VNewEmpty(context());
    made->content = new block_list;
    N_Vector_Ops ops = made->ops;
    ops->nvclone = clone;
    ops->nvdestroy = destroy;
    ops->nvgetlength = length;
    ops->nvlinearsum = linear_sum;
    ops->nvconst = constant;
    ops->nvprod = product;
    ops->nvdiv = quotient;
    ops->nvscale = scale;
    ops->nvabs = absolute;
    ops->nvinv = inverse;
    ops->nvaddconst = add;
    ops->nvdotprod = dot;
    ops->nvmaxnorm = largest;
    ops->nvl1norm = sum_of_absolutes;
    return made;
  }
  static N_Vector clone(N_Vector from) {
    N_Vector made = make();
    list_of(made).copies_operations = list_of(from).copies_operations;
    if (list_of(from).copies_operations) N_VCopyOps(from, made);
    std::unique_ptr<block>* at = &list_of(made).first;
    for (const block* one = list_of(from).first.get(); one != nullptr; one = one->next.get()) {
      *at = std::make_unique<block>();
      (*at)->numbers.resize(one->numbers.size());
      at = &(*at)->next;
    }
    return made;
  }
  static void destroy(N_Vector v) {
    delete &list_of(v);
    N_VFreeEmpty(v);
  }
};

/// Returns a vector with blocks of 1, 2, …, 7, 1, 2, … numbers.
inline vector blocks_of(const std::vector<double>& values, bool copies_operations = true) {
  auto made = owned(block_operations::make());
  list_of(made.get()).copies_operations = copies_operations;
  std::unique_ptr<block>* at = &list_of(made.get()).first;
  for (std::size_t begin = 0, size = 1; begin < values.size(); begin += size, size = size % 7 + 1) {
    const auto end = std::min(begin + size, values.size());
    *at = std::make_unique<block>();
    for (std::size_t i = begin; i < end; ++i) (*at)->numbers.push_back(values[i]);
    at = &(*at)->next;
  }
  return made;
}

}  // namespace sundials_test
