// Pictures, descriptions for ParaView and JSON texts are valid for any numbers and names.
#include <apsis/output/json_text.hpp>
#include <apsis/output/picture.hpp>
#include <apsis/output/xdmf_text.hpp>

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pictures_test {

using namespace apsis;
using json = nlohmann::ordered_json;

TEST(a_picture, has_null_where_a_number_is_not_finite) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  panel one{"top", "x", "y", true, false, {}, {}, {2.0}};
  one.curves.push_back({"a", {1.0, 2.0, 3.0}, {0.5, infinity, std::nan("")}, curve_style::dashed, -2});
  one.maps.push_back({{1.0}, {2.0}, {{-infinity}}, "error", -1.0, 1.0});
  const json read = json::parse(json_text(to_json(picture{"p", "title", "caption", {one}})));
  EXPECT_EQ(read["name"], "p");
  const json& drawn = read["panels"][0];
  EXPECT_EQ(drawn["curves"][0]["y"], json::parse("[0.5, null, null]"));
  EXPECT_EQ(drawn["curves"][0]["style"], "dashed");
  EXPECT_EQ(drawn["curves"][0]["colour"], -2);
  EXPECT_EQ(drawn["maps"][0]["value"], json::parse("[[null]]"));
  EXPECT_TRUE(drawn["log_x"].get<bool>());
  EXPECT_FALSE(drawn["log_y"].get<bool>());
  EXPECT_EQ(drawn["slopes"], json::parse("[2.0]"));
}

TEST(a_text_of_json, is_valid_with_file_names_that_are_not) {
  const json name = std::string("cas\xE9.toml");  // Latin-1
  EXPECT_EQ(json::parse(json_text(json{{"source", name}}))["source"], "cas\xEF\xBF\xBD.toml");
}

TEST(a_description_for_paraview, has_no_markup_in_names) {
  EXPECT_EQ(xdmf::escaped("a<b> & \"c\"\n'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &apos;d&apos;");
  EXPECT_NE(xdmf::document("<&>", "").find("&lt;&amp;&gt;"), std::string::npos);
  EXPECT_EQ(xdmf::joined({3, 4, 5}), "3 4 5");
}

}  // namespace pictures_test
