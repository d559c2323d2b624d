#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/table.hpp>

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// The computed and recorded results of a run.
struct outcome {
  std::vector<double> state;
  apsis::numeric_table history;
  apsis::field_series fields;
};

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

inline void expect_same(const outcome& a, const outcome& b, const std::string& what) {
  EXPECT_TRUE(same_bits(a.state, b.state)) << what;
  ASSERT_EQ(a.history.rows.size(), b.history.rows.size()) << what;
  for (std::size_t k = 0; k < a.history.rows.size(); ++k)
    EXPECT_TRUE(same_bits(a.history.rows[k], b.history.rows[k])) << what << ", step " << k;
  ASSERT_EQ(a.fields.snapshots.size(), b.fields.snapshots.size()) << what;
  for (std::size_t k = 0; k < a.fields.snapshots.size(); ++k) {
    EXPECT_EQ(a.fields.snapshots[k].t, b.fields.snapshots[k].t) << what;
    for (std::size_t n = 0; n < a.fields.names.size(); ++n)
      EXPECT_TRUE(same_bits(a.fields.snapshots[k].values[n], b.fields.snapshots[k].values[n])) << what;
  }
}
