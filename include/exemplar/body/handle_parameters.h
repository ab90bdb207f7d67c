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

    void
    declare(KeyTable &keys);

    /// Throws UserError if both a motion and a pose to follow are given, or a
    /// progress without a pose.
    void
    check() const;
  };
} // namespace Exemplar

#endif
