// Files and names of methods that are refused: those of the table in the folder bad_input, and long ones.
#include <support/bad_input.hpp>

#include "tableaux.hpp"

#include <apsis/method/method.hpp>
#include <apsis/method/time_integrator.hpp>

#include <string>

#include <gtest/gtest.h>

namespace bad_input_test {

namespace {

void read(const std::string& text) {
  apsis::parse_any_method(text, "c.toml");
}

void find(const std::string& name) {
  apsis::find_method(name);
}

/// Returns "a.a.a" with n parts.
std::string many_dots(int n) {
  std::string key = "a";
  for (int i = 1; i < n; ++i) key += ".a";
  return key;
}

}  // namespace

TEST(bad_input, method_files_are_refused_at_their_place) {
  bad_input::expect_answers(
      bad_input::rows_in(APSIS_BAD_INPUT, apsis::test::catalogue_text),
      [](const bad_input::row& r) { return bad_input::answer_of([&] { read(r.text); }); });
}

TEST(bad_input, method_files_with_long_parts_are_refused) {
  const std::string head =
      "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"imex\"\n[claims]\norder = 1\n";
  const std::string number(100'000, '7'), dots = many_dots(50'000);
  bad_input::expect_refused({
      {[&] { read(apsis::test::method_text(number, "imex", 1, "[shu_osher]\n")); },
       {"c.toml:1:8: ", "too long"}},
      {[&] { read("name = \"x\"\n" + dots + " = 1\n"); }, {"c.toml:2:16: the key has more than 8 parts"}},
      {[&] { read("name = \"x\"\n[" + dots + "]\n"); }, {"c.toml:2:17: the key has more than 8 parts"}},
      {[&] { read(head + "[shu_osher]\nP = [[]]\nW = [[]]\nr = \"" + number + "\"\n"); },
       {"c.toml:10:5: ", "not a coefficient"}},
  });
}

TEST(bad_input, names_of_methods_are_refused) {
  using apsis::find_integrator;
  const std::string chain = "md-imex-chain-S-2 has S from 3 to 64";
  bad_input::expect_refused({
      {[] { find("md-imex-3-3"); }, {"unknown method 'md-imex-3-3'", "did you mean 'md-imex-"}},
      {[] { find(std::string(1'000'000, 'x')); }, {"unknown method 'xxxx"}},
      {[] { find("md-imex-chain-2-2"); }, {chain}},
      {[] { find("md-imex-chain-65-2"); }, {chain}},
      {[] { find("md-imex-chain-x-2"); }, {chain}},
      {[] { find("md-imex-chain-S-2"); }, {chain}},
      {[] { find("md-imex-chain-07-2"); }, {chain}},
      {[] { find("md-imex-chain-+7-2"); }, {chain}},
      {[] { find("md-imex-chain--7-2"); }, {chain}},
      {[] { find("md-imex-chain-7.0-2"); }, {chain}},
      {[] { find("md-imex-chain-1e1-2"); }, {chain}},
      {[] { find("md-imex-chain-3 -2"); }, {chain}},
      {[] { find("md-imex-chain-99999999999999999999-2"); }, {chain}},
      {[] { find("md-imex-plateau-free-4-2"); }, {"md-imex-plateau-free-S-2 has S from 5 to 64"}},
      {[] { find("md-imex-chain-7-3"); }, {"unknown method"}},
      {[] { find("md-imex-chain-7"); }, {"unknown method"}},
      {[] { find("md-imex-chain-2"); }, {"unknown method"}},
      {[] { find("md-imex-chain"); }, {"unknown method"}},
      {[] { find("md-imex-chian-S-2"); }, {"did you mean 'md-imex-chain-S-2'"}},
      {[] { find_integrator("md-imex-6-33"); }, {"did you mean 'md-imex-6-3'?"}},
      {[] { find_integrator("no-such-file.toml"); }, {"no-such-file.toml"}},
      {[] { find("two-step-8-3-narrow"); }, {"'two-step-8-3-narrow' is a multistep method"}},
      {[] { apsis::parse_method(apsis::test::catalogue_text("two-step-8-3-narrow"), "c.toml"); },
       {"c.toml:1:1: 'two-step-8-3-narrow' takes two steps (steps = 2: equal ones"}},
      {[] { apsis::load_method_file("/nowhere/at/all.toml"); },
       {"cannot read the method file '/nowhere/at/all.toml' (it does not exist)"}},
      {[] { apsis::load_method_file("/"); }, {"cannot read '/' (it is a folder or not readable)"}, 4},
      {[] { apsis::load_method_file(""); }, {"cannot read the method file '' (it does not exist)"}},
  });
}

}  // namespace bad_input_test
