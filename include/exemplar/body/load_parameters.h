// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_load_parameters_h
#define exemplar_load_parameters_h

#include <exemplar/mesh/selection.h>

#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace Exemplar
{
  /// A subsection of Loads.
  struct LoadParameters
  {
    std::string name;
    Selection   select;
    std::string force = "0; 0; 0";

    void
    declare(dealii::ParameterHandler &prm);
  };
} // namespace Exemplar

#endif
