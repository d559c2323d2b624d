#pragma once

#include <apsis/config/case_schema.hpp>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace apsis {

/// Conversion between a member of case_config and a case_value.
template <class Member>
struct conversion;

/// Conversion of a member whose type is an alternative of case_value.
template <class Same>
struct plain_conversion {
  static case_value to(const Same& member) { return member; }
  static void from(const case_value& value, Same& member) { member = std::get<Same>(value); }
};
template <>
struct conversion<double> : plain_conversion<double> {
  static constexpr key_type type = key_type::number;
};
template <>
struct conversion<std::string> : plain_conversion<std::string> {
  static constexpr key_type type = key_type::text;
};
template <>
struct conversion<std::vector<std::string>> : plain_conversion<std::vector<std::string>> {
  static constexpr key_type type = key_type::text_list;
};
template <>
struct conversion<std::vector<interval>> : plain_conversion<std::vector<interval>> {
  static constexpr key_type type = key_type::intervals;
};
template <>
struct conversion<std::vector<std::vector<double>>> : plain_conversion<std::vector<std::vector<double>>> {
  static constexpr key_type type = key_type::points;
};
template <>
struct conversion<int> {
  static constexpr key_type type = key_type::integer;
  static case_value to(int member) { return long{member}; }
  static void from(const case_value& value, int& member) { member = static_cast<int>(std::get<long>(value)); }
};
template <>
struct conversion<std::vector<int>> {
  static constexpr key_type type = key_type::integers;
  static case_value to(const std::vector<int>& member) {
    return std::vector<long>(member.begin(), member.end());
  }
  static void from(const case_value& value, std::vector<int>& member) {
    member.clear();
    for (const long item : std::get<std::vector<long>>(value)) member.push_back(static_cast<int>(item));
  }
};
template <>
struct conversion<point_counts> {
  static constexpr key_type type = key_type::integers;
  static case_value to(const point_counts& member) {
    return std::vector<long>(member.each().begin(), member.each().end());
  }
  static void from(const case_value& value, point_counts& member) {
    std::vector<int> each;
    conversion<std::vector<int>>::from(value, each);
    member = std::move(each);
  }
};
template <>
struct conversion<epsilon_formula> {
  static constexpr key_type type = key_type::formula;
  // Returns no value if another key gives epsilon.
  static case_value to(const epsilon_formula& member) {
    return member.key == epsilon_formula().key ? case_value(member.text) : case_value();
  }
  static void from(const case_value& value, epsilon_formula& member) {
    member = std::get<std::string>(value);
  }
};
template <class Member>
struct conversion<std::optional<Member>> {
  static constexpr key_type type = conversion<Member>::type;
  static case_value to(const std::optional<Member>& member) {
    return member ? conversion<Member>::to(*member) : case_value();
  }
  static void from(const case_value& value, std::optional<Member>& member) {
    conversion<Member>::from(value, member.emplace());
  }
};
template <class Choice>
  requires std::is_enum_v<Choice>
struct conversion<Choice> {
  static constexpr key_type type = key_type::text;
  static case_value to(Choice member) { return std::string(choice_name(member)); }
  static void from(const case_value& value, Choice& member) {
    const auto& names = choice_names<Choice>;
    for (std::size_t k = 0; k < names.size(); ++k)
      if (std::get<std::string>(value) == names[k]) member = static_cast<Choice>(k);
  }
};

/// The type of a value that may be missing.
template <class Member>
struct without_optional {
  using type = Member;
};
template <class Member>
struct without_optional<std::optional<Member>> {
  using type = Member;
};

/// Returns the key at `path` whose value is the member at(case_config). The key has the type of the member,
/// unless `facts` has the type of formulas or quantities.
template <class At>
case_key key(std::string path, At at, case_key facts) {
  using member = std::remove_cvref_t<decltype(at(std::declval<case_config&>()))>;
  facts.path = std::move(path);
  if (facts.type != key_type::formula && facts.type != key_type::formulas && facts.type != key_type::quantity)
    facts.type = conversion<member>::type;
  facts.store = [at](case_config& c, const case_value& value) { conversion<member>::from(value, at(c)); };
  facts.load = [at](const case_config& c) { return conversion<member>::to(at(c)); };
  using value_type = typename without_optional<member>::type;
  if constexpr (std::is_enum_v<value_type>)
    facts.choices = [](const case_config&) {
      return std::vector<std::string>(choice_names<value_type>.begin(), choice_names<value_type>.end());
    };
  const bool numeric = facts.type == key_type::integer || facts.type == key_type::number ||
                       facts.type == key_type::formula || facts.type == key_type::formulas ||
                       facts.type == key_type::integers || facts.type == key_type::intervals ||
                       facts.type == key_type::points;
  if (numeric && facts.unit.empty()) facts.unit = "dimensionless";
  return facts;
}

}  // namespace apsis
