// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/msh_file.h>
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
    const std::string header_of_numbers = "quantity,value\n";

    fs::path
    table_of(const MeshCommandOptions &options)
    {
      return fs::path(options.output).replace_extension(".csv");
    }

    void
    check_options(const MeshCommandOptions &options)
    {
      if (options.output.extension() != ".msh")
        throw UserError("--output: the mesh is written as .msh, found "
                        + in_quotes(options.output.string()) + ". Give a name that ends so.");
      const fs::path directory = fs::absolute(options.output).parent_path();
      if (!fs::is_directory(directory))
        throw UserError("--output: there is no directory " + directory.string()
                        + ". Make it, or write elsewhere.");
      const std::string remedy = " Give another name by --output.";
      require_writable(directory, remedy);
      for (const OwnFile &file :
           { OwnFile{ options.output, msh_beginning, msh_end(made_mesh_comment) },
             OwnFile{ table_of(options), header_of_numbers } })
        require_replaceable(file, { options.meshing.surface, options.meshing.materials }, remedy);
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
