#pragma once

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/session.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Small gases in the plane and in space. Their initial density is an affine function of the position.
namespace in_several_dimensions {

inline const std::string in_plane = R"toml(
[model]
name = "bgk"
epsilon = 0.01
[initial]
rho = "1 + 0.2*x + 0.3*y"
T = 1
u = ["0.1*sin(2*pi*x)*cos(2*pi*y)", "-0.1*cos(2*pi*x)*sin(2*pi*y)"]
[space]
cells = [7, 6]
domain = [[0.0, 1.0], [-1.0, 1.0]]
boundary = "outflow"
[velocity]
max = 7.0
points = 12
[time]
method = "md-imex-3-2"
end = 0.002
dt = 0.001
)toml";

inline const std::string in_space = R"toml(
[model]
name = "bgk"
epsilon = 0.01
[initial]
rho = "1 + 0.1*x + 0.02*y + 0.003*z"
T = 1
[space]
cells = [8, 7, 9]
domain = [[0.0, 1.0], [0.0, 1.0], [0.0, 2.0]]
boundary = "outflow"
[velocity]
max = 7.0
points = 8
equilibrium = "discrete"
[time]
method = "md-imex-3-2"
end = 0.002
dt = 0.001
[output]
fields = ["rho", "T"]
every = 0.001
)toml";

/// Runs a case into a folder.
inline void run_into(const std::string& folder, const std::string& text,
                     const std::vector<std::string>& overrides = {}) {
  apsis::session_options how;
  how.out = folder;
  apsis::run_session session(apsis::parse_case(text, "case.toml", overrides), how);
  ASSERT_EQ(session.run(), apsis::run_end::complete);
}

}  // namespace in_several_dimensions
