// Reads any bytes as a case file. The result is a case or an apsis::error. The text of a case reads back to
// the same case.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

namespace {

std::optional<apsis::case_config> read(std::string_view text) {
  // The first line of the input is also an override, so the fuzzer tests both readers.
  const std::string line(text.substr(0, text.find('\n')));
  try {
    return line.rfind("#!", 0) == 0 ? apsis::parse_case(text, "input", {line.substr(2)})
                                    : apsis::parse_case(text, "input");
  } catch (const apsis::error&) {
    return std::nullopt;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto config = read({reinterpret_cast<const char*>(data), size});
  if (!config) return 0;
  const std::string text = apsis::to_toml(*config);
  if (apsis::to_toml(apsis::parse_case(text, "again")) != text) std::abort();
  return 0;
}
