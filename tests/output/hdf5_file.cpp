// HDF5 files return numbers, texts and attributes unchanged. Parts of several writers form one dataset.
// Missing parts are noticed.
#include <apsis/output/hdf5_file.hpp>

#include "support/folder.hpp"
#include "support/property.hpp"

#include <apsis/core/errors.hpp>

#include <fstream>
#include <iterator>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace hdf5_file_test {

using namespace apsis;
using testing::ElementsAre;
using shape = hdf5_file::shape;

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST(an_hdf5_file, keeps_numbers_texts_and_attributes) {
  const test_folder folder;
  const std::string path = folder / "a.h5";
  {
    auto file = hdf5_file::create(path);
    file.write("fields/rho", {0.1, -0.0, 1e308, 5e-324, 3.0, 4.0}, {2, 3}, "density", precision::float64,
               "kg/m^3");
    file.write("f", {0.1, 2.0}, {2}, "", precision::float32);
    file.write("empty", {}, {0});
    file.write("case", std::string("title = \"Knudsen ε\""));
    file.write_attribute("t", 0.1);
    file.write_attribute("title", std::string("a run"));
    file.close();
  }
  const auto file = hdf5_file::open(path);
  EXPECT_THAT(file.read("fields/rho"), ElementsAre(0.1, -0.0, 1e308, 5e-324, 3.0, 4.0));
  EXPECT_TRUE(std::signbit(file.read("fields/rho")[1]));
  EXPECT_EQ(file.extents("fields/rho"), (shape{2, 3}));
  EXPECT_EQ(file.units("fields/rho"), "kg/m^3");
  EXPECT_EQ(file.units("f"), "dimensionless");
  EXPECT_EQ(file.stored("fields/rho"), precision::float64);
  EXPECT_EQ(file.stored("f"), precision::float32);
  EXPECT_THAT(file.read("f"), ElementsAre(static_cast<double>(0.1F), 2.0));
  EXPECT_TRUE(file.read("empty").empty());
  EXPECT_EQ(file.read_text("case"), "title = \"Knudsen ε\"");
  EXPECT_EQ(file.read_attribute("t"), 0.1);
  EXPECT_EQ(file.read_text_attribute("title"), "a run");
  EXPECT_TRUE(file.has("fields") && file.has("fields/rho") && file.has_attribute("t"));
  EXPECT_FALSE(file.has("fields/T") || file.has_attribute("step"));
  EXPECT_THAT(file.number_sets("fields"), ElementsAre("rho"));
  bad_input::expect_refused({
      {[&] { file.read("fields/T"); }, {path}, 4},
      {[&] { file.read_attribute("step"); }, {path}, 4},
  });
}

TEST(an_hdf5_file, of_equal_results_has_equal_bytes) {
  const test_folder folder;
  for (const char* name : {"a.h5", "b.h5"}) {
    auto file = hdf5_file::create(folder / name);
    file.write("fields/rho", {1.0, 2.0}, {2});
    file.write_attribute("title", std::string("a run"));
    file.close();
  }
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(an_hdf5_file, has_one_dataset_from_the_parts_of_several_writers_in_any_order) {
  check_property("parts", [] {
    const test_folder folder;
    const std::string path = folder / "parts.h5";
    const auto rows = *rc::gen::inRange<std::uint64_t>(1, 9),
               columns = *rc::gen::inRange<std::uint64_t>(1, 5);
    const auto cut = *rc::gen::inRange<std::uint64_t>(0, rows + 1);  // a part may be empty
    std::vector<double> all(rows * columns);
    std::iota(all.begin(), all.end(), 1.0);
    const std::vector<dataset_part> parts{{{0, 0}, {cut, columns}}, {{cut, 0}, {rows - cut, columns}}};
    const auto numbers = [&](const dataset_part& part) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(part.first[0] * columns);
      return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(part.count[0] * columns));
    };
    {
      auto frame = hdf5_file::create_frame(path, 512);
      frame.write_part("f", numbers(parts[0]), {rows, columns}, parts[0]);
      frame.close();
    }
    const bool backwards = *rc::gen::arbitrary<bool>();
    for (const std::size_t k : {backwards ? 1U : 0U, backwards ? 0U : 1U}) {
      auto file = hdf5_file::open_parts(path, "process " + std::to_string(k));
      file.write_part("f", numbers(parts[k]), {rows, columns}, parts[k]);
      file.close();
    }
    const auto file = hdf5_file::open(path);
    RC_ASSERT(file.read("f") == all);
    for (const auto& part : parts) RC_ASSERT(file.read_part("f", part) == numbers(part));
  });
}

TEST(an_hdf5_file, that_is_missing_truncated_or_something_else_is_refused_by_name) {
  const test_folder folder;
  const std::string path = folder / "a.h5";
  bad_input::expect_refused({
      {[&] { hdf5_file::open(path); }, {path}, 4},
  });
  {
    auto file = hdf5_file::create(path);
    file.write("rho", std::vector<double>(1000, 1.0), {1000});
    file.close();
  }
  const std::string whole = bytes_of(path);
  for (std::size_t kept = 0; kept < whole.size(); kept += 509) {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(whole.data(), static_cast<std::streamsize>(kept));
    bad_input::expect_refused({
        {[&] { hdf5_file::open(path).read("rho"); }, {path}, 4},
    });
  }
}

}  // namespace hdf5_file_test
