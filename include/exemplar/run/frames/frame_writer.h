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
  /// The data of a frame. It holds copies, so that it can be written during the next step. Vectors
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
    /// Positions of the vertices of the body's surface in the unit of its file; empty unless a
    /// format shows it.
    std::vector<SurfaceMesh::Vertex> surface   = {};
    std::vector<SurfaceMesh::Vertex> obstacles = {}; ///< the same of theirs, ObstaclePicture
    /// Velocities of `surface` in that unit a second; empty unless dynamic, and a format shows them.
    std::vector<SurfaceMesh::Vertex> surface_velocities = {};
    std::optional<SpaceError>        space_error        = {};
    std::vector<NodalField>          fields             = {}; ///< of the potential's terms
  };

  /// A frame that is on disk.
  struct WrittenFrame
  {
    double                time; ///< [s]
    std::filesystem::path file;
    std::filesystem::path obstacles = {}; ///< the file that shows them; empty: none
  };

  /// Writes frames of one mesh in one format.
  class FrameWriter
  {
  public:
    virtual ~FrameWriter() = default;

    /// Write a frame to a file atomically. May be called from another thread, but no two calls
    /// overlap. May throw any std::exception.
    virtual void
    write(const Frame &frame, const std::filesystem::path &file) const = 0;

    /// Write the animation of a run's frames, which are in order of time. Only called for formats
    /// with animations.
    virtual void
    write_animation(const std::vector<WrittenFrame> &frames,
                    const std::filesystem::path     &file) const = 0;
  };
} // namespace Exemplar

#endif
