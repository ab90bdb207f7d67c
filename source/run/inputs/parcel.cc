// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/inputs/parcel.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <limits>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    constexpr int message_tag = 16;

    /// MPI counts the bytes of a message in an int.
    constexpr std::size_t message_size = std::numeric_limits<int>::max();

    std::vector<unsigned int>
    without_gaps(std::vector<unsigned int> numbers)
    {
      std::vector<unsigned int> present = numbers;
      std::sort(present.begin(), present.end());
      present.erase(std::unique(present.begin(), present.end()), present.end());
      for (unsigned int &number : numbers)
        number = static_cast<unsigned int>(std::lower_bound(present.begin(), present.end(), number)
                                           - present.begin());
      return numbers;
    }

    /// The indices in `vertices` (ascending) of those `nodes` that it contains.
    std::vector<unsigned int>
    places_among(const std::vector<unsigned int> &vertices, const std::vector<unsigned int> &nodes)
    {
      std::vector<unsigned int> places;
      for (const unsigned int node : nodes)
        if (const auto found = std::lower_bound(vertices.begin(), vertices.end(), node);
            found != vertices.end() && *found == node)
          places.push_back(static_cast<unsigned int>(found - vertices.begin()));
      return places;
    }

    /// The fields of a part; `vertices` are the part's nodes of the mesh file.
    BodyFields
    part_of(const BodyFields                &whole,
            const PartOfBody                &part,
            const std::vector<unsigned int> &vertices,
            const unsigned int               n_vertices_of_whole)
    {
      BodyFields own;
      own.material = whole.material.part(part.cells);
      if (!whole.patches.empty())
        own.patches = without_gaps(chosen(whole.patches, part.cells));
      for (const std::vector<double> &share : whole.shares)
        own.shares.push_back(chosen(share, part.cells));
      for (const auto &[name, places] : whole.poses)
        own.poses[name]
            = chosen(places, places.size() > n_vertices_of_whole ? part.nodes.in_files : vertices);
      for (const auto &[text, nodes] : whole.nodes)
        own.nodes[text] = places_among(vertices, nodes);
      own.obstacles = whole.obstacles;
      own.weights   = whole.weights;
      own.support   = whole.support;
      return own;
    }
  } // namespace

  Parcel
  parcel_of(const BodyInputs &whole, const PartOfBody &part)
  {
    const std::vector<unsigned int> &nodes = part.nodes.in_files;
    const unsigned int               n     = whole.mesh.n_nodes();
    const std::vector<unsigned int>  vertices(nodes.begin(),
                                              std::lower_bound(nodes.begin(), nodes.end(), n));
    return { "", part.nodes, part_of(whole.mesh, vertices, part.cells, part.faces),
             part_of(whole.fields, part, vertices, n) };
  }

  void
  send(const Parcel &parcel, const unsigned int process, const MPI_Comm communicator)
  {
    std::ostringstream out;
    {
      boost::archive::binary_oarchive archive(out);
      archive << parcel;
    }
    const std::string  bytes = out.str();
    unsigned long long size  = bytes.size();
    MPI_Send(&size, 1, MPI_UNSIGNED_LONG_LONG, static_cast<int>(process), message_tag,
             communicator);
    for (std::size_t first = 0; first < bytes.size(); first += message_size)
      MPI_Send(bytes.data() + first, static_cast<int>(std::min(message_size, bytes.size() - first)),
               MPI_CHAR, static_cast<int>(process), message_tag, communicator);
  }

  Parcel
  receive(const MPI_Comm communicator)
  {
    unsigned long long size = 0;
    MPI_Recv(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, message_tag, communicator, MPI_STATUS_IGNORE);
    std::string bytes(size, '\0');
    for (std::size_t first = 0; first < bytes.size(); first += message_size)
      MPI_Recv(bytes.data() + first, static_cast<int>(std::min(message_size, bytes.size() - first)),
               MPI_CHAR, 0, message_tag, communicator, MPI_STATUS_IGNORE);
    std::istringstream              in(bytes);
    boost::archive::binary_iarchive archive(in);
    Parcel                          parcel;
    archive >> parcel;
    return parcel;
  }
} // namespace Exemplar
