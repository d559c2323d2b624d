#pragma once

#include "device_case.hpp"

#include <apsis/device/internal/device_transport.hpp>

#include <algorithm>
#include <array>

/// Counts the numbers and rates that differ between host and device, in evaluations with several targets,
/// with the limiters of steps of two lengths and of steady states.
inline bit_differences differences_of_transport(const apsis::grid& mesh, const apsis::field& u,
                                                apsis::upwind_transport& host, apsis::device_transport& there,
                                                const apsis::device& on) {
  using apsis::field, apsis::target;
  field a(mesh.size(), u.components()), b = a, back = a;
  field sent(mesh.size(), u.components(), on.memory()), c = sent, d = sent;
  for (auto* one : {&c, &d}) one->copy_rows(b);
  sent.copy_rows(u);
  const double step = 0.5 * host.forward_euler_step();
  bit_differences different;
  constexpr double steady = 0.7;
  for (const double share : {1.0, 0.3, steady}) {
    for (apsis::transport* one :
         {static_cast<apsis::transport*>(&host), static_cast<apsis::transport*>(&there)})
      if (share == steady)
        one->limit_for_steady_states(3.0);
      else
        one->limit_for_steps(share);
    const std::array<target<field, double>, 2> on_host = {
        {{&a, 1.0, share * step, true}, {&b, 0.4, -step, false}}};
    const std::array<target<field, double>, 2> on_device = {
        {{&c, 1.0, share * step, true}, {&d, 0.4, -step, false}}};
    host.add_transport(0.3, u, on_host);
    there.add_transport(0.3, sent, on_device);
    back.copy_rows(c);
    different += different_numbers(mesh, a, back);
    back.copy_rows(d);
    different += different_numbers(mesh, b, back);
    const auto rates = host.budget_rates(), others = there.budget_rates();
    EXPECT_EQ(rates.size(), others.size());
    for (std::size_t k = 0; k < std::min(rates.size(), others.size()); ++k)
      different.compare(rates[k], others[k], [&] { return fmt::format("rate {} at surfaces", k); });
  }
  return different;
}

/// Counts the numbers and rates that differ between host and device for the transport of a flow, and the
/// numbers seen at surfaces.
inline bit_differences differences(const device_case& of, const std::string& scheme,
                                   apsis::limited_reconstruction::limits limited, apsis::device& on) {
  using apsis::field;
  const apsis::limited_reconstruction edges{apsis::find_reconstruction(scheme).make(), limited};
  apsis::upwind_transport host(*of.equation, of.space(), edges, apsis::point_values());
  apsis::device_transport there(on, *of.equation, of.space(), edges, apsis::point_values(),
                                apsis::kernel_of_reconstruction(scheme));
  const field u = varied_rows(of.mesh, *of.equation, of.label.starts_with("periodic"));
  bit_differences different = differences_of_transport(of.mesh, u, host, there, on);
  field sent(of.mesh.size(), u.components(), on.memory());
  sent.copy_rows(u);
  const auto seen = host.observe_surfaces(0.4, u), others = there.observe_surfaces(0.4, sent);
  EXPECT_EQ(seen.size(), others.size());
  for (std::size_t k = 0; k < std::min(seen.size(), others.size()); ++k)
    different.compare(seen[k], others[k], [&] { return fmt::format("number {} seen at surfaces", k); });
  return different;
}
