#pragma once

// Rows of random numbers for the tests of formulas.
#include <apsis/core/random_source.hpp>

#include <cstddef>
#include <vector>

#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace semidiscrete_formulas_test {

using apsis::random_source;

/// Rows of random numbers, contiguous in memory.
struct rows {
  std::size_t width;
  std::vector<double> all;
  std::vector<const double*> at;

  template <class Draw>
  rows(std::size_t count, std::size_t of_row, random_source& random, const Draw& draw)
      : width(of_row), all(drawn(count * of_row, random, draw)) {
    for (std::size_t i = 0; i < count; ++i) at.push_back(all.data() + i * width);
  }
};

}  // namespace semidiscrete_formulas_test
