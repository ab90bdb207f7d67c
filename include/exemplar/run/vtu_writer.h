// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtu_writer_h
#define exemplar_vtu_writer_h

#include <exemplar/mesh/mesh.h>

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

  /// Writes VTU files of a mesh: each node once and in file order, and true cell data
  /// (deal.II's DataOut repeats nodes cell by cell and has no cell data). Arrays are
  /// binary, compressed by zlib.
  class VtuWriter
  {
  public:
    explicit VtuWriter(const Mesh &mesh);

    /// The mesh with its nodes at `positions`. Not synced to the disk.
    void
    write(const std::filesystem::path  &file,
          const dealii::Vector<double> &positions,
          const VtuFields              &fields) const;

  private:
    const std::string head;           ///< to the points
    const std::string cells, regions; ///< encoded once, as no frame changes them
  };

  /// A ParaView collection of frames (time, file name).
  void
  write_pvd(const std::filesystem::path                       &file,
            const std::vector<std::pair<double, std::string>> &frames);
} // namespace Exemplar

#endif
