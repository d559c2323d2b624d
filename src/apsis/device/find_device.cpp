#include <apsis/device/find_device.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>

#include <fmt/format.h>

namespace apsis {

std::vector<found_device> found_devices() {
  std::vector<found_device> all;
  for (const device_backend_entry* kind : device_backend_entries()) {
    if (!kind->is_real) continue;
    int number = 0;
    for (const std::string& name : kind->names())
      all.push_back({fmt::format("{}:{}", kind->name, number++), name});
  }
  return all;
}

std::shared_ptr<device> open_device(const std::string& wanted, int process) {
  const auto all = found_devices();
  std::string there;
  for (std::size_t k = 0; k < all.size(); ++k) {
    there += fmt::format("{}{} ({})", k == 0 ? "" : ", ", all[k].place, all[k].name);
    const bool by_number = wanted == std::to_string(k) || (wanted.empty() && k == 0);
    if (!by_number && wanted != all[k].place) continue;
    const std::size_t mine = by_number ? (k + static_cast<std::size_t>(process)) % all.size() : k;
    const std::string& place = all[mine].place;
    const std::size_t colon = place.find(':');
    for (const device_backend_entry* kind : device_backend_entries())
      if (kind->name == place.substr(0, colon)) return kind->open(std::stoi(place.substr(colon + 1)));
  }
  for (const device_backend_entry* kind : device_backend_entries())
    if (!kind->is_real && kind->name == wanted) return kind->open(0);
  if (all.empty())
    throw input_error("no device was found (this machine has no driver of one); run without --device");
  throw input_error(
      fmt::format("no device '{}' (this machine has {}); give one of these", printable(wanted), there));
}

}  // namespace apsis
