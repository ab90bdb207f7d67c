// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/progress.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/program/commands.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/surface/files/numbered_files.h>
#include <exemplar/surface/posing/pose_carrying.h>
#include <exemplar/surface/shape/surface_poses.h>

#include <fmt/core.h>

#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    /// The comment that marks poses written by this command.
    const std::string pose_comment = "a pose by exemplar";

    const std::string header_of_poses
        = "pose,inverted_cells,min_det_F,max_det_F,stretch_min,stretch_1,stretch_99,stretch_max,"
          "surface_error_mean,surface_error_max,longest_edge,rotation,shift,seconds\n";

    const char *const remedy = " Give another directory by --output.";

    /// A pose to be carried from a surface to a mesh.
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

    /// The files to write, one for each pose. Throws UserError if they clash with each other or
    /// with inputs.
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
        poses.push_back({ file, output, {}, {}, 0. });
      }
      std::vector<fs::path> inputs = { options.mesh, options.rest };
      for (const PoseFile &pose : poses)
        inputs.push_back(pose.file);
      for (const PoseFile &pose : poses)
        require_replaceable({ pose.output, msh_beginning, msh_end(pose_comment) }, inputs, remedy);
      require_replaceable({ options.output / "poses.csv", header_of_poses }, inputs, remedy);
      require_writable(options.output, remedy);
      return poses;
    }

    void
    check_files(const PoseOptions &options)
    {
      if (is_mesh_file(options.output))
        throw UserError("--output " + options.output.string()
                        + ": the name is that of a file, but poses are written "
                          "to a directory, each as NAME.msh by the name of its surface. Give the "
                          "name of a directory.");
      if (is_surface_file(options.mesh) && !is_surface_file(options.rest))
        throw UserError("--mesh " + options.mesh.string() + " and --rest " + options.rest.string()
                        + " seem to be swapped: --mesh takes the tetrahedra (.msh), --rest the "
                          "surface around them (.obj, .ply or .stl).");
      if (is_surface_file(options.mesh))
        throw UserError("--mesh " + options.mesh.string()
                        + " is a surface. Make tetrahedra inside it: exemplar mesh --surface "
                        + options.mesh.string() + " --cells 5000 --output "
                        + fs::path(options.mesh).replace_extension(".msh").string()
                        + ", and give these.");
    }

    /// Warn if all poses are rotated by the same right angle, as by an export with other axes.
    void
    warn_of_axes(const RestSurface &rest, const std::vector<PoseFile> &poses)
    {
      std::set<std::string> axes;
      for (const PoseFile &pose : poses)
        axes.insert(axis_of_right_angle(rest.surface, pose.surface));
      if (axes.size() == 1 && !axes.begin()->empty())
        show_warning(
            poses[0].file.string() + (poses.size() > 1 ? " and the others are" : " is")
            + " turned by 90 degrees about the " + *axes.begin() + " axis against " + rest.name
            + ". If another axis points upwards in one of the exports, export both alike.");
    }

    void
    warn(const Mesh &mesh, const RestSurface &rest, const std::vector<PoseFile> &poses)
    {
      for (const std::string &warning : mesh.get_warnings())
        show_warning(warning);
      for (const PoseFile &pose : poses)
        if (is_at_rest(rest.surface, pose.surface))
          show_warning(pose.file.string() + " is the same as " + rest.name
                       + ": the pose is the mesh at rest.");
      warn_of_axes(rest, poses);
    }

    /// Make the transfer; if it fails as --rest and --pose are swapped, say so.
    PoseTransfer
    make_transfer(const PoseOptions           &options,
                  const Mesh                  &mesh,
                  const RestSurface           &rest,
                  const std::vector<PoseFile> &poses)
    {
      try
      {
        return make_pose_transfer(mesh, rest, options.attach, options.n_threads);
      }
      catch (const UserError &error)
      {
        if (poses.empty() || !is_surface_of(mesh, poses[0].surface))
          throw;
        throw UserError(std::string(error.what()) + " It is that of " + poses[0].file.string()
                        + ": --rest and --pose seem to be swapped.");
      }
    }

    void
    write_csv(const std::vector<PoseFile> &poses, const std::size_t n_done, const fs::path &file)
    {
      AtomicFile csv(file);
      csv.stream() << header_of_poses;
      for (std::size_t k = 0; k < n_done; ++k)
      {
        const PoseQuality &q = poses[k].quality;
        csv.stream() << poses[k].file.stem().string() << ',' << q.n_inverted;
        for (const double value : { q.min_det, q.max_det, q.min_stretch, q.stretch_1, q.stretch_99,
                                    q.max_stretch, 100. * q.mean_error, 100. * q.max_error,
                                    q.longest_edge, q.rotation, q.shift, poses[k].seconds })
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
      std::cout << std::left << std::setw(static_cast<int>(width)) << "pose"
                << "  inverted   det F            stretch, least 1 % 99 % most     surface error % "
                   " edge  "
                   "rotation  time\n";
      for (std::size_t k = 0; k < n_done; ++k)
      {
        const PoseQuality &q = poses[k].quality;
        const std::string  line
            = fmt::format("  {:8}   {:.3f} to {:6.3f}  {:8.3f} {:7.3f} {:6.3f} {:6.3f}   {:6.3f} "
                          "{:6.3f}  {:5.1f}   "
                          "{:6.1f}  {:5.1f} s",
                          q.n_inverted, q.min_det, q.max_det, q.min_stretch, q.stretch_1,
                          q.stretch_99, q.max_stretch, 100. * q.mean_error, 100. * q.max_error,
                          q.longest_edge, q.rotation, poses[k].seconds);
        std::cout << std::left << std::setw(static_cast<int>(width))
                  << printable(poses[k].file.stem().string()) << line << '\n';
      }
      std::cout << std::flush;
    }

    /// Write the pose; if elements stay inverted, return them instead.
    std::string
    carry(PoseTransfer &transfer, const Mesh &mesh, PoseFile &pose)
    {
      const auto begin = std::chrono::steady_clock::now();
      const auto x     = transfer.carry(pose.surface.vertices, pose.quality);
      pose.seconds
          = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const std::string inverted = inverted_elements(transfer, mesh, x);
      if (!inverted.empty())
        return "\n  " + pose.file.string() + ": element " + inverted;
      mesh.write_pose(x, pose.output, pose_comment);
      return "";
    }
  } // namespace

  void
  carry_poses(const PoseOptions &options)
  {
    check_files(options);
    std::vector<PoseFile> poses = plan(options);
    for (const PoseFile &pose : poses)
      require_file(pose.file, "a pose: an .obj, .ply or .stl file", options.rest);
    const Mesh        mesh(read_mesh_file(options.mesh), options.mesh.string());
    const RestSurface rest(options.rest);
    for (PoseFile &pose : poses)
      pose.surface = read_pose_surface(pose.file, rest);
    PoseTransfer transfer = make_transfer(options, mesh, rest, poses);
    warn(mesh, rest, poses);
    make_directory(options.output, remedy);

    is_interrupted(); // signals wait for the current pose from now on
    Progress    progress(std::cout, isatty(STDOUT_FILENO) != 0, options.quiet, 0,
                         static_cast<unsigned int>(poses.size()), "pose");
    std::string failures;
    std::size_t n_done = 0;
    while (n_done < poses.size() && !is_interrupted())
    {
      PoseFile         &pose = poses[n_done++];
      const std::string name = printable(pose.file.filename().string());
      transfer.tell_steps(
          [&](const unsigned int step)
          {
            progress.go_on_with(static_cast<unsigned int>(n_done),
                                fmt::format("{}, step {}", name, step));
          });
      failures += carry(transfer, mesh, pose);
      progress.update(static_cast<unsigned int>(n_done), name);
    }
    progress.finish();
    transfer.tell_steps({});
    for (std::size_t k = 0; k < n_done; ++k)
      for (const std::string &warning :
           { poses[k].quality.warning_of_motion(), poses[k].quality.warning_of_edge() })
        if (!warning.empty())
          show_warning(poses[k].file.string() + ": " + warning);
    write_csv(poses, n_done, options.output / "poses.csv");
    if (!options.quiet)
      print_table(poses, n_done);
    if (n_done < poses.size())
      throw Interrupted(fmt::format("Interrupted after pose {} of {}.", n_done, poses.size()));
    if (!failures.empty())
      throw SolverFailure(
          "Cells stay inverted in these poses, which are not written:" + failures
          + "\n  Attach the surface more softly, by --attach, or take a finer mesh.");
  }
} // namespace Exemplar
