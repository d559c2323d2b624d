#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Elements of an XDMF description as text.
namespace apsis::xdmf {

/// Returns text in which the characters that are markup in XML are escaped, and control
/// characters are spaces.
std::string escaped(const std::string& text);

/// Returns numbers separated by spaces, such as "3 4 5".
std::string joined(const std::vector<std::uint64_t>& numbers);

/// Returns a reference to a dataset in a file beside the description.
std::string data_item(const std::string& dimensions, const std::string& source, int bytes = 8);

/// Returns a reference to part k of a dataset [parts][shape…] as an array of the given dimensions.
std::string part_item(const std::string& dimensions, std::uint64_t k, std::uint64_t parts,
                      const std::vector<std::uint64_t>& shape, const std::string& source);

/// Returns a scalar at the nodes of a grid.
std::string node_values(const std::string& name, const std::string& item);

/// Returns a collection of grids in order of time.
std::string series_in_time(const std::string& name, const std::string& grids);

/// Returns a complete description with these grids.
std::string document(const std::string& title, const std::string& grids);

}  // namespace apsis::xdmf
