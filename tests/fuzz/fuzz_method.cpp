// Reads any bytes as a method file. The result is an apsis::error or a method with coefficients in double.
#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto m = apsis::parse_method({reinterpret_cast<const char*>(data), size}, "input");
    m.coefficients<double>();
  } catch (const apsis::error&) {
    return 0;
  }
  return 0;
}
