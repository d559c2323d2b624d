#pragma once

#include <apsis/output/hdf5_file.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

inline std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns true if v is strictly monotone.
inline bool is_monotone(const std::vector<double>& v) {
  return std::adjacent_find(v.begin(), v.end(), std::greater_equal<>()) == v.end() ||
         std::adjacent_find(v.begin(), v.end(), std::less_equal<>()) == v.end();
}

inline std::uint64_t product_of(const std::string& numbers) {
  std::uint64_t product = 1;
  std::istringstream in(numbers);
  for (std::uint64_t n = 0; in >> n;) product *= n;
  return product;
}

/// A grid of solution.xdmf.
struct described_grid {
  std::string name;
  std::vector<std::size_t> points;  ///< slowest axis first
};

/// Returns the grids of a description. Checks that their axes are strictly monotone, and that their lengths
/// are those of the topology.
inline std::vector<described_grid> checked_grids(const std::string& folder) {
  const std::string text = text_of(folder + "/solution.xdmf");
  static const std::regex grid(
      "<Grid Name=\"([a-z_]+)\" GridType=\"Uniform\">[^]*?Topology TopologyType=\"3DRectMesh\" "
      "Dimensions=\"([0-9 ]+)\"[^]*?VXVYVZ\">([^]*?)</Geometry>([^]*?)</Grid>");
  static const std::regex axis("<DataItem Format=\"(?:XML|HDF)\"[^>]*>([^<]+)</DataItem>");
  static const std::regex value(" Dimensions=\"([0-9 ]+)\">([^<:]+):/([^<]+)<");
  std::vector<described_grid> found;
  for (std::sregex_iterator at(text.begin(), text.end(), grid), end; at != end; ++at) {
    described_grid one{(*at)[1], {}};
    std::istringstream sizes((*at)[2].str());
    for (std::size_t n = 0; sizes >> n;) one.points.push_back(n);
    const std::string geometry = (*at)[3], attributes = (*at)[4];
    std::size_t k = one.points.size();
    for (std::sregex_iterator item(geometry.begin(), geometry.end(), axis); item != end; ++item) {
      const std::string source = (*item)[1];
      const auto colon = source.find(":/");
      const auto nodes =
          colon == std::string::npos
              ? std::vector<double>{0.0}
              : apsis::hdf5_file::open(folder + "/" + source.substr(0, colon)).read(source.substr(colon + 2));
      EXPECT_TRUE(is_monotone(nodes)) << source;
      EXPECT_EQ(nodes.size(), one.points.at(--k)) << source;
    }
    EXPECT_EQ(k, 0U) << one.name;
    // The series of all snapshots of a field has its own description.
    for (std::sregex_iterator item(attributes.begin(), attributes.end(), value); item != end; ++item) {
      const auto extents = apsis::hdf5_file::open(folder + "/" + (*item)[2].str()).extents((*item)[3].str());
      EXPECT_EQ(product_of((*item)[1].str()),
                std::accumulate(extents.begin(), extents.end(), 1UL, std::multiplies<>()))
          << item->str();
      if (one.name != "fields") {
        EXPECT_EQ(product_of((*item)[1].str()), product_of((*at)[2].str())) << one.name;
      }
    }
    found.push_back(one);
  }
  return found;
}

inline std::vector<described_grid> of_name(const std::vector<described_grid>& grids,
                                           const std::string& name) {
  std::vector<described_grid> found;
  for (const auto& one : grids)
    if (one.name == name) found.push_back(one);
  return found;
}
