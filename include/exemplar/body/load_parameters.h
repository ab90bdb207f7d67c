// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_load_parameters_h
#define exemplar_load_parameters_h

#include <exemplar/mesh/selection.h>

#include <string>

namespace Exemplar
{
  class KeyTable;

  /// A subsection of Loads.
  struct LoadParameters
  {
    std::string name;
    Selection   select;
    std::string force = "0; 0; 0";

    void
    declare(KeyTable &keys);
  };
} // namespace Exemplar

#endif
