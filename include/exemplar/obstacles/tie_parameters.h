// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tie_parameters_h
#define exemplar_tie_parameters_h

#include <exemplar/mesh/selection.h>

#include <string>

namespace Exemplar
{
  class KeyTable;

  /// Parameters of a subsection of Ties.
  struct TieParameters
  {
    std::string name;
    Selection   select;
    Selection   to;                  ///< empty: all other pieces
    std::string stiffness = "rigid"; ///< or a number [N/m^3]
    std::string reach     = "auto";  ///< or a number [m]

    void
    declare(KeyTable &keys);

    /// Throws UserError for texts that are no numbers.
    void
    check() const;
  };
} // namespace Exemplar

#endif
