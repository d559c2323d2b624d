#include <apsis/output/xdmf_text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::xdmf {

// Five characters are markup in XML; all others may appear in a title.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  }
  return out;
}

std::string joined(const std::vector<std::uint64_t>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

std::string data_item(const std::string& dimensions, const std::string& source, int bytes) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"{}\" Dimensions=\"{}\">{}</DataItem>\n",
      bytes, dimensions, source);
}

std::string part_item(const std::string& dimensions, std::uint64_t k, std::uint64_t parts,
                      const std::vector<std::uint64_t>& shape, const std::string& source) {
  std::vector<std::uint64_t> start(shape.size() + 1), stride(shape.size() + 1, 1), count = shape;
  start.front() = k;
  count.insert(count.begin(), 1);
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\">\n<DataItem Format=\"XML\" Dimensions=\"3 "
      "{}\">{} {} {}</DataItem>\n{}</DataItem>\n",
      dimensions, start.size(), joined(start), joined(stride), joined(count),
      data_item(fmt::format("{} {}", parts, joined(shape)), source));
}

std::string node_values(const std::string& name, const std::string& item) {
  return fmt::format("<Attribute Name=\"{}\" Center=\"Node\">{}</Attribute>\n", escaped(name), item);
}

std::string series_in_time(const std::string& name, const std::string& grids) {
  return fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}</Grid>\n",
                     name, grids);
}

std::string document(const std::string& title, const std::string& grids) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.2\">\n<Domain Name=\"{}\">\n"
      "{}</Domain>\n</Xdmf>\n",
      escaped(title), grids);
}

}  // namespace apsis::xdmf
