// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/vtu_parts.h>

#include <fmt/core.h>

#include <cstdint>
#include <memory>
#include <ostream>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    std::string
    piece_of(const FESpace &fe_space)
    {
      return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                         fe_space.numbering().n_places(), fe_space.n_cells());
    }

    std::string
    cells_of(const FESpace &fe_space)
    {
      constexpr unsigned char vtk_triangle = 5;
      return cells_of_grid(fe_space.n_cells(),
                           fe_space.is_shell() ? vtk_triangle
                                               : traits_of(fe_space.element()).vtk_type,
                           [&](const unsigned int cell) { return fe_space.nodes(cell); });
    }

    std::string
    regions_of(const Mesh &mesh)
    {
      const std::vector<std::int32_t> region(mesh.get_material_ids().begin(),
                                             mesh.get_material_ids().end());
      std::ostringstream              out;
      write_array(out, "Int32", "region", 1, region.data(), region.size());
      return out.str();
    }

    void
    write_vector(std::ostream &out, const std::string &name, const Vector &values)
    {
      write_array(out, "Float64", name, 3, values.begin(), values.size());
    }

    void
    write_scalars(std::ostream &out, const std::string &name, const std::vector<double> &values)
    {
      write_array(out, "Float64", name, 1, values.data(), values.size());
    }

    /// Write the errors as field data of the whole frame.
    void
    write_errors(std::ostream &out, const SpaceError &error)
    {
      out << "<FieldData>\n";
      const auto write = [&](const std::string &of_what, const double value)
      {
        out << "<DataArray type=\"Float64\" Name=\"space_error_" << of_what
            << "\" NumberOfTuples=\"1\" format=\"binary\">" << encode_binary(&value, sizeof(value))
            << "</DataArray>\n";
      };
      write("displacement", error.displacement);
      write("energy", error.energy);
      if (error.weights)
        write("weights", *error.weights);
      out << "</FieldData>\n";
    }

    /// Writes VTU files: each node once and in the order of FESpace, and true cell data (deal.II's
    /// DataOut repeats nodes cell by cell and has no cell data). Arrays are binary, compressed by
    /// zlib. The animation is a ParaView collection.
    class VtuWriter : public FrameWriter
    {
    public:
      VtuWriter(const Mesh &mesh, const FESpace &fe_space)
          : head(head_of_grid()), piece(piece_of(fe_space)), cells(cells_of(fe_space)),
            regions(regions_of(mesh)), name_of_ratio(mesh.is_shell() ? "area_ratio" : "det_F")
      {
      }

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        AtomicFile    atomic_file(file);
        std::ostream &out = atomic_file.stream();
        out << head;
        if (frame.space_error && frame.space_error->failure.empty())
          write_errors(out, *frame.space_error);
        out << piece << "<Points>\n";
        write_vector(out, "Points", frame.positions);
        out << "</Points>\n" << cells << "<PointData>\n";
        write_vector(out, "displacement", frame.displacement);
        if (frame.velocities.size() > 0)
          write_vector(out, "velocity", frame.velocities);
        for (const NodalField &field : frame.fields)
          if (field.n_components == 1)
            write_scalars(out, field.name, { field.values.begin(), field.values.end() });
          else
            write_vector(out, field.name, field.values);
        out << "</PointData>\n<CellData>\n";
        write_scalars(out, "strain_energy_density", frame.cells.strain_energy_density);
        write_scalars(out, name_of_ratio, frame.cells.det_F);
        if (!frame.cells.von_mises_stress.empty())
          write_scalars(out, "von_mises_stress", frame.cells.von_mises_stress);
        if (!frame.cells.plastic_strain.empty())
          write_scalars(out, "plastic_strain", frame.cells.plastic_strain);
        if (frame.space_error && frame.space_error->failure.empty())
          write_scalars(out, "space_error", frame.space_error->energy_density);
        if (!frame.cells.weight_region.empty())
          write_array(out, "Int32", "weight_region", 1, frame.cells.weight_region.data(),
                      frame.cells.weight_region.size());
        out << regions << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &frames,
                      const std::filesystem::path     &file) const override
      {
        write_collection(frames, file);
      }

    private:
      const std::string head, piece;    ///< up to the points
      const std::string cells, regions; ///< encoded once, the same in all frames
      const std::string name_of_ratio;
    };
  } // namespace

  void
  write_joint_vtu(const Frame                    &frame,
                  const std::vector<std::string> &pieces,
                  const std::filesystem::path    &file)
  {
    AtomicFile    atomic_file(file);
    std::ostream &out     = atomic_file.stream();
    const auto    declare = [&](const std::string &type, const std::string &name, const int n)
    {
      out << "<PDataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
          << n << "\"/>\n";
    };
    out << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n<PPoints>\n";
    declare("Float64", "Points", 3);
    out << "</PPoints>\n<PPointData>\n";
    declare("Float64", "displacement", 3);
    if (frame.velocities.size() > 0)
      declare("Float64", "velocity", 3);
    for (const NodalField &field : frame.fields)
      declare("Float64", field.name, static_cast<int>(field.n_components));
    out << "</PPointData>\n<PCellData>\n";
    for (const std::string name : { "strain_energy_density", "det_F", "von_mises_stress" })
      declare("Float64", name, 1);
    if (!frame.cells.plastic_strain.empty())
      declare("Float64", "plastic_strain", 1);
    if (!frame.cells.weight_region.empty())
      declare("Int32", "weight_region", 1);
    declare("Int32", "region", 1);
    out << "</PCellData>\n";
    for (const std::string &piece : pieces)
      out << "<Piece Source=\"" << piece << "\"/>\n";
    out << "</PUnstructuredGrid>\n</VTKFile>\n";
    atomic_file.commit_without_sync();
  }

  std::unique_ptr<const FrameWriter>
  make_vtu_writer(const FrameSubject &subject)
  {
    return std::make_unique<const VtuWriter>(subject.mesh, subject.fe_space);
  }
} // namespace Exemplar
