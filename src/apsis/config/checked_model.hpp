#pragma once

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>

#include <memory>
#include <string>

namespace apsis {

/// Returns body(). An input_error of a model, whose message begins with a key, gets the place of that key.
template <class Body>
auto with_place_of_key(const case_config& config, const Body& body) {
  try {
    return body();
  } catch (const input_error& failure) {
    const std::string message = failure.what();
    std::string key = message.substr(0, message.find(' '));
    if (key == "model") key = "model.name";  // "model 'NAME' cannot …"
    const source_place place = key.find('.') == std::string::npos ? source_place{} : place_of(config, key);
    if (place.file.empty()) throw;
    throw input_error(place, message);
  }
}

/// Returns make_model(config). Throws input_error at the place of the key that the model refuses.
inline std::shared_ptr<const model> checked_model(const case_config& config) {
  return with_place_of_key(config, [&] { return make_model(config); });
}

}  // namespace apsis
