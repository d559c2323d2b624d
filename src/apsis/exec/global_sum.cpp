#include <apsis/exec/global_sum.hpp>

#include <algorithm>

namespace apsis {

std::vector<double> global_values(communicator& processes, std::span<exact_sum> sums) {
  if (!processes.is_single() && !sums.empty()) {
    std::vector<std::int64_t> words;
    for (exact_sum& one : sums) words.insert(words.end(), one.words().begin(), one.words().end());
    processes.sum(words);
    for (std::size_t k = 0; k < sums.size(); ++k)
      std::copy_n(words.data() + k * exact_sum::length, exact_sum::length, sums[k].words().data());
  }
  std::vector<double> values;
  for (const exact_sum& one : sums) values.push_back(one.value());
  return values;
}

double global_lowest(communicator& processes, double mine) {
  processes.lowest({&mine, 1});
  return mine;
}

std::int64_t global_count(communicator& processes, std::int64_t mine) {
  processes.sum({&mine, 1});
  return mine;
}

}  // namespace apsis
