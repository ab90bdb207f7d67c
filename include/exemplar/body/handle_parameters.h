// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_parameters_h
#define exemplar_handle_parameters_h

#include <exemplar/mesh/selection.h>

#include <string>

namespace Exemplar
{
  class KeyTable;

  /// A subsection of Handles.
  struct HandleParameters
  {
    std::string name;
    Selection   select;
    std::string motion     = "0; 0; 0";
    std::string components = "x, y, z";
    std::string follow_pose; ///< a file; empty: `motion` says where the nodes go
    std::string progress = "t";
    std::string follow_cache; ///< a file of places of the surface's vertices in time; empty: none
    double      frames_per_second = 24.;
    std::string cache_start       = "file"; ///< t of the first sample [s], or as the file has it

    void
    declare(KeyTable &keys);

    /// Throws UserError if more than one of a motion, a pose and a cache to follow is given, or
    /// what belongs to one that is not.
    void
    check() const;
  };
} // namespace Exemplar

#endif
