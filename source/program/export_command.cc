// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/words.h>
#include <exemplar/live/export_gltf.h>
#include <exemplar/live/export_page.h>
#include <exemplar/program/commands.h>

#include <fmt/core.h>

#include <iostream>

namespace Exemplar
{
  namespace
  {
    /// The name of a run's directory.
    std::string
    name_of_run(const std::string &run)
    {
      return std::filesystem::absolute(run + "/")
          .lexically_normal()
          .parent_path()
          .filename()
          .string();
    }

    /// Beside the first run, with the names of all: RUN.html, or RUN_OTHER.html.
    std::string
    page_beside(const std::vector<std::string> &runs)
    {
      std::string name;
      for (const std::string &run : runs)
        name += (name.empty() ? "" : "_") + name_of_run(run);
      const std::filesystem::path first
          = std::filesystem::path(runs.front() + "/").lexically_normal().parent_path();
      return (first.parent_path() / (name + ".html")).string();
    }

    void
    write_page(ExportOptions options)
    {
      if (options.html.empty())
        options.html = page_beside(options.runs);
      const Live::RunPage page = Live::export_page(options.runs, options.html);
      std::cout << fmt::format("{}: {}, {:.1f} MB; coordinates are rounded by {:.1e} m at most",
                               options.html, counted(page.n_frames, "frame"),
                               1e-6 * page.html.size(), page.error)
                << std::endl;
    }

    /// How surfaces pass through each other in a file of a run with contact.
    std::string
    words_of(const Live::Crossings &crossings, const Live::GltfReport &report)
    {
      const std::string obstacles
          = fmt::format("{} obstacles are in the file. ", report.n_obstacles);
      if (crossings.n_frames == 0)
        return obstacles + "No surfaces pass through each other in it that do not in the run.";
      return obstacles
             + fmt::format("Surfaces pass through each other in {} of {} frames, by {:.3e} m at "
                           "most. For less take more by --shapes.",
                           crossings.n_frames, report.n_frames, crossings.deepest);
    }

    void
    write_gltf(const ExportOptions &options)
    {
      if (options.runs.size() > 1)
        throw UserError("--gltf takes one run: call it for each.");
      const Live::GltfReport report = Live::export_gltf(
          { options.runs.front(), options.gltf, options.n_shapes, options.with_normals });
      std::cout << fmt::format("{}: {} of {} vertices in the order of the surface and {} copies at "
                               "seams, {} and {}, {:.1f} "
                               "MB; vertices are off by {:.3e} m at most, {:.3f} % of the diagonal",
                               options.gltf, counted(report.n_frames, "frame"), report.n_vertices,
                               report.n_copies,
                               counted(report.n_examples, "example"),
                               counted(report.n_shapes, "shape"), 1e-6 * report.n_bytes,
                               report.error, 100. * report.relative_error)
                << std::endl;
      if (report.crossings)
        std::cout << words_of(*report.crossings, report) << std::endl;
      for (const std::string &warning : report.warnings)
        std::cerr << "Warning: " << message_text(warning) << std::endl;
    }
  } // namespace

  void
  export_runs(const ExportOptions &options)
  {
    if (options.gltf.empty() && (options.n_shapes || options.with_normals))
      throw UserError("--shapes and --normals are those of --gltf FILE.glb.");
    if (!options.gltf.empty() && !options.html.empty())
      throw UserError("--html and --gltf write one file each: give one of them.");
    if (options.gltf.empty())
      write_page(options);
    else
      write_gltf(options);
    require_printed();
  }
} // namespace Exemplar
