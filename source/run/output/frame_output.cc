// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/frame_output.h>
#include <exemplar/run/output/weight_names.h>
#include <exemplar/run/problem/finiteness.h>
#include <exemplar/surface/files/write_obj.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    const FrameFormat &
    find_format(const std::string &name, const std::vector<FrameFormat> &formats)
    {
      std::string allowed;
      for (const FrameFormat &format : formats)
      {
        if (format.name == name)
          return format;
        allowed += (allowed.empty() ? "" : ", ") + format.name;
      }
      throw UserError("Output/Formats: there is no format '" + name + "'. Allowed: " + allowed
                      + ".");
    }
  } // namespace

  namespace
  {
    fs::path
    folder_of(const std::string &file)
    {
      return file.empty() ? fs::path() : fs::absolute(file).parent_path();
    }
  } // namespace

  namespace
  {
    /// Keep the values of so many nodes, the first ones.
    void
    leave_slopes_out(Frame &frame, const unsigned int n_places)
    {
      for (Vector *const field : { &frame.positions, &frame.displacement, &frame.velocities })
        if (field->size() > 0)
          field->grow_or_shrink(3 * n_places);
      for (NodalField &field : frame.fields)
        field.values.grow_or_shrink(field.n_components * n_places);
    }
  } // namespace

  namespace
  {
    /// The number of the region with the greatest share in each cell, the first of equal ones; 1 where there is
    /// one region.
    std::vector<int>
    weight_regions(const ExamplePoses &poses, const FESpace &fe_space)
    {
      const unsigned int n_points = points_per_cell(fe_space.element()); // all with the same shares
      std::vector<int>   numbers;
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        double greatest = 0.;
        numbers.push_back(1);
        poses.get_strains().get_shares().for_each(cell * n_points,
                                                  [&](const unsigned int region, const double share)
                                                  {
                                                    if (share > greatest)
                                                      numbers.back() = static_cast<int>(
                                                          poses.region_id(region).value_or(1));
                                                    greatest = std::max(greatest, share);
                                                  });
      }
      return numbers;
    }
  } // namespace

  Frame
  frame_of(Problem &problem)
  {
    const State &state = problem.state;
    Frame        frame;
    frame.step         = state.step;
    frame.time         = state.time;
    frame.positions    = state.positions;
    frame.displacement = state.positions;
    frame.displacement -= problem.body.fe_space.rest_positions();
    frame.velocities = state.velocities;
    frame.cells      = problem.elastic->cell_results(state.positions, state.weights);
    if (problem.parameters.examples.finds_regions())
      frame.cells.weight_region = weight_regions(problem.examples.poses, problem.body.fe_space);
    for (const auto &term : problem.potential.get_terms())
      term->append_fields(state.positions, frame.fields);
    for (NodalField &field : frame.fields)
      problem.body.exchange().assemble(field.values.begin(), field.n_components);
    if (problem.body.fe_space.numbering().has_slopes())
      leave_slopes_out(frame, problem.body.fe_space.numbering().n_places());
    return frame;
  }

  Playback
  playback_of(const SceneParameters &scene, const TimeAxis &axis)
  {
    Playback result;
    result.interval = axis.step_size(1) * scene.output.every;
    if (scene.scene == SceneKind::dynamic) // 1 / 0.01 without rounding errors
      result.frames_per_second = std::round(1e6 / result.interval) / 1e6;
    result.has_velocities = scene.scene == SceneKind::dynamic;
    result.with_cells     = scene.output.usd_cells;
    result.with_normals   = scene.output.usd_normals;
    const auto &g         = scene.loads.gravity;
    result.z_is_up        = std::abs(g[2]) > std::abs(g[1]);
    return result;
  }

  FrameOutput::FrameOutput(Problem                        &problem,
                           const RunDirectory             &directory,
                           const std::vector<FrameFormat> &formats)
      : problem(problem), directory(directory), formats(formats),
        background(problem.parameters.solver.n_threads > 1)
  {
    all_shown.push_back(make_body());
    for (const CarriedSurface &carried : problem.body.carried)
      all_shown.push_back(make_carried(carried));
    if (const Obstacles *const obstacles = problem.actions.obstacles.get())
    {
      for (const Shown &shown : all_shown)
        if (shown.are_obstacles())
          throw UserError("Mesh/Carry has a surface of the name 'obstacles', as files of the "
                          "obstacles are called. Rename its file.");
      picture.emplace(*obstacles, problem.body.mesh.diameter(), problem.body.mesh.get_scale());
      all_shown.push_back({ name_of_obstacles, {}, &picture->surface(), nullptr, {} });
    }
    for (Shown &shown : all_shown)
      add_writers(shown);
  }

  FrameOutput::Shown
  FrameOutput::make_body() const
  {
    const SceneParameters &scene = problem.parameters;
    Shown                  shown{
      "", folder_of(scene.mesh.surface_file()), problem.body.surface.get(), nullptr, {}
    };
    if (scene.output.shows_surface())
      shown.skin = std::make_unique<const SurfaceSkin>(*problem.body.surface, problem.body.mesh,
                                                       scene.mesh.surface_file());
    return shown;
  }

  FrameOutput::Shown
  FrameOutput::make_carried(const CarriedSurface &carried) const
  {
    fs::path folder;
    for (const std::string &file : problem.parameters.mesh.carried)
      if (name_of_carried(file) == carried.name)
        folder = folder_of(file);
    return { carried.name,
             folder,
             &carried.surface,
             std::make_unique<const SurfaceSkin>(skin_of_carried(carried.surface, problem.body.mesh,
                                                                 "Mesh/Carry: " + carried.name)),
             {} };
  }

  void
  FrameOutput::add_writers(Shown &shown) const
  {
    const OutputParameters &output   = problem.parameters.output;
    const Playback          playback = playback_of(problem.parameters, problem.time_axis);
    for (const std::string &name : output.formats)
      if (const FrameFormat &format = find_format(name, formats); output.every > 0)
        shown.writers.emplace_back(
            &format, format.writer_of({ problem.body.mesh, problem.body.fe_space, shown.surface,
                                        playback, shown.carried, shown.folder }));
  }

  Vector
  FrameOutput::displacement_of_weight(const unsigned int i) const
  {
    const ExamplePoses &poses    = problem.examples.poses;
    const FESpace      &fe_space = problem.body.fe_space;
    const unsigned int  region   = i / poses.size();
    Vector              u        = poses.pose(i % poses.size());
    u -= fe_space.rest_positions();
    if (poses.n_regions() == 1)
      return u;
    // at nodes, the mean of the shares in their cells
    std::vector<double> share(fe_space.n_nodes(), 0.), n_cells(fe_space.n_nodes(), 0.);
    const unsigned int  n_points = points_per_cell(fe_space.element()); // all with the same shares
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (const unsigned int node : fe_space.nodes(cell))
      {
        n_cells[node] += 1.;
        share[node] += poses.get_strains().get_shares().share(cell * n_points, region);
      }
    for (unsigned int dof = 0; dof < u.size(); ++dof)
      u[dof] *= n_cells[dof / 3] > 0. ? share[dof / 3] / n_cells[dof / 3] : 0.;
    return u;
  }

  void
  FrameOutput::write_shapes() const
  {
    if (problem.parameters.output.shows_surface())
      for (const Shown &shown : all_shown)
        if (!shown.are_obstacles())
          write_shapes_of(shown);
  }

  void
  FrameOutput::write_shapes_of(const Shown &shown) const
  {
    const std::string end   = shown.carried.empty() ? ".obj" : "_" + shown.carried + ".obj";
    const std::string faces = obj_faces(*shown.surface);
    const auto        write = [&](const std::string &name, const Vector &displacement)
    {
      AtomicFile file(directory.get_path() / (name + end));
      file.stream() << "# a shape by exemplar\n"
                    << obj_vertices(shown.skin->carry(displacement)) << faces;
      file.commit();
    };
    write("rest", Vector(problem.body.fe_space.n_dofs()));
    for (unsigned int i = 0; i < problem.examples.weights.size(); ++i)
      write(name_of_weight("weight", problem.examples.poses, i), displacement_of_weight(i));
  }

  bool
  FrameOutput::is_due(const unsigned int step) const
  {
    const unsigned int every = problem.parameters.output.every;
    return every > 0 && (step % every == 0 || step == problem.time_axis.n_steps());
  }

  void
  FrameOutput::write(std::optional<SpaceError> space_error)
  {
    Frame frame       = frame_of(problem);
    frame.space_error = std::move(space_error);
    if (picture) // here, as formulas are of this thread
      frame.obstacles = picture->places(*problem.actions.obstacles, frame.time, frame.positions);
    const Exchange &exchange = problem.body.exchange();
    do_in_agreement(exchange,
                    [&]
                    {
                      refuse_what_is_not_finite(frame);
                      background.submit([this, frame = std::move(frame)]() mutable
                                        { write_files(frame); });
                    });
  }

  void
  FrameOutput::refuse_what_is_not_finite(const Frame &frame)
  {
    if (const std::string what = what_is_not_finite(frame); !what.empty())
      throw SolverFailure(
          fmt::format("The frame of step {} would hold {} that are not finite numbers. Take "
                      "smaller steps, and look at what handles, loads and Initial do.",
                      frame.step, what));
  }

  void
  FrameOutput::show_surface(const SurfaceSkin         &skin,
                            const std::vector<Writer> &writers,
                            Frame                     &frame)
  {
    frame.surface = skin.carry(frame.displacement);
    frame.surface_velocities.clear();
    if (frame.velocities.size() == 0
        || std::none_of(writers.begin(), writers.end(),
                        [](const Writer &writer) { return writer.first->shows_velocities; }))
      return;
    // a skin is linear in displacements
    frame.surface_velocities = skin.carry(frame.velocities);
    const auto rest          = skin.carry(Vector(frame.velocities.size()));
    for (std::size_t v = 0; v < rest.size(); ++v)
      for (unsigned int c = 0; c < 3; ++c)
        frame.surface_velocities[v][c] -= rest[v][c];
  }

  void
  FrameOutput::write_files(Frame &frame) const
  {
    const Exchange &exchange = problem.body.exchange();
    const fs::path &path     = directory.get_path();
    for (const Shown &shown : all_shown)
    {
      if (shown.skin != nullptr)
        show_surface(*shown.skin, shown.writers, frame);
      if (shown.are_obstacles())
      {
        frame.surface = frame.obstacles;
        frame.surface_velocities.clear();
      }
      for (const auto &[format, writer] : shown.writers)
      {
        const auto pieces
            = format->names_of_pieces(frame.step, exchange.n_processes(), shown.carried);
        if (const std::size_t part = shown.are_obstacles() ? 0 : exchange.process();
            part == exchange.process())
          directory.do_inside([&, &by = *writer] { by.write(frame, path / pieces[part]); });
        const auto join
            = [&, &of = *format] { of.join(frame, pieces, path / of.joint_name(frame.step)); };
        if (pieces.size() > 1)
          at_root(exchange, [&] { directory.do_inside(join); });
      }
    }
  }

  fs::path
  FrameOutput::file_of(const FrameFormat &format,
                       const unsigned int step,
                       const std::string &carried) const
  {
    if (const fs::path joint = directory.get_path() / format.joint_name(step);
        carried.empty() && format.has_pieces() && fs::exists(joint))
      return joint;
    return directory.get_path() / format.frame_name(step, carried);
  }

  bool
  FrameOutput::is_missing() const
  {
    return problem.body.exchange().any(std::any_of(
        all_shown.begin(), all_shown.end(),
        [&](const Shown &shown)
        {
          return std::any_of(
              shown.writers.begin(), shown.writers.end(),
              [&](const Writer &writer)
              { return !fs::exists(file_of(*writer.first, problem.state.step, shown.carried)); });
        }));
  }

  void
  FrameOutput::drain()
  {
    do_in_agreement(problem.body.exchange(), [&] { background.drain(); });
  }

  void
  FrameOutput::write_animations() const
  {
    for (const Shown &shown : all_shown)
      for (const auto &[format, writer] : shown.writers)
        if (const auto written = written_frames(*format, shown.carried);
            !format->animation.empty() && !written.empty())
          writer->write_animation(written,
                                  directory.get_path() / format->animation_name(shown.carried));
  }

  std::vector<WrittenFrame>
  FrameOutput::written_frames(const FrameFormat &format, const std::string &carried) const
  {
    std::vector<WrittenFrame> frames;
    // every step, as Output/Every may have changed at a resume
    for (unsigned int step = 0; step <= problem.state.step; ++step)
      if (const fs::path file = file_of(format, step, carried); fs::exists(file))
      {
        const fs::path beside = file_of(format, step, name_of_obstacles);
        const bool     shown  = picture && carried.empty() && fs::exists(beside);
        frames.push_back({ problem.time_axis.time(step), file, shown ? beside : fs::path() });
      }
    return frames;
  }

  void
  FrameOutput::remove(const unsigned int step) const
  {
    std::vector<fs::path> files;
    for (const fs::directory_entry &entry : fs::directory_iterator(directory.get_path()))
      for (const FrameFormat &format : formats)
        if (format.step_of(entry.path().filename().string()) == step
            && fs::is_regular_file(entry.symlink_status()))
          files.push_back(entry.path());
    for (const fs::path &file : files)
      fs::remove(file);
  }
} // namespace Exemplar
