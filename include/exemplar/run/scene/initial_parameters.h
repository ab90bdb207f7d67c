// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_initial_parameters_h
#define exemplar_initial_parameters_h

#include <string>

namespace Exemplar
{
  class KeyTable;

  /// Subsection Initial.
  struct InitialParameters
  {
    std::string pose;
    std::string pose_function;
    std::string velocity = "0; 0; 0";

    void
    declare(KeyTable &keys);
  };
} // namespace Exemplar

#endif
