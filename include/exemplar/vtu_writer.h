// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtu_writer_h
#define exemplar_vtu_writer_h

#include <exemplar/mesh.h>

#include <deal.II/lac/vector.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Fields of one frame. Point vectors have three values a node, in file order.
  struct VtuFields
  {
    std::vector<std::pair<std::string, const dealii::Vector<double> *>> point_vectors;
    std::vector<std::pair<std::string, const std::vector<double> *>>    cell_scalars;
  };

  /// Write a VTU file with the mesh's nodes at `positions`: each node once and in
  /// file order, and true cell data (deal.II's DataOut repeats nodes cell by cell and
  /// has no cell data). Arrays are binary, compressed by zlib.
  void
  write_vtu(const std::filesystem::path  &file,
            const Mesh                   &mesh,
            const dealii::Vector<double> &positions,
            const VtuFields              &fields);

  /// A ParaView collection of frames (time, file name).
  void
  write_pvd(const std::filesystem::path                       &file,
            const std::vector<std::pair<double, std::string>> &frames);
} // namespace Exemplar

#endif
