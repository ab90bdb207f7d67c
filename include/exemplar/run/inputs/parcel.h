// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parcel_h
#define exemplar_parcel_h

#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/inputs/parting.h>

#include <mpi.h>
#include <string>

namespace Exemplar
{
  /// A process' part of a body, as a message.
  struct Parcel
  {
    std::string error; ///< why there is none; empty if there is one
    SharedNodes nodes;
    MeshPart    mesh;
    BodyFields  fields;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &error &nodes &mesh &fields;
    }
  };

  /// A process' part of a whole body.
  Parcel
  parcel_of(const BodyInputs &whole, const PartOfBody &part);

  /// Send to another process, which calls receive().
  void
  send(const Parcel &parcel, unsigned int process, MPI_Comm communicator);

  /// Receive from the root.
  Parcel
  receive(MPI_Comm communicator);
} // namespace Exemplar

#endif
