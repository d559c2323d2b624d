#include <apsis/device/internal/combined_rows.hpp>

#include <apsis/device/internal/gas_cells.hpp>
#include <apsis/device/internal/kernels/combine.hpp>
#include <apsis/device/internal/row_launch.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace apsis {

void combine_rows(device& on, const grid& mesh, std::span<const linear_term<field, double>> terms, bool fresh,
                  field& sum) {
  const std::vector<cell_range> cells = gas_cells(mesh);
  constexpr auto most = static_cast<std::size_t>(kernels::combine::most);
  for (std::size_t first = 0; first < terms.size(); first += most)
    for (const auto& [begin, end] : cells) {
      const auto some = terms.subspan(first, std::min(most, terms.size() - first));
      const long numbers = static_cast<long>(end - begin) * sum.stride();
      kernels::combine::arguments of{
          sum.row(begin), numbers, static_cast<int>(some.size()), fresh && first == 0 ? 1 : 0, {}, {}};
      for (std::size_t k = 0; k < some.size(); ++k) {
        of.alpha[k] = some[k].alpha;
        of.u[k] = some[k].u->row(begin);
      }
      on.launch<kernels::combine>(launch_for(static_cast<std::size_t>(numbers)), of);
    }
}

}  // namespace apsis
