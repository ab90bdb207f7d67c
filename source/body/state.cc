// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/state.h>
#include <exemplar/mesh/mesh.h>

#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/vector.hpp>

#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// Serialised bytes; states are equal if these are.
    std::string
    bytes_of(const State &state)
    {
      std::ostringstream bytes;
      boost::archive::binary_oarchive(bytes, boost::archive::no_header) << state;
      return bytes.str();
    }
  } // namespace

  bool
  operator==(const State &a, const State &b)
  {
    return bytes_of(a) == bytes_of(b);
  }

  State
  whole(const Mesh &mesh, State state)
  {
    for (Vector *field : state.nodal_fields())
      *field = whole(mesh.exchange(), *field);
    state.history = mesh.cell_order().whole(state.history);
    return state;
  }

  State
  part(const Mesh &mesh, State state)
  {
    for (Vector *field : state.nodal_fields())
      *field = part(mesh.exchange(), *field);
    state.history = mesh.cell_order().part(state.history);
    return state;
  }
} // namespace Exemplar
