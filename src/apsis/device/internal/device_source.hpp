#pragma once

#include <apsis/device/device.hpp>
#include <apsis/semidiscrete/source.hpp>

#include <memory>
#include <span>

namespace apsis {

/// `source` on a device, with the same bits. The host evaluates S, from a copy of the state if S depends on
/// it.
class device_source {
 public:
  /// `on` and `equation` must outlive the object; the arguments are those of `source`.
  device_source(device& on, const model& equation, std::shared_ptr<domain> space, source_rate rate,
                const cell_unknown& unknown);

  /// Does the same as source::add(), for states on the device. Collective.
  void add(double t, const field& u, std::span<const target<field, double>> targets);
  /// Does the same as source::growth().
  double growth(double t, const field& u);
  /// Returns the source on the host, with given() of the last add().
  const source& on_host() const { return host_; }

 private:
  device& device_;
  std::shared_ptr<domain> space_;
  source host_;
  field values_,  ///< S on the device
      room_;      ///< copy of a state on the host
};

}  // namespace apsis
