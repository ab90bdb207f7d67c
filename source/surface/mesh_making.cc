// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/process_copy.h>
#include <exemplar/surface/mesh_making.h>

#include <nlohmann/json.hpp>

namespace Exemplar
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// What a mesh is allowed [s]: far more than any has taken, but not for ever.
    double
    time_limit(const SurfaceMeshingOptions &options)
    {
      std::error_code none;
      const auto      n_bytes = std::filesystem::file_size(options.surface, none);
      return 60. + .03 * options.n_cells + (none ? 0. : 1e-4 * static_cast<double>(n_bytes));
    }
  } // namespace

  const std::string made_mesh_comment = "a mesh by exemplar";

  MeshingReport
  make_mesh_file(const SurfaceMeshingOptions &options, const std::filesystem::path &msh)
  {
    return report_from_text(in_process_copy(
        [&]
        {
          const MeshedSurface meshed = mesh_surface(options);
          write_msh(meshed.mesh, msh, made_mesh_comment);
          return to_text(meshed.report);
        },
        time_limit(options), options.surface.string() + ": filling the surface with cells",
        "Ask for another number of cells (" + options.cells_option
            + "), or clean the surface in the program that made it, for instance by a remesh."));
  }

  std::string
  to_text(const MeshingReport &report)
  {
    const Json json{ { "table", report.table }, { "notes", report.notes } };
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
  }

  MeshingReport
  report_from_text(const std::string &text)
  {
    const Json json = Json::parse(text);
    return { json.at("table").get<decltype(MeshingReport::table)>(),
             json.at("notes").get<std::vector<std::string>>() };
  }
} // namespace Exemplar
