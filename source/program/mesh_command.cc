// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/program/mesh_command.h>
#include <exemplar/run/output_directory.h>
#include <exemplar/surface/mesh_making.h>

#include <algorithm>
#include <iostream>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    fs::path
    table_of(const MeshCommandOptions &options)
    {
      return fs::path(options.output).replace_extension(".csv");
    }

    void
    check_options(const MeshCommandOptions &options)
    {
      const unsigned int n = options.meshing.n_cells;
      if (n < least_n_cells || n > most_n_cells)
        throw UserError("--cells: the number of tetrahedra must be from "
                        + std::to_string(least_n_cells) + " to " + std::to_string(most_n_cells)
                        + ", found " + std::to_string(n) + ".");
      if (options.output.extension() != ".msh")
        throw UserError("--output: the mesh is written as .msh, found "
                        + in_quotes(options.output.string()) + ". Give a name that ends so.");
      const fs::path directory = fs::absolute(options.output).parent_path();
      if (!fs::is_directory(directory))
        throw UserError("--output: there is no directory " + directory.string()
                        + ". Make it, or write elsewhere.");
      const std::string remedy = " Give another name by --output.";
      require_writable(directory, remedy);
      for (const fs::path &file : { options.output, table_of(options) })
        require_replaceable(file, { options.meshing.surface, options.meshing.materials }, remedy);
    }

    void
    write_table(const MeshingReport &report, const fs::path &file)
    {
      AtomicFile out(file);
      write_csv_header(out.stream(), { { "quantity", "" }, { "value", "" } });
      for (const auto &[what, value] : report.table)
        write_csv_cells(out.stream(), { { "", what }, { "", value } });
      out.commit();
    }

    /// A note where the unit of length is no metre, probably.
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
  } // namespace

  void
  run_mesh_command(const MeshCommandOptions &options)
  {
    check_options(options);
    MeshingReport report = make_mesh_file(options.meshing, options.output);
    add_unit(report);
    write_table(report, table_of(options));
    if (!options.quiet)
      print(report, options.output);
    require_printed();
  }
} // namespace Exemplar
