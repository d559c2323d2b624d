#include <apsis/output/polydata.hpp>

#include <apsis/output/xdmf_text.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <type_traits>

#include <fmt/format.h>

namespace apsis {
namespace {

std::string base64_of(std::span<const std::byte> bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t first = 0; first < bytes.size(); first += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - first);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (k < count ? std::to_integer<std::uint32_t>(bytes[first + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(k <= count ? digits[bits >> (18U - 6U * k) & 63U] : '=');
  }
  return text;
}

/// Returns an array of 8-byte numbers, preceded by its size in bytes.
template <class Number>
std::string data_array(const std::string& name, int components, const std::vector<Number>& values) {
  const std::uint64_t size = values.size() * sizeof(Number);
  std::vector<std::byte> bytes;
  const auto append = [&bytes](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  append(std::as_bytes(std::span(&size, 1)));
  append(std::as_bytes(std::span(values)));
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
      std::is_same_v<Number, double> ? "Float64" : "Int64", xdmf::escaped(name), components,
      base64_of(bytes));
}

}  // namespace

std::string to_vtp(const polydata& surface) {
  std::map<position, std::int64_t> numbers;
  std::vector<double> points;
  std::vector<std::int64_t> connectivity, offsets;
  bool segments = true;
  for (const auto& cell : surface.cells) {
    for (const position& corner : cell) {
      const auto [found, is_new] = numbers.emplace(corner, static_cast<std::int64_t>(numbers.size()));
      if (is_new) points.insert(points.end(), corner.begin(), corner.end());
      connectivity.push_back(found->second);
    }
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    segments = segments && cell.size() == 2;
  }
  std::string arrays;
  for (const auto& one : surface.data) arrays += data_array(one.name, one.components, one.values);
  const char* kind = segments ? "Lines" : "Polys";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n<CellData>\n{}</CellData>\n<Points>\n{}</Points>\n<{}>\n{}{}</{}>\n</Piece>\n"
      "</PolyData>\n</VTKFile>\n",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", numbers.size(),
      segments ? surface.cells.size() : 0, segments ? 0 : surface.cells.size(), arrays,
      data_array("Points", 3, points), kind, data_array("connectivity", 1, connectivity),
      data_array("offsets", 1, offsets), kind);
}

}  // namespace apsis
