#pragma once

#include <string_view>
#include <vector>

namespace apsis {

/// A text file that is part of the library.
struct embedded_text {
  std::string_view name;  ///< path below its folder, without ending
  std::string_view text;  ///< all of its bytes
};

namespace embedded {
std::vector<embedded_text> methods();  ///< every file of methods/
std::vector<embedded_text> cases();    ///< every file of cases/
}  // namespace embedded

}  // namespace apsis
