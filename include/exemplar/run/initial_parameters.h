// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_initial_parameters_h
#define exemplar_initial_parameters_h

#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace Exemplar
{
  /// Subsection Initial.
  struct InitialParameters
  {
    std::string pose;
    std::string pose_function;
    std::string velocity = "0; 0; 0";

    void
    declare(dealii::ParameterHandler &prm);
  };
} // namespace Exemplar

#endif
