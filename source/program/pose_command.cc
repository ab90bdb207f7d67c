// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/progress.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/pose_command.h>
#include <exemplar/surface/numbered_files.h>
#include <exemplar/surface/pose_transfer.h>
#include <exemplar/surface/surface_poses.h>

#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    /// A pose on its way from a surface to a mesh.
    struct PoseFile
    {
      fs::path    file, output;
      SurfaceMesh surface;
      PoseQuality quality;
      double      seconds = 0.;
    };

    void
    show_warning(const std::string &warning)
    {
      std::cerr << "Warning: " << message_text(warning) << std::endl;
    }

    SurfaceMesh
    read_checked(const fs::path &file)
    {
      SurfaceMesh surface = read_surface(file);
      require_surface(surface, file.string());
      return surface;
    }

    /// The files to write, each for one pose, and none of them an input.
    std::vector<PoseFile>
    plan(const PoseOptions &options)
    {
      std::vector<PoseFile>        poses;
      std::map<fs::path, fs::path> input_of;
      for (const fs::path &file : expand_patterns(options.poses))
      {
        const fs::path output       = options.output / (file.stem().string() + ".msh");
        const auto [before, is_new] = input_of.emplace(output, file);
        if (!is_new)
          throw UserError("The poses " + before->second.string() + " and " + file.string()
                          + " would both be written to " + output.string()
                          + ". Give each a name of its own, or take two directories.");
        std::error_code none;
        if (fs::equivalent(output, options.mesh, none))
          throw UserError(output.string() + " is the mesh, and would be overwritten by the pose "
                          + file.string() + ". Give another directory by --output.");
        poses.push_back({ file, output, {}, {}, 0. });
      }
      return poses;
    }

    void
    read_poses(const PoseOptions &options, const SurfaceMesh &rest, std::vector<PoseFile> &poses)
    {
      for (PoseFile &pose : poses)
      {
        pose.surface = read_checked(pose.file);
        check_same_order(rest, options.rest.string(), pose.surface, pose.file.string());
        check_pose(rest, options.rest.string(), pose.surface, pose.file.string());
        if (is_at_rest(rest, pose.surface))
          show_warning(pose.file.string() + " is the same as " + options.rest.string()
                       + ": the pose is the mesh at rest.");
      }
    }

    std::string
    inverted_elements(const Mesh &mesh, const std::vector<double> &determinants)
    {
      std::vector<std::size_t> numbers;
      for (unsigned int c = 0; c < determinants.size(); ++c)
        if (!(determinants[c] > FoldSolver::margin))
          numbers.push_back(mesh.element_number(c));
      return list_numbers(numbers);
    }

    void
    write_csv(const std::vector<PoseFile> &poses, const std::size_t n_done, const fs::path &file)
    {
      AtomicFile csv(file);
      csv.stream() << "pose,inverted_cells,min_det_F,max_det_F,stretch_min,stretch_1,stretch_99,"
                      "stretch_max,surface_error_mean,surface_error_max,rotation,shift,seconds\n";
      for (std::size_t k = 0; k < n_done; ++k)
      {
        const PoseQuality &q = poses[k].quality;
        csv.stream() << poses[k].file.stem().string() << ',' << q.n_inverted;
        for (const double value :
             { q.least_det, q.greatest_det, q.least_stretch, q.stretch_1, q.stretch_99,
               q.greatest_stretch, 100. * q.mean_error, 100. * q.greatest_error, q.rotation,
               q.shift, poses[k].seconds })
          csv.stream() << ',' << shortest_text(value);
        csv.stream() << '\n';
      }
      csv.commit();
    }

    void
    print_table(const std::vector<PoseFile> &poses, const std::size_t n_done)
    {
      std::size_t width = 4;
      for (const PoseFile &pose : poses)
        width = std::max(width, printable(pose.file.stem().string()).size());
      std::cout
          << std::left << std::setw(static_cast<int>(width)) << "pose"
          << "  inverted   det F            stretch, least 1 % 99 % most     surface error %  "
             "rotation  time\n";
      for (std::size_t k = 0; k < n_done; ++k)
      {
        const PoseQuality &q = poses[k].quality;
        char               line[160];
        std::snprintf(
            line, sizeof(line),
            "  %8u   %.3f to %6.3f  %8.3f %7.3f %6.3f %6.3f   %6.3f %6.3f   %6.1f  %5.1f s",
            q.n_inverted, q.least_det, q.greatest_det, q.least_stretch, q.stretch_1, q.stretch_99,
            q.greatest_stretch, 100. * q.mean_error, 100. * q.greatest_error, q.rotation,
            poses[k].seconds);
        std::cout << std::left << std::setw(static_cast<int>(width))
                  << printable(poses[k].file.stem().string()) << line << '\n';
      }
      std::cout << std::flush;
    }

    /// Writes the pose, or returns the elements that stay inverted in it.
    std::string
    carry(PoseTransfer &transfer, const Mesh &mesh, PoseFile &pose)
    {
      const auto begin = std::chrono::steady_clock::now();
      const auto x     = transfer.carry(pose.surface.vertices, pose.quality);
      pose.seconds
          = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (pose.quality.least_det > FoldSolver::margin)
      {
        mesh.write_pose(x, pose.output);
        return "";
      }
      return "\n  " + pose.file.string() + ": element "
             + inverted_elements(mesh, transfer.determinants(x));
    }

    PoseTransfer
    make_transfer(const PoseOptions &options, const Mesh &mesh, const SurfaceMesh &rest)
    {
      const SurfaceAttachment attachment(mesh.get_nodes(), mesh.get_boundary_faces(),
                                         triangulate(rest));
      check_attachment(attachment, mesh, options.rest.string());
      PoseTransfer transfer(mesh.get_nodes(), mesh.get_cells(), attachment, options.attach);
      transfer.measure_by(rest, mesh);
      return transfer;
    }
  } // namespace

  void
  carry_poses(const PoseOptions &options)
  {
    std::vector<PoseFile> poses = plan(options);
    const Mesh            mesh(read_msh(options.mesh), options.mesh.string());
    const SurfaceMesh     rest = read_checked(options.rest);
    read_poses(options, rest, poses);
    PoseTransfer transfer = make_transfer(options, mesh, rest);
    for (const std::string &warning : mesh.get_warnings())
      show_warning(warning);
    fs::create_directories(options.output);

    is_interrupted(); // from now on a signal waits until a pose is done
    Progress    progress(std::cout, isatty(STDOUT_FILENO) != 0, options.quiet, 0,
                         static_cast<unsigned int>(poses.size()), "pose");
    std::string failures;
    std::size_t n_done = 0;
    while (n_done < poses.size() && !is_interrupted())
    {
      PoseFile &pose = poses[n_done++];
      failures += carry(transfer, mesh, pose);
      progress.update(static_cast<unsigned int>(n_done), printable(pose.file.filename().string()));
    }
    progress.finish();
    write_csv(poses, n_done, options.output / "poses.csv");
    if (!options.quiet)
      print_table(poses, n_done);
    if (n_done < poses.size())
      throw Interrupted("Interrupted after pose " + std::to_string(n_done) + " of "
                        + std::to_string(poses.size()) + ".");
    if (!failures.empty())
      throw SolverFailure(
          "Cells stay inverted in these poses, which are not written:" + failures
          + "\n  Attach the surface more softly, by --attach, or take a finer mesh.");
  }
} // namespace Exemplar
