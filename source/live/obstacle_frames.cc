// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/obstacle_frames.h>

#include <algorithm>

namespace Exemplar::Live
{
  SpaceVector3
  up_of(const std::array<double, 3> &gravity, const unsigned int axis_without)
  {
    const SpaceVector3 down({ gravity[0], gravity[1], gravity[2] });
    SpaceVector3       up;
    up[axis_without] = 1.;
    return down.norm() > 0. ? -down / down.norm() : up;
  }

  Floor::Floor(const Problem &problem, const SpaceVector3 &up)
  {
    const Obstacles *const obstacles = problem.actions.obstacles.get();
    for (unsigned int i = 0; obstacles != nullptr && !level && i < obstacles->all.size(); ++i)
    {
      const ObstacleShape &shape = obstacles->all[i].shape();
      if (shape.half_spaces.size() == 1 && shape.half_spaces[0].normal * up > 1. - 1e-12
          && obstacles->all[i].is_always_there() && problem.parameters.obstacles.named[i].stays())
      {
        level    = shape.middle * up + shape.half_spaces[0].offset;
        obstacle = i;
      }
    }
  }

  ObstacleFrames::ObstacleFrames(const Problem &problem, const SpaceVector3 &up)
  {
    names                                       = present(problem);
    const Obstacles *const            obstacles = problem.actions.obstacles.get();
    const std::optional<unsigned int> floor     = Floor(problem, up).obstacle;
    if (obstacles == nullptr || obstacles->all.size() == (floor ? 1 : 0))
      return;
    picture.emplace(*obstacles, problem.body.mesh.diameter(), 1., floor);
    const SurfaceMesh &mesh = picture->surface();
    for (const std::string &name : mesh.group_names)
    {
      const auto          &all   = obstacles->all;
      const auto           of    = std::find_if(all.begin(), all.end(),
                                                [&](const Obstacle &o) { return o.name() == name; });
      const ObstacleShape &shape = of->shape();
      list.push_back(
          { name, 0, shape.half_sizes.has_value() || shape.half_spaces.empty(), of->has_left() });
    }
    // as BodySurface counts them: what is a triangle already is there twice
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
      list[mesh.face_groups[face]].n_triangles
          += mesh.faces[face].size() == 3 ? 2 : mesh.faces[face].size() - 2;
    at_start = places(problem);
    surface  = BodySurface(at_start.size(), picture->surface().faces);
  }

  std::vector<std::string>
  ObstacleFrames::present(const Problem &problem)
  {
    std::vector<std::string> names;
    if (problem.actions.obstacles != nullptr)
      for (const Obstacle &obstacle : problem.actions.obstacles->all)
        if (!obstacle.has_left())
          names.push_back(obstacle.name());
    return names;
  }

  std::vector<SurfaceMesh::Vertex>
  ObstacleFrames::places(const Problem &problem) const
  {
    return picture->places(*problem.actions.obstacles, problem.state.time,
                           problem.body.fe_space.rest_positions());
  }

  Bytes
  ObstacleFrames::message(const Problem                          &problem,
                          const std::vector<SurfaceMesh::Vertex> &places) const
  {
    Vector positions(3 * places.size());
    for (unsigned int dof = 0; dof < positions.size(); ++dof)
      positions[dof] = places[dof / 3][dof % 3];
    return frame_message({ BinaryKind::obstacles, 0, problem.state.step, 0, problem.state.time },
                         surface, positions);
  }

  std::vector<Bytes>
  ObstacleFrames::welcome(const Problem &problem) const
  {
    if (!picture)
      return {};
    return { topology_message(surface, BinaryKind::topology_of_obstacles),
             message(problem, places(problem)) };
  }

  Bytes
  ObstacleFrames::beside(const Bytes &frame, const Problem &problem)
  {
    if (!picture)
      return frame;
    const auto now = places(problem);
    have_moved     = have_moved || now != at_start;
    return have_moved ? std::make_shared<const std::string>(*frame + *message(problem, now))
                      : frame;
  }
} // namespace Exemplar::Live
