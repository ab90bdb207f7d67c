// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cache_motion_h
#define exemplar_cache_motion_h

#include <exemplar/body/handles.h>
#include <exemplar/run/inputs/surface_sources.h>

#include <vector>

namespace Exemplar
{
  /// The motion of a handle, of these nodes, that follows a cache. Throws UserError if there is none
  /// among the inputs, or if it is damaged or in another unit.
  Motion
  motion_by_cache(const SurfaceSources            &from,
                  const HandleParameters          &handle,
                  const std::vector<unsigned int> &nodes);
} // namespace Exemplar

#endif
