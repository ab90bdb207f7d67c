// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_pickle_h
#define exemplar_state_pickle_h

#include <exemplar/python/made_objects.h>

namespace Exemplar::Python
{
  /// The pickled form of a state: bytes with their digest.
  pybind11::object
  pickled(const SavedState &saved);

  /// The state from the result of pickled(). Throws UserError for anything else: bytes that were
  /// changed, and those of another version of exemplar.
  SavedState
  unpickled(const pybind11::object &kept);
} // namespace Exemplar::Python

#endif
