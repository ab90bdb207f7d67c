// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/text_file.h>
#include <exemplar/program/mesh_command.h>

#include <algorithm>
#include <iostream>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    void
    check_options(const MeshCommandOptions &options)
    {
      constexpr unsigned int least = 10, most = 10000000;
      const unsigned int     n = options.meshing.n_cells;
      if (n < least || n > most)
        throw UserError("--cells: the number of tetrahedra must be from " + std::to_string(least)
                        + " to " + std::to_string(most) + ", found " + std::to_string(n) + ".");
      if (options.output.extension() != ".msh")
        throw UserError("--output: the mesh is written as .msh, found "
                        + in_quotes(options.output.string()) + ". Give a name that ends so.");
      const fs::path directory = fs::absolute(options.output).parent_path();
      if (!fs::is_directory(directory))
        throw UserError("--output: there is no directory " + directory.string()
                        + ". Make it, or write elsewhere.");
    }

    void
    write_table(const MeshedSurface &meshed, const fs::path &file)
    {
      AtomicFile out(file);
      write_csv_header(out.stream(), { { "quantity", "" }, { "value", "" } });
      for (const auto &[what, value] : meshed.table)
        write_csv_cells(out.stream(), { { "", what }, { "", value } });
      out.commit();
    }

    void
    print(const MeshedSurface &meshed, const fs::path &file)
    {
      for (const std::string &note : meshed.notes)
        std::cout << message_text(note) << '\n';
      for (const auto &[what, value] : meshed.table)
        std::cout << what << std::string(24 - std::min<std::size_t>(what.size(), 23), ' ') << value
                  << '\n';
      std::cout << "written to " << message_text(file.string()) << '\n';
    }
  } // namespace

  void
  run_mesh_command(const MeshCommandOptions &options)
  {
    check_options(options);
    const MeshedSurface meshed = mesh_surface(options.meshing);
    write_msh(meshed.mesh, options.output);
    write_table(meshed, fs::path(options.output).replace_extension(".csv"));
    if (!options.quiet)
      print(meshed, options.output);
    require_printed();
  }
} // namespace Exemplar
