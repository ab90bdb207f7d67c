// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/progress.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/mesh/msh_file.h>
#include <exemplar/program/commands.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/surface/files/numbered_files.h>
#include <exemplar/surface/making/mesh_making.h>
#include <exemplar/surface/shape/surface_faults.h>

#include <fmt/core.h>

#include <algorithm>
#include <iostream>
#include <unistd.h>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string header_of_numbers = "quantity,value\n";

    fs::path
    table_of(const MeshCommandOptions &options)
    {
      return fs::path(options.output).replace_extension(".csv");
    }

    /// Throws UserError unless the file can be created or replaced.
    void
    require_output(const OwnFile            &file,
                   const MeshCommandOptions &options,
                   const std::string        &option)
    {
      const fs::path    directory = fs::absolute(file.path).parent_path();
      const std::string remedy    = " Give another name by " + option + ".";
      if (!fs::is_directory(directory))
        throw UserError(option + ": there is no directory " + directory.string()
                        + ". Make it, or write elsewhere.");
      require_writable(directory, remedy);
      require_replaceable(file, { options.meshing.surface, options.meshing.materials }, remedy);
    }

    void
    check_options(const MeshCommandOptions &options)
    {
      if (options.output.extension() != ".msh")
        throw UserError("--output: the mesh is written as .msh, found "
                        + in_quotes(options.output.string()) + ". Give a name that ends so.");
      for (const OwnFile &file :
           { OwnFile{ options.output, msh_beginning, msh_end(made_mesh_comment) },
             OwnFile{ table_of(options), header_of_numbers } })
        require_output(file, options, "--output");
    }

    void
    write_table(const MeshingReport &report, const fs::path &file)
    {
      AtomicFile out(file);
      out.stream() << header_of_numbers;
      for (const auto &[what, value] : report.table)
        write_csv_cells(out.stream(), { { "", what }, { "", value } });
      out.commit();
    }

    /// Add a note if the unit of length is probably not the metre.
    void
    add_unit(MeshingReport &report)
    {
      for (const auto &[what, value] : report.table)
        if (const double size = what == "diagonal" ? std::stod(value) : 1.;
            size > 50. || size < 1e-3)
          report.notes.push_back("The diagonal is " + value
                                 + ". Scenes take metres: set Mesh/Scale (0.001 for millimetres).");
    }

    void
    print(const MeshingReport &report, const fs::path &file)
    {
      for (const std::string &note : report.notes)
        std::cout << message_text(note) << '\n';
      for (const auto &[what, value] : report.table)
        std::cout << what << std::string(24 - std::min<std::size_t>(what.size(), 23), ' ') << value
                  << '\n';
      std::cout << "written to " << message_text(file.string()) << '\n';
    }

    /// Files of the poses, with patterns expanded.
    std::vector<fs::path>
    pose_files(const SurfaceMeshingOptions &meshing)
    {
      std::vector<std::string> entries;
      for (const fs::path &entry : meshing.poses)
        entries.push_back(entry.string());
      const std::vector<fs::path> files = expand_patterns(entries);
      for (const fs::path &file : files)
        require_file(file, "a pose: an .obj, .ply or .stl file", meshing.surface);
      return files;
    }

    std::string
    name_of(const MeshingPoint &point)
    {
      switch (point.stage)
      {
      case MeshingStage::checking:
        return "checking the surface";
      case MeshingStage::thinning:
        return "looking for dense triangles";
      case MeshingStage::filling:
        return fmt::format("filling it, attempt {}", point.attempt);
      default:
        return "measuring";
      }
    }

    /// Make the mesh, with a progress bar if on a terminal.
    MeshingReport
    make_shown(const SurfaceMeshingOptions &meshing, const MeshCommandOptions &options)
    {
      constexpr unsigned int n_stages    = 4;
      const bool             is_terminal = isatty(STDOUT_FILENO) != 0;
      Progress progress(std::cout, is_terminal, options.quiet || !is_terminal, 0, n_stages,
                        "stage");
      return make_mesh_file(
          meshing, options.output,
          [&](const MeshingPoint &point)
          { progress.go_on_with(static_cast<unsigned int>(point.stage) + 1, name_of(point)); });
    }

    void
    list_faults(const MeshCommandOptions &options)
    {
      if (!options.output.empty())
        throw UserError("--list-faults writes a table instead of a mesh, and --output names a "
                        "mesh: give one of them.");
      if (options.faults.extension() != ".csv")
        throw UserError("--list-faults: the table is written as .csv, found "
                        + in_quotes(options.faults.string()) + ". Give a name that ends so.");
      require_output({ options.faults, header_of_faults }, options, "--list-faults");
      const std::string table = table_of_faults(options.meshing.surface);
      AtomicFile        out(options.faults);
      out.stream() << table;
      out.commit();
      if (!options.quiet)
        std::cout << std::count(table.begin(), table.end(), '\n') - 1
                  << " faces and vertices with faults, written to "
                  << message_text(options.faults.string()) << '\n';
    }
  } // namespace

  void
  run_mesh_command(const MeshCommandOptions &options)
  {
    if (is_surface_file(options.meshing.surface.string()))
      require_file(options.meshing.surface, "a surface: an .obj, .ply or .stl file");
    if (!options.faults.empty())
    {
      list_faults(options);
      return require_printed();
    }
    check_options(options);
    SurfaceMeshingOptions meshing = options.meshing;
    meshing.poses                 = pose_files(options.meshing);
    MeshingReport report          = make_shown(meshing, options);
    add_unit(report);
    write_table(report, table_of(options));
    if (!options.quiet)
      print(report, options.output);
    require_printed();
  }
} // namespace Exemplar
