#pragma once

#include <apsis/apsis.h>
#include <apsis/method/time_integrator.hpp>

#include <mutex>
#include <string>
#include <vector>

/// A method of the C interface. The first thread that uses its texts and facts makes them.
struct apsis_method {
  const apsis::time_integrator* integrator;  ///< lives to the end of the program
  std::string requested;                     ///< its name, or the path of its file

  using fact = apsis::integrator_certificate::fact;
  /// Returns the facts of the certificate.
  const std::vector<fact>& facts() const;
  /// Returns the facts as lines "key = value".
  const std::string& certificate_text() const;
  /// Returns the text of its method file.
  const std::string& file_text(const apsis::method& file) const;

  mutable std::once_flag facts_made{}, certificate_made{}, file_made{};
  mutable std::vector<fact> known_facts{};
  mutable std::string known_certificate{}, known_file{};
};
