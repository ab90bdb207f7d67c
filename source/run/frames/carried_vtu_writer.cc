// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/vtu_parts.h>

#include <fmt/core.h>

#include <cstdint>
#include <memory>

namespace Exemplar
{
  namespace
  {
    constexpr std::uint8_t vtk_polygon = 7;

    /// Writes a carried surface, in metres as the body's frames.
    class CarriedVtuWriter : public FrameWriter
    {
    public:
      CarriedVtuWriter(const SurfaceMesh &surface, const double scale, const bool shows_obstacles)
          : rest(surface.vertices), scale(scale),
            piece(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                              surface.vertices.size(),
                              surface.faces.size())),
            polygons(cells_of_grid(
                surface.faces.size(), vtk_polygon, [&](const unsigned int face) -> const auto & {
                  return surface.faces[face];
                }))
      {
        const std::vector<std::int32_t> numbers(surface.face_groups.begin(),
                                                surface.face_groups.end());
        std::ostringstream              of_polygons;
        write_array(of_polygons, "Int32", "obstacle", 1, numbers.data(), numbers.size());
        if (shows_obstacles)
          cell_data = "<CellData>\n" + of_polygons.str() + "</CellData>\n";
      }

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        std::vector<double> places, displacement;
        for (std::size_t v = 0; v < rest.size(); ++v)
          for (unsigned int c = 0; c < 3; ++c)
          {
            places.push_back(scale * frame.surface[v][c]);
            displacement.push_back(scale * (frame.surface[v][c] - rest[v][c]));
          }
        AtomicFile    atomic_file(file);
        std::ostream &out = atomic_file.stream();
        out << head_of_grid() << piece << "<Points>\n";
        write_array(out, "Float64", "Points", 3, places.data(), places.size());
        out << "</Points>\n" << polygons << "<PointData>\n";
        write_array(out, "Float64", "displacement", 3, displacement.data(), displacement.size());
        out << "</PointData>\n" << cell_data << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &frames,
                      const std::filesystem::path     &file) const override
      {
        write_collection(frames, file);
      }

    private:
      const std::vector<SurfaceMesh::Vertex> rest;
      const double                           scale; ///< metres per unit of the file
      const std::string                      piece, polygons;
      std::string                            cell_data; ///< which obstacle each polygon is of
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_carried_vtu_writer(const FrameSubject &subject)
  {
    return std::make_unique<const CarriedVtuWriter>(*subject.surface, subject.mesh.get_scale(),
                                                    subject.carried == name_of_obstacles);
  }
} // namespace Exemplar
