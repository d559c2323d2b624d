#pragma once

#include <string_view>
#include <vector>

namespace apsis {

/// A text file compiled into the library.
struct embedded_text {
  std::string_view name;  ///< path relative to its folder, without extension
  std::string_view text;  ///< contents
};

namespace embedded {
std::vector<embedded_text> methods();   ///< returns every file of methods/
std::vector<embedded_text> cases();     ///< returns every case of cases/
std::vector<embedded_text> surfaces();  ///< returns every STL file of cases/
}  // namespace embedded

}  // namespace apsis
