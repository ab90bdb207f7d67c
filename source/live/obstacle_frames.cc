// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/obstacle_frames.h>

namespace Exemplar::Live
{
  namespace
  {
    SpaceVector3
    against_gravity(const Problem &problem)
    {
      const auto        &g = problem.parameters.loads.gravity;
      const SpaceVector3 gravity({ g[0], g[1], g[2] });
      return gravity.norm() > 0. ? -gravity / gravity.norm() : SpaceVector3({ 0., 0., 1. });
    }

  } // namespace

  Floor::Floor(const Problem &problem)
  {
    const Obstacles *const obstacles = problem.actions.obstacles.get();
    const SpaceVector3     up        = against_gravity(problem);
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

  ObstacleFrames::ObstacleFrames(const Problem &problem)
  {
    const Obstacles *const            obstacles = problem.actions.obstacles.get();
    const std::optional<unsigned int> floor     = Floor(problem).obstacle;
    if (obstacles == nullptr || obstacles->all.size() == (floor ? 1 : 0))
      return;
    picture.emplace(*obstacles, problem.body.mesh.diameter(), 1., floor);
    at_start = places(problem);
    surface  = BodySurface(at_start.size(), picture->surface().faces);
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
