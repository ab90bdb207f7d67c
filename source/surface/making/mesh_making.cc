// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/confinement.h>
#include <exemplar/base/process_copy.h>
#include <exemplar/base/shared_value.h>
#include <exemplar/mesh/msh_comment.h>
#include <exemplar/surface/making/mesh_making.h>
#include <exemplar/surface/making/parted_sheets.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Time limit of a mesh [s]: far more than any has taken.
    double
    time_limit(const SurfaceMeshingOptions &options)
    {
      std::error_code none;
      const auto      n_bytes = std::filesystem::file_size(options.surface, none);
      return std::ceil(60. + .03 * options.n_cells
                       + (none ? 0. : 1e-4 * static_cast<double>(n_bytes)));
    }

    std::string
    to_text(const MeshingReport &report)
    {
      const Json json{ { "table", report.table }, { "notes", report.notes } };
      return json.dump(-1, ' ', true, Json::error_handler_t::replace);
    }
  } // namespace

  const std::string made_mesh_comment = "a mesh by exemplar";

  std::string
  make_mesh(const SurfaceMeshingOptions &options, const ShowMeshing &show)
  {
    SharedValue<MeshingPoint> point({});
    const auto                work = [&]
    {
      std::vector<std::filesystem::path> files{ options.surface, options.materials };
      files.insert(files.end(), options.poses.begin(), options.poses.end());
      confine_this_process(files);
      SurfaceMeshingOptions here = options;
      here.tell                  = [&](const MeshingStage stage)
      {
        const MeshingPoint last     = point.load();
        const bool         is_again = stage == last.stage && stage == MeshingStage::filling;
        point.store({ stage, static_cast<unsigned short>(is_again ? last.attempt + 1 : 1) });
      };
      const MeshedSurface meshed = here.poses.empty() ? mesh_surface(here) : mesh_parted(here);
      return with_comment(msh_text(meshed.mesh), to_text(meshed.report));
    };
    return in_process_copy(
        work, { options.surface.string() + ": filling the surface with cells",
                "Ask for another number of cells (" + options.cells_option
                    + "), or clean the surface in the program that made it, for instance by a "
                      "remesh.",
                time_limit(options),
                [&]
                {
                  if (show)
                    show(point.load());
                } });
  }

  MeshingReport
  make_mesh_file(const SurfaceMeshingOptions &options,
                 const std::filesystem::path &msh,
                 const ShowMeshing           &show)
  {
    const std::string made = make_mesh(options, show);
    AtomicFile        file(msh);
    file.stream() << without_comment(made) << msh_end(made_mesh_comment);
    file.commit();
    return report_in(made);
  }

  MeshingReport
  report_in(const std::string &msh)
  {
    const Json json = Json::parse(comment_of(msh));
    return { json.at("table").get<decltype(MeshingReport::table)>(),
             json.at("notes").get<std::vector<std::string>>() };
  }
} // namespace Exemplar
