// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frame_writer_h
#define exemplar_frame_writer_h

#include <exemplar/algebra/vector.h>
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/run/frames/space_error.h>
#include <exemplar/surface/shape/surface_mesh.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace Exemplar
{
  /// What a frame shows. It holds copies, so it can be written while the problem goes on. Vectors
  /// have three values a node, in the order of FESpace: that of the mesh file, then nodes on edges.
  /// Cells are in the order of the mesh file.
  struct Frame
  {
    unsigned int step = 0;
    double       time = 0.;    ///< [s]
    Vector       positions;    ///< [m]
    Vector       displacement; ///< from the rest pose [m]
    Vector       velocities;   ///< [m/s]; empty unless dynamic
    CellResults  cells;
    /// Places of the vertices of the body's surface in the unit of its file; empty unless a format
    /// shows it.
    std::vector<SurfaceMesh::Vertex> surface     = {};
    std::optional<SpaceError>        space_error = {};
    std::vector<NodalField>          fields      = {}; ///< of the potential's terms
  };

  /// A frame that is on disk.
  struct WrittenFrame
  {
    double                time; ///< [s]
    std::filesystem::path file;
  };

  /// Writes frames of one mesh in one format.
  class FrameWriter
  {
  public:
    virtual ~FrameWriter() = default;

    /// Write a frame to a file of its own that appears whole or not at all. Another thread may
    /// call this, but never while one of these functions runs. May throw any std::exception.
    virtual void
    write(const Frame &frame, const std::filesystem::path &file) const = 0;

    /// Write the file that shows all frames of a run, which come in order of time. Only called
    /// for formats that have such a file.
    virtual void
    write_animation(const std::vector<WrittenFrame> &frames,
                    const std::filesystem::path     &file) const = 0;
  };
} // namespace Exemplar

#endif
