#include <apsis/space/field.hpp>

#include <apsis/core/parallel.hpp>

#include <algorithm>

namespace apsis {

void field::fill_rows(const double* values) {
  const int parts = std::min(threads(), cells_);
  parallel_for(parts, [&](int part) {
    const auto first = [&](int p) {
      return static_cast<std::ptrdiff_t>(static_cast<long>(cells_) * p / parts) * stride_;
    };
    double* to = data_.data() + first(part);
    if (values == nullptr) {
      std::fill_n(to, first(part + 1) - first(part), 0.0);
    } else {
      std::copy_n(values + first(part), first(part + 1) - first(part), to);
    }
  });
}

}  // namespace apsis
