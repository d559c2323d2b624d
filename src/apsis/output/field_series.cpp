#include <apsis/output/field_series.hpp>

namespace apsis {

numeric_table to_table(const field_series& fields) {
  const bool several = fields.snapshots.size() > 1;
  numeric_table out;
  if (several) out.columns.emplace_back("t");
  for (const auto& axis : fields.axes) out.columns.push_back(axis.name);
  out.columns.insert(out.columns.end(), fields.names.begin(), fields.names.end());
  for (const auto& snapshot : fields.snapshots) {
    const std::size_t cells = snapshot.values.empty() ? 0 : snapshot.values.front().size();
    for (std::size_t cell = 0; cell < cells; ++cell) {
      std::vector<double> row;
      if (several) row.push_back(snapshot.t);
      for (std::size_t k = 0; k < fields.axes.size(); ++k)
        row.push_back(centre_of_cell(fields.axes, cell, k));
      for (const auto& values : snapshot.values) row.push_back(values[cell]);
      out.rows.push_back(std::move(row));
    }
  }
  return out;
}

}  // namespace apsis
