#include "internal/equal_sums.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <vector>

namespace apsis::sundials {
namespace {

using dot_product = sunrealtype (*)(N_Vector, N_Vector);
using clone = N_Vector (*)(N_Vector);

/// The original scalar product of each type of vectors. The operation nvclone identifies the type.
class replaced_products {
 public:
  void add(N_Vector v) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& one : known_)
      if (one.of == v->ops->nvclone) return;
    known_.push_back({v->ops->nvclone, v->ops->nvdotprod});
  }
  dot_product of(N_Vector v) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& one : known_)
      if (one.of == v->ops->nvclone) return one.product;
    return nullptr;
  }

 private:
  struct entry {
    clone of;
    dot_product product;
  };
  std::mutex mutex_;
  std::vector<entry> known_;
};

replaced_products& replaced() {
  static replaced_products all;
  return all;
}

/// Work vectors of this thread, see sums_without_allocation.
thread_local std::array<N_Vector, 3> kept{};

/// Three vectors like v: those of sums_without_allocation, or new ones. The elements of the last are 1.
class work_vectors {
 public:
  explicit work_vectors(N_Vector v) : owned_(kept[0] == nullptr || kept[0]->ops->nvclone != v->ops->nvclone) {
    if (!owned_) {
      at_ = kept;
      return;
    }
    for (N_Vector& one : at_) {
      one = N_VClone(v);
      if (one == nullptr) {
        release();
        throw std::bad_alloc();
      }
    }
    N_VConst(1.0, at_[2]);
  }
  ~work_vectors() { release(); }
  work_vectors(const work_vectors&) = delete;
  work_vectors& operator=(const work_vectors&) = delete;
  N_Vector terms() const { return at_[0]; }
  N_Vector part() const { return at_[1]; }
  N_Vector ones() const { return at_[2]; }

 private:
  void release() {
    for (N_Vector one : at_)
      if (owned_ && one != nullptr) N_VDestroy(one);
  }

  bool owned_;
  std::array<N_Vector, 3> at_{};
};

/// Returns the sum of the elements of work.terms(), which are overwritten.
double sum_of_terms(const work_vectors& work, dot_product original) {
  N_Vector terms = work.terms(), part = work.part();
  const double largest = N_VMaxNorm(terms);
  const auto n = static_cast<double>(N_VGetLength(terms));
  int exponent = 0, bits = 0;  // |terms| < 2^exponent, n ≤ 2^bits
  std::frexp(largest, &exponent);
  while (std::ldexp(1.0, bits) < n) ++bits;
  constexpr int digits = std::numeric_limits<double>::digits;
  // Infinities have no parts, and their sum is the same in any order. NaN, which the norm may ignore, enters
  // every part.
  if (!std::isfinite(largest)) return original(terms, work.ones());
  int scale = 0;  // so that σ does not overflow
  if (exponent + bits >= std::numeric_limits<double>::max_exponent) {
    scale = bits + 1;
    N_VScale(std::ldexp(1.0, -scale), terms, terms);
    exponent -= scale;
  }
  double total = 0.0, sigma = std::ldexp(1.0, exponent + bits);
  for (int left = digits + bits; left > 0; left -= digits - bits) {
    // Parts are multiples of 2^−53 σ, at most 2^−bits σ in size. Every partial sum is such a multiple, at
    // most σ.
    N_VAddConst(terms, sigma, part);
    N_VAddConst(part, -sigma, part);
    N_VLinearSum(1.0, terms, -1.0, part, terms);
    total += original(part, work.ones());
    sigma = std::ldexp(sigma, bits - digits);
  }
  return std::ldexp(total, scale);
}

/// Returns the sum of the products x_i y_i, or of their squares; NaN if memory is lacking, because the
/// callers are functions of C.
double sum_of_products(N_Vector x, N_Vector y, bool squared) noexcept {
  try {
    const work_vectors work(x);
    N_VProd(x, y, work.terms());
    if (squared) N_VProd(work.terms(), work.terms(), work.terms());
    return sum_of_terms(work, replaced().of(x));
  } catch (const std::bad_alloc&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

void use_equal_sums(N_Vector v) {
  if (v->ops->nvdotprod == equal_dot_product) return;
  replaced().add(v);
  N_Vector_Ops ops = v->ops;
  ops->nvdotprod = equal_dot_product;
  ops->nvwrmsnorm = equal_wrms_norm;
  ops->nvwl2norm = equal_wl2_norm;
  // Without the following operations, SUNDIALS calls those above.
  ops->nvdotprodmulti = nullptr;
  ops->nvdotprodlocal = nullptr;
  ops->nvdotprodmultilocal = nullptr;
  ops->nvdotprodmultiallreduce = nullptr;
  ops->nvwrmsnormvectorarray = nullptr;
}

double equal_dot_product(N_Vector x, N_Vector y) {
  return sum_of_products(x, y, false);
}

double equal_wrms_norm(N_Vector x, N_Vector w) {
  return std::sqrt(sum_of_products(x, w, true) / static_cast<double>(N_VGetLength(x)));
}

double equal_wl2_norm(N_Vector x, N_Vector w) {
  return std::sqrt(sum_of_products(x, w, true));
}

sums_without_allocation::sums_without_allocation(const std::array<N_Vector, 3>& work) : before_(kept) {
  kept = work;
  N_VConst(1.0, kept[2]);
}

sums_without_allocation::~sums_without_allocation() {
  kept = before_;
}

}  // namespace apsis::sundials
