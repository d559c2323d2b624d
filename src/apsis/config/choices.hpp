#pragma once

#include <apsis/model/model_registry.hpp>

#include <array>

namespace apsis {

/// Values of space.limiter.
enum class limiter_choice {
  none,       ///< reconstruction as it is
  positivity  ///< nonnegative data stay so within r Δt_FE
};

/// Values of space.geometry.
enum class geometry_choice {
  cartesian,    ///< coordinates x, y, z
  axisymmetric  ///< (x, r), or r alone: nothing depends on the angle about the axis r = 0
};

/// Values of time.startup.
enum class startup_choice {
  none,   ///< the first step is like the others
  graded  ///< the first step is split so that the initial layer is resolved
};

/// Values of output.distribution.
enum class distribution_choice {
  none,      ///< f is not written
  end,       ///< f at the end
  snapshots  ///< f at the end and in every snapshot
};

/// Values of output.precision.
enum class precision_choice {
  double_precision,  ///< 8 bytes
  single_precision   ///< 4 bytes
};

/// Values of output.units.
enum class units_choice {
  dimensionless,  ///< the units of the case
  si              ///< SI units by the table [gas]
};

/// The names of the enumerators in a case file, in the order of the enumerators.
template <class Choice>
inline constexpr std::array<const char*, 0> choice_names{};
/// @cond
template <>
inline constexpr std::array choice_names<limiter_choice> = {"none", "positivity"};
template <>
inline constexpr std::array choice_names<geometry_choice> = {"cartesian", "axisymmetric"};
template <>
inline constexpr std::array choice_names<startup_choice> = {"none", "graded"};
template <>
inline constexpr std::array choice_names<distribution_choice> = {"none", "end", "snapshots"};
template <>
inline constexpr std::array choice_names<precision_choice> = {"double", "single"};
template <>
inline constexpr std::array choice_names<units_choice> = {"dimensionless", "SI"};
template <>
inline constexpr std::array choice_names<equilibrium_choice> = {"auto", "formula", "discrete"};
/// @endcond

/// Returns the name of an enumerator in a case file, such as "positivity".
template <class Choice>
constexpr const char* choice_name(Choice choice) {
  return choice_names<Choice>[static_cast<std::size_t>(choice)];
}

}  // namespace apsis
