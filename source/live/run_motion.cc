// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/exemplar.h>
#include <exemplar/live/run_frames.h>
#include <exemplar/live/run_motion.h>
#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/mesh/msh_file.h>
#include <exemplar/obstacles/obstacle_picture.h>
#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/output/frame_output.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/surface/files/point_cache.h>
#include <exemplar/surface/shape/triangle_surface.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    const char *const run_again = " Run the scene again.";

    void
    require_run_file(const fs::path &file)
    {
      if (std::error_code none; !fs::is_regular_file(file, none))
        throw UserError(file.string() + " is missing, which the run has written." + run_again);
    }

    Places
    scaled(const std::vector<SurfaceMesh::Vertex> &vertices,
           const double                            scale,
           const fs::path                         &file)
    {
      Places places;
      for (const auto &vertex : vertices)
      {
        places.emplace_back(scale * vertex[0], scale * vertex[1], scale * vertex[2]);
        if (!(places.back().norm() < 1e30)) // limit of what can be drawn
          throw UserError(file.string() + ": a vertex is too far away to be drawn." + run_again);
      }
      return places;
    }

    /// Vertices that no face uses, which no player is given, stand where another one does, so that
    /// they do not count.
    void
    hide_vertices_without_faces(RunMotion &motion)
    {
      std::vector<bool> is_used(motion.rest.size(), false);
      for (const MovingSurface &moving : motion.surfaces)
        for (const auto &face : moving.surface.faces)
          for (const unsigned int vertex : face)
            is_used[moving.first_in_list + vertex] = true;
      std::vector<Places *> lists{ &motion.rest };
      for (Places &places : motion.examples)
        lists.push_back(&places);
      for (Places &places : motion.frames)
        lists.push_back(&places);
      const auto shown = std::find(is_used.begin(), is_used.end(), true) - is_used.begin();
      for (std::size_t v = 0; v < is_used.size(); ++v)
        for (Places *places : lists)
          if (!is_used[v])
            (*places)[v] = (*places)[shown];
    }

    void
    append(Places &all, const Places &places)
    {
      all.insert(all.end(), places.begin(), places.end());
    }

    Places
    points_of(const std::vector<double> &numbers)
    {
      Places places;
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        places.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
      return places;
    }

    /// The weights of statistics.csv.
    struct WeightTable
    {
      std::vector<std::string>                    names; ///< of the columns
      std::map<unsigned int, std::vector<double>> of_step;
    };

    WeightTable
    weights_in(const fs::path &file)
    {
      require_run_file(file);
      std::istringstream       lines(read_text_file(file).value_or(""));
      std::string              line;
      std::vector<std::size_t> columns;
      WeightTable              table;
      std::getline(lines, line);
      const auto header = split_trimmed(line, ',');
      for (std::size_t i = 0; i < header.size(); ++i)
        if (header[i].compare(0, 7, "weight_") == 0)
        {
          columns.push_back(i);
          table.names.push_back(header[i]);
        }
      while (std::getline(lines, line))
      {
        const auto          row = split_trimmed(line, ',');
        std::vector<double> weights;
        for (const std::size_t column : columns)
          if (const double weight = column < row.size() ? parse_number(row[column]) : std::nan("");
              std::abs(weight) < 1e6)
            weights.push_back(weight);
        // the row of a step that failed has no weights
        if (const auto step = decimal_number<unsigned int>(row.empty() ? "" : row[0]);
            step && weights.size() == columns.size())
          table.of_step[*step] = weights;
      }
      return table;
    }

    /// The examples' names in summary.json, a list; null without.
    nlohmann::json
    names_in(const fs::path &summary)
    {
      if (std::error_code none; !fs::is_regular_file(summary, none)) // a pipe would block
        return {};
      const auto json = nlohmann::json::parse(read_text_file(summary).value_or(""), nullptr, false);
      const auto names = json.is_object() ? json.find("example_names") : json.end();
      return names != json.end() && names->is_array() ? *names : nlohmann::json();
    }

    /// What a run's directory holds.
    class RunReader
    {
    public:
      explicit RunReader(const fs::path &directory)
          : files{ directory }, scene(files.parameters_prm(), {}),
            parameters(scene.get_parameters()), axis(make_time_axis(parameters)),
            table(weights_in(files.statistics())), example_names(names_in(files.summary()))
      {
        motion.z_is_up     = playback_of(parameters, axis).z_is_up;
        motion.has_contact = !parameters.obstacles.empty()
                             || (parameters.contact.self || parameters.contact.bodies);
        for (const ObstacleParameters &obstacle : parameters.obstacles.named)
          motion.names_of_obstacles.push_back(obstacle.name);
      }

      RunMotion
      read()
      {
        if (parameters.output.shows_surface())
          read_surfaces();
        else
          read_boundary();
        hide_vertices_without_faces(motion);
        return std::move(motion);
      }

    private:
      /// What poses in files are held against.
      struct Inputs
      {
        std::map<std::string, std::string> digests;
        MshFile                            final_pose;
      };

      Inputs
      read_inputs() const;
      void
      read_surfaces();
      void
      read_boundary();
      void
      add_surface(const std::string &carried, const fs::path &folder);
      void
      add_obstacles_of_cache(const FrameFormat &format);
      void
      add_frame(unsigned int step, double time);
      void
      add_poses(const std::vector<std::size_t> &kept);
      Places
      pose_of_boundary(std::size_t column, const std::vector<unsigned int> &nodes);
      SurfaceMesh
      shape(const std::string &name, const std::string &carried) const;
      std::vector<unsigned int>
      steps_with_frames(const FrameFormat &format) const;
      std::string
      name_of_example(const std::string &column) const;

      const RunFiles         files;
      const SceneFile        scene;
      const SceneParameters &parameters;
      const TimeAxis         axis;
      const WeightTable      table;
      const nlohmann::json   example_names; ///< a list, or null
      std::vector<Places>    poses;         ///< by column of the table; empty: not on disk
      std::optional<Inputs>  inputs;        ///< once a pose is looked for in its file
      RunMotion              motion;
    };

    /// A surface that the run has written at its beginning.
    SurfaceMesh
    RunReader::shape(const std::string &name, const std::string &carried) const
    {
      const fs::path file
          = files.directory / (name + (carried.empty() ? "" : "_" + carried) + ".obj");
      require_run_file(file);
      if (!begins_with(file, "# a shape by exemplar"))
        throw UserError(file.string() + " is not the one that the run has written." + run_again);
      return read_surface(file);
    }

    std::vector<unsigned int>
    RunReader::steps_with_frames(const FrameFormat &format) const
    {
      std::vector<unsigned int> steps;
      for (const auto &entry : fs::directory_iterator(files.directory))
        if (const std::string name = entry.path().filename().string();
            const auto        step = format.step_of(name))
          if (format.frame_name(*step) == name)
            steps.push_back(*step);
      std::sort(steps.begin(), steps.end());
      return steps;
    }

    /// Add a frame's time and weights; its places are added by the caller.
    void
    RunReader::add_frame(const unsigned int step, const double time)
    {
      const auto weights = table.of_step.find(step);
      if (weights == table.of_step.end())
        throw UserError(fmt::format("{} has no row of step {}, which has a frame.{}",
                                    files.statistics().string(), step, run_again));
      constexpr double frames_per_second = 24.; // where t is no time
      motion.times.push_back(parameters.scene == SceneKind::dynamic
                                 ? time
                                 : static_cast<double>(motion.times.size()) / frames_per_second);
      motion.weights.push_back(weights->second);
      const std::size_t n = motion.times.size();
      if (n > 1 && !(motion.times[n - 1] > motion.times[n - 2]))
        throw UserError(files.directory.string() + ": the times of its frames do not increase."
                        + run_again);
    }

    void
    RunReader::add_surface(const std::string &carried, const fs::path &folder)
    {
      const double scale  = parameters.mesh.scale;
      const auto  &named  = parameters.output.formats;
      const bool   is_pc2 = std::count(named.begin(), named.end(), "pc2") > 0;
      if (!is_pc2 && std::count(named.begin(), named.end(), "mdd") == 0)
        throw UserError(files.directory.string()
                        + ": a run that shows a surface is read from its point cache, but the run "
                          "has written none. Run the scene again, with pc2 among Output/Formats.");
      const auto    &formats = frame_formats();
      const auto     format  = std::find_if(formats.begin(), formats.end(),
                                            [&](const FrameFormat &candidate)
                                            { return candidate.name == (is_pc2 ? "pc2" : "mdd"); });
      const fs::path file    = files.directory / format->animation_name(carried);
      MovingSurface  moving{ carried.empty() ? "body" : carried, shape("rest", carried), folder,
                            carried.empty(), motion.rest.size() };
      require_run_file(file);
      const auto cache = open_point_cache(file.string(), 1., moving.surface,
                                          (files.directory / "rest.obj").string());
      const auto steps = steps_with_frames(*format);
      if (steps.size() != cache->get_times().size())
        throw UserError(fmt::format("{} has {} frames, but {} files frame_*.{} stand beside it.{}",
                                    file.string(), cache->get_times().size(), steps.size(),
                                    format->name, run_again));
      motion.frames.resize(steps.size());
      for (std::size_t k = 0; k < steps.size(); ++k)
      {
        if (carried.empty())
          add_frame(steps[k], axis.time(std::min(steps[k], axis.n_steps())));
        append(motion.frames[k], scaled(cache->sample(k), scale, file));
      }
      for (std::size_t i = 0; i < table.names.size(); ++i)
      {
        const SurfaceMesh posed = shape(table.names[i], carried);
        if (posed.vertices.size() != moving.surface.vertices.size())
          throw UserError(fmt::format("{}: {}.obj has another number of vertices than rest.obj.{}",
                                      files.directory.string(), table.names[i], run_again));
        append(poses[i], scaled(posed.vertices, scale, file));
      }
      append(motion.rest, scaled(moving.surface.vertices, scale, file));
      motion.surfaces.push_back(std::move(moving));
      if (carried.empty() && !parameters.obstacles.empty())
        add_obstacles_of_cache(*format);
    }

    /// The surface of a scene's obstacles, as frames have it; its places are those of no frame.
    SurfaceMesh
    surface_of_obstacles(const SceneParameters &scene, const double diameter)
    {
      ObstaclesParameters obstacles = scene.obstacles;
      obstacles.distance = obstacles.slip_speed = "auto"; // no picture depends on them
      ObstacleSurfaces surfaces;
      for (ObstacleParameters &obstacle : obstacles.named)
      {
        ObstacleSurface &surface = surfaces[obstacle.name];
        obstacle.follow_track = obstacle.follow_cache = "";
        if (const std::string file = obstacle.surface_file(); !file.empty())
        {
          const TriangleSurface triangles = triangulate(read_surface(file));
          surface.vertices                = triangles.vertices;
          surface.triangles               = triangles.triangles;
        }
      }
      const Obstacles all(obstacles, diameter, PieceSizes(diameter), surfaces);
      return ObstaclePicture(all, diameter).surface();
    }

    /// The obstacles that the run has written beside the body; a note if their surface is not known.
    void
    RunReader::add_obstacles_of_cache(const FrameFormat &format)
    {
      const fs::path file = files.directory / format.animation_name(name_of_obstacles);
      require_run_file(file);
      SurfaceMesh                       rest;
      std::unique_ptr<const PointCache> cache;
      try
      {
        rest  = surface_of_obstacles(parameters, box_diagonal(motion.rest));
        cache = open_point_cache(file.string(), 1., rest, "the scene's obstacles");
      }
      catch (const UserError &error)
      {
        motion.notes.push_back(std::string("Obstacles are left out of the file. ") + error.what());
        return;
      }
      motion.obstacles = rest.faces;
      for (std::size_t k = 0; k < std::min(cache->get_times().size(), motion.frames.size()); ++k)
        motion.obstacle_frames.push_back(scaled(cache->sample(k), parameters.mesh.scale, file));
    }

    void
    RunReader::read_surfaces()
    {
      poses.resize(table.names.size());
      add_surface("", fs::path(parameters.mesh.surface_file()).parent_path());
      for (const std::string &file : parameters.mesh.carried)
        add_surface(name_of_carried(file), fs::path(file).parent_path());
      std::vector<std::size_t> all(poses.size());
      for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = i;
      add_poses(all);
    }

    RunReader::Inputs
    RunReader::read_inputs() const
    {
      require_run_file(files.checkpoint());
      require_run_file(files.final_pose());
      return { load_checkpoint(files.checkpoint()).input_digests, read_msh(files.final_pose()) };
    }

    /// The pose of a weight at the nodes of the boundary; empty if it is in no file that has the
    /// run's nodes. Throws UserError for a file that has changed since the run.
    Places
    RunReader::pose_of_boundary(const std::size_t column, const std::vector<unsigned int> &nodes)
    {
      const auto       &examples = parameters.examples;
      const std::size_t first    = examples.has_rest_pose() ? 1 : 0;
      if (table.names[column] != fmt::format("weight_{}", examples.first_number() + column))
        return {}; // of a region
      if (column < first)
        return motion.rest;
      if (column - first >= examples.poses.size())
        return {}; // of a formula
      const std::string &name = examples.poses[column - first];
      if (is_surface_file(name))
        return {};
      if (std::error_code none; !fs::is_regular_file(name, none))
        throw UserError(in_quotes(name) + " is missing, an example of the run. Bring it back.");
      if (!inputs)
        inputs = read_inputs();
      const std::string digest = sha256(name);
      if (std::none_of(inputs->digests.begin(), inputs->digests.end(),
                       [&](const auto &known) { return known.second == digest; }))
        throw UserError(in_quotes(name) + " has changed since the run." + run_again);
      const auto found = read_pose(name, inputs->final_pose, files.final_pose().string());
      Places     pose;
      for (const unsigned int node : nodes)
      {
        if (node >= found.size())
          throw UserError(files.final_pose().string() + " has other nodes than the frames."
                          + run_again);
        pose.push_back(dealii::Point<3>(parameters.mesh.scale * found[node]));
        if (!(pose.back().norm() < 1e30))
          throw UserError(in_quotes(name) + ": a node is too far away to be drawn.");
      }
      return pose;
    }

    void
    RunReader::read_boundary()
    {
      const auto frames   = frames_of_run(files.directory);
      const auto boundary = boundary_in(frames.front().file);
      // vertices of the boundary, ascending
      std::vector<unsigned int> nodes;
      for (const auto &face : boundary)
        nodes.insert(nodes.end(), face.begin(), face.end());
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      const auto of_nodes = [&](const std::vector<double> &places)
      {
        Places result;
        for (const unsigned int node : nodes)
          result.emplace_back(places[3 * node], places[3 * node + 1], places[3 * node + 2]);
        return result;
      };
      const auto first = rest_places_in(frames.front().file);
      motion.rest      = of_nodes(first);
      MovingSurface moving{ "body", {} };
      for (const auto &face : boundary)
      {
        moving.surface.faces.emplace_back();
        for (const unsigned int node : face)
          moving.surface.faces.back().push_back(static_cast<unsigned int>(
              std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()));
      }
      for (const dealii::Point<3> &place : motion.rest)
        moving.surface.vertices.push_back({ { place[0], place[1], place[2] } });
      motion.surfaces.push_back(std::move(moving));
      for (const RunFrame &frame : frames)
      {
        const auto step = frame_formats().front().step_of(frame.file.filename().string());
        if (!step)
          throw UserError(frame.file.string() + " is no frame that exemplar has written."
                          + run_again);
        const auto places = places_in(frame.file);
        if (places.size() != first.size())
          throw UserError(frame.file.string() + " has other nodes than the first frame.");
        add_frame(*step, frame.time);
        motion.frames.push_back(of_nodes(places));
        if (!frame.obstacles.empty())
        {
          if (motion.obstacles.empty())
            motion.obstacles = polygons_in(frame.obstacles);
          motion.obstacle_frames.push_back(points_of(places_in(frame.obstacles)));
        }
      }
      std::vector<std::size_t> kept;
      for (std::size_t i = 0; i < table.names.size(); ++i)
      {
        poses.push_back(pose_of_boundary(i, nodes));
        if (!poses[i].empty())
          kept.push_back(i);
      }
      if (kept.size() < poses.size())
        motion.notes.push_back("Examples by formula, by region or of surfaces are on disk only "
                               "where Output/Formats has pc2 or another surface: they become part "
                               "of the shapes.");
      if (!parameters.mesh.carried.empty())
        motion.notes.push_back("What the body wears is left out: pc2 among Output/Formats would "
                               "bring it.");
      add_poses(kept);
    }

    std::string
    RunReader::name_of_example(const std::string &column) const
    {
      // weight_I, or weight_R_I of region R
      const auto words = split_trimmed(column, '_');
      const auto i     = decimal_number<std::size_t>(words.back());
      if (!i || *i >= example_names.size() || !example_names[*i].is_string())
        return column;
      return example_names[*i].get<std::string>()
             + (words.size() > 2 ? " in region " + words[1] : "");
    }

    /// Take over the poses of these columns that are not rest's.
    void
    RunReader::add_poses(const std::vector<std::size_t> &kept)
    {
      std::vector<std::size_t> columns;
      std::copy_if(kept.begin(), kept.end(), std::back_inserter(columns),
                   [&](const std::size_t i) { return poses[i] != motion.rest; });
      for (const std::size_t i : columns)
      {
        motion.names.push_back(name_of_example(table.names[i]));
        motion.examples.push_back(std::move(poses[i]));
      }
      for (auto &weights : motion.weights)
      {
        std::vector<double> of_columns;
        for (const std::size_t i : columns)
          of_columns.push_back(weights[i]);
        weights = std::move(of_columns);
      }
    }
  } // namespace

  RunMotion
  motion_of_run(const fs::path &directory)
  {
    if (std::error_code none; !fs::is_regular_file(directory / "parameters.prm", none))
      throw UserError(directory.string()
                      + (fs::is_directory(directory, none)
                             ? " has no parameters.prm. Give the output directory of a run."
                             : " is no directory. Give the output directory of a run: exemplar "
                               "SCENE.prm --output DIRECTORY makes one."));
    return RunReader(directory).read();
  }
} // namespace Exemplar::Live
