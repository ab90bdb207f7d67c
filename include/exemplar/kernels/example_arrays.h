// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_arrays_h
#define exemplar_example_arrays_h

#include <cstddef>

// What examples ask of the points of a body, as the loops read it. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Share of a region in a cell, by which its weights act.
  struct RegionShare
  {
    unsigned int region; ///< index, in ascending order of material ids
    double       value;
  };

  /// The examples other than the rest pose, whose strain is zero.
  struct ExampleArrays
  {
    unsigned int       n           = 0; ///< number of these examples
    unsigned int       first       = 0; ///< index of the first among all examples
    unsigned int       n_all       = 0; ///< number of all examples
    unsigned int       n_weights   = 0;
    const double      *strains     = nullptr; ///< 6 n: xx, yy, zz, yz, xz, xy of each eta E_i
    const std::size_t *share_start = nullptr; ///< begin of a cell's shares; null: global weights
    const RegionShare *shares      = nullptr;
    const float       *in_single
        = nullptr; ///< the strains once more, if single precision has them exactly
  };
} // namespace Exemplar

#endif
