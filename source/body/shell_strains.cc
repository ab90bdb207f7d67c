// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/shell_strains.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    /// Angles of a plane, by ShellHinge::kind: a director is seen from its triangle a quarter turn back.
    constexpr std::array<double, 3> angles_in_a_plane = { { 0., -0.5 * pi, -0.5 * pi } };

    std::array<Vector3<double>, 4>
    rest_places(const ShellMesh &mesh, const ShellHinge &hinge)
    {
      std::array<Vector3<double>, 4> x;
      for (int i = 0; i < 4; ++i)
        x[i] = hinge.nodes[i] < mesh.n_vertices() ? mesh.vertex(hinge.nodes[i])
                                                  : mesh.tip(hinge.edge);
      return x;
    }

    /// The bending strain of a triangle for turns at its edges.
    ShellStrain
    curvature_of(const ShellTriangle &triangle, const std::array<double, 3> &turns)
    {
      ShellStrain strain{};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          strain[3 + k] += turns[i] * triangle.bending[i][k];
      return strain;
    }

    /// The matrix and the right side of the slopes of least bending energy.
    class BendingSystem
    {
    public:
      explicit BendingSystem(const ShellMesh &mesh)
          : mesh(mesh), solver(make_cholesky_operator()), right_side(mesh.edges().size(), 0.)
      {
        std::vector<std::vector<int>> rows(mesh.edges().size());
        for (const ShellTriangle &triangle : mesh.triangles())
          for (const unsigned int row : triangle.edges)
            for (const unsigned int column : triangle.edges)
              if (row >= column)
                rows[column].push_back(row);
        pattern.column_start.push_back(0);
        for (std::vector<int> &column : rows)
        {
          std::sort(column.begin(), column.end());
          column.erase(std::unique(column.begin(), column.end()), column.end());
          pattern.row.insert(pattern.row.end(), column.begin(), column.end());
          pattern.column_start.push_back(pattern.row.size());
        }
        solver->reinit(pattern);
        solver->values().assign(pattern.n_values(), 0.);
      }

      /// Add the energy of a triangle with these turns at its edges without slopes.
      void
      add(const ShellTriangle         &triangle,
          const ShellElasticity       &elasticity,
          const std::array<double, 3> &turns)
      {
        const auto with_turns = [&triangle](const std::array<double, 3> &some)
        { return curvature_of(triangle, some); };
        const ShellStrain stress = elasticity.stress(with_turns(turns));
        for (int i = 0; i < 3; ++i)
        {
          std::array<double, 3> of_i{};
          of_i[i]                = triangle.signs[i] * triangle.volume();
          const ShellStrain unit = with_turns(of_i);
          right_side[triangle.edges[i]] -= contract(stress, unit);
          for (int j = 0; j < 3; ++j)
            if (triangle.edges[i] >= triangle.edges[j])
            {
              std::array<double, 3> of_j{};
              of_j[j] = triangle.signs[j];
              solver->values()[pattern.position(triangle.edges[i], triangle.edges[j])]
                  += contract(elasticity.stress(unit), with_turns(of_j));
            }
        }
      }

      /// The turns [rad] of the edges' normals out of the bisectors.
      std::vector<double>
      solve()
      {
        return solve(std::move(right_side));
      }

      /// The same for another right side.
      std::vector<double>
      solve(std::vector<double> other_side)
      {
        solver->factorize({});
        solver->solve(other_side);
        return other_side;
      }

    private:
      const ShellMesh             &mesh;
      SymmetricPattern             pattern;
      std::unique_ptr<SpdOperator> solver;
      std::vector<double>          right_side;
    };
  } // namespace

  ShellStrains::ShellStrains(const ShellMesh &mesh)
      : mesh(mesh), held(mesh.edges().size(), 0),
        last_angles(mesh.edges().size(), angles_in_a_plane)
  {
    find_turns();
  }

  void
  ShellStrains::set_held(const HeldTips &new_held)
  {
    held = new_held;
    find_turns();
  }

  Vector
  ShellStrains::with_fourth_nodes(Vector positions) const
  {
    for (unsigned int edge = 0; edge < mesh.n_slopes(); ++edge)
      if (const int frame = frame_of_edge[edge]; frame >= 0)
      {
        const unsigned int    node = mesh.slope_node(edge);
        const ShellEdge      &of   = mesh.edges()[edge];
        const Vector3<double> at   = frames[frame].place(
              place_in(positions, of.begin), place_in(positions, of.end), place_in(positions, node));
        for (unsigned int c = 0; c < 3; ++c)
          positions[3 * node + c] = at[c];
      }
    return positions;
  }

  ShellTurn
  ShellStrains::make_turn(const unsigned int triangle, const unsigned int i)
  {
    const ShellTriangle &of        = mesh.triangles()[triangle];
    const unsigned int   number    = of.edges[i];
    const ShellEdge     &edge      = mesh.edges()[number];
    const auto           add_hinge = [&](ShellHinge hinge)
    {
      const auto x = rest_places(mesh, hinge);
      if (hinge.kind != 0 && frame_of_edge[number] >= 0)
      {
        hinge.frame = frame_of_edge[number];
        hinge.shift = (hinge.kind == 1 ? -1. : 1.) * frames[hinge.frame].turned_by();
      }
      hinge.rest = HingeAngle<double>(x[0], x[1], x[2], x[3]).value();
      hinge.rest = nearest(number, hinge.kind, hinge.rest);
      hinges.push_back(hinge);
      return static_cast<int>(hinges.size()) - 1;
    };
    if (is_held(number))
      return { add_hinge({ { { of.nodes[i], of.nodes[(i + 1) % 3], of.nodes[(i + 2) % 3],
                               mesh.slope_node(number) } },
                           0.,
                           triangle,
                           number,
                           of.signs[i] > 0. ? 1U : 2U }),
               1. };
    ShellTurn turn;
    if (mesh.kind() == ShellKind::plate)
    {
      turn.slope    = 3 * static_cast<int>(mesh.slope_node(number));
      turn.of_slope = of.signs[i] / edge.length;
    }
    if (edge.is_border())
      return turn;
    turn.of_hinge = mesh.kind() == ShellKind::plate ? 0.5 : 1.;
    turn.hinge    = of.signs[i] > 0.
                        ? add_hinge({ { { edge.begin, edge.end, edge.opposite[0], edge.opposite[1] } },
                                      0.,
                                      triangle,
                                      number,
                                      0U })
                        : -2; // known once the first triangle is
    return turn;
  }

  void
  ShellStrains::find_turns()
  {
    frames.clear();
    frame_of_edge.assign(mesh.edges().size(), -1);
    for (unsigned int edge = 0; edge < mesh.n_slopes(); ++edge)
      if (follows_edge(held[edge]))
      {
        frame_of_edge[edge] = static_cast<int>(frames.size());
        frames.emplace_back(mesh, edge, held[edge]);
      }
    hinges.clear();
    turns_of_triangles.assign(mesh.triangles().size(), {});
    std::vector<int> hinge_of_edge(mesh.edges().size(), -1);
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        turns_of_triangles[t][i] = make_turn(t, i);
        if (mesh.triangles()[t].signs[i] > 0.)
          hinge_of_edge[mesh.triangles()[t].edges[i]] = turns_of_triangles[t][i].hinge;
      }
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
        if (turns_of_triangles[t][i].hinge == -2)
          turns_of_triangles[t][i].hinge = hinge_of_edge[mesh.triangles()[t].edges[i]];
  }

  HingeAngle<double>
  ShellStrains::hinge_angle(const unsigned int hinge, const Vector &positions) const
  {
    const auto                    &nodes = hinges[hinge].nodes;
    const int                      frame = hinges[hinge].frame;
    std::array<Vector3<double>, 4> x;
    for (int i = 0; i < 4; ++i)
      x[i] = place_in(positions, nodes[i]);
    if (frame >= 0)
      x[3] = frames[frame].place(x[0], x[1], x[3]);
    return { x[0], x[1], x[2], x[3] };
  }

  HingeForm<double>
  ShellStrains::hinge_gradient(const unsigned int hinge, const Vector &positions) const
  {
    return pulled_back(hinge, hinge_angle(hinge, positions).gradient());
  }

  std::array<HingeProduct<double>, 4>
  ShellStrains::hinge_hessian(const unsigned int hinge, const Vector &positions) const
  {
    auto products = hinge_angle(hinge, positions).hessian();
    for (HingeProduct<double> &product : products)
    {
      product.a = pulled_back(hinge, product.a);
      product.b = pulled_back(hinge, product.b);
    }
    return products;
  }

  double
  ShellStrains::nearest(const unsigned int edge, const unsigned int kind, const double angle) const
  {
    return angle + 2. * pi * std::round((last_angles[edge][kind] - angle) / (2. * pi));
  }

  double
  ShellStrains::change(const unsigned int hinge, const HingeAngle<double> &angle) const
  {
    const ShellHinge &of = hinges[hinge];
    return nearest(of.edge, of.kind, angle.value() + of.shift) - of.rest;
  }

  void
  ShellStrains::update_branches(const Vector &positions)
  {
    for (unsigned int i = 0; i < hinges.size(); ++i)
      last_angles[hinges[i].edge][hinges[i].kind]
          = hinges[i].rest + change(i, hinge_angle(i, positions));
    for (unsigned int edge = 0; edge < mesh.n_slopes();
         ++edge) // those that are no hinges now, but may be later
    {
      auto &angles = last_angles[edge];
      if (is_held(edge))
      {
        angles[0] = angles[1] + angles[2] - angles_in_a_plane[1] - angles_in_a_plane[2];
        angles[0] = angle_of_triangles(edge, positions);
        continue;
      }
      const double slope = positions[3 * mesh.slope_node(edge)] / mesh.edges()[edge].length;
      angles[1]          = angles_in_a_plane[1] + 0.5 * angles[0] + slope;
      angles[2]          = angles_in_a_plane[2] + 0.5 * angles[0] - slope;
    }
  }

  std::vector<double>
  ShellStrains::branches() const
  {
    std::vector<double> result;
    for (const ShellTriangle &triangle : mesh.triangles())
    {
      for (const unsigned int edge : triangle.edges)
        result.push_back(last_angles[edge][0]);
      for (unsigned int i = 0; i < 3; ++i)
        result.push_back(last_angles[triangle.edges[i]][triangle.signs[i] > 0. ? 1 : 2]);
    }
    return result;
  }

  void
  ShellStrains::set_branches(const std::vector<double> &angles)
  {
    if (angles.empty())
      last_angles.assign(mesh.edges().size(), angles_in_a_plane);
    for (std::size_t t = 0; 6 * t < angles.size(); ++t)
    {
      const ShellTriangle &triangle = mesh.triangles()[t];
      for (unsigned int i = 0; i < 3; ++i)
      {
        auto &last                           = last_angles[triangle.edges[i]];
        last[0]                              = angles[6 * t + i];
        last[triangle.signs[i] > 0. ? 1 : 2] = angles[6 * t + 3 + i];
      }
    }
  }

  TriangleStrain<double>
  ShellStrains::triangle(const unsigned int triangle, const Vector &positions) const
  {
    const ShellTriangle &of = mesh.triangles()[triangle];
    return { mesh.kind(),
             of,
             { { place_in(positions, of.nodes[0]), place_in(positions, of.nodes[1]),
                 place_in(positions, of.nodes[2]) } } };
  }

  std::array<double, 3>
  ShellStrains::turns_of(const unsigned int         triangle,
                         const Vector              &positions,
                         const std::vector<double> &changes) const
  {
    std::array<double, 3> result{};
    for (int i = 0; i < 3; ++i)
    {
      const ShellTurn &turn = turns_of_triangles[triangle][i];
      if (turn.hinge >= 0)
        result[i] += turn.of_hinge * changes[turn.hinge];
      if (turn.slope >= 0)
        result[i] += turn.of_slope * positions[turn.slope];
    }
    return result;
  }

  std::vector<double>
  ShellStrains::changes(const Vector &positions) const
  {
    std::vector<double> result(hinges.size());
    for (unsigned int i = 0; i < hinges.size(); ++i)
      result[i] = change(i, hinge_angle(i, positions));
    return result;
  }

  std::vector<ShellStrain>
  ShellStrains::strains(const Vector &positions) const
  {
    const std::vector<double> of_hinges = changes(positions);
    std::vector<ShellStrain>  result;
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
      result.push_back(triangle(t, positions).strain(turns_of(t, positions, of_hinges)));
    return result;
  }

  std::vector<ShellStrain>
  ShellStrains::strain_changes(const Vector &positions, const Vector &along) const
  {
    std::vector<double> of_hinges(hinges.size(), 0.);
    for (unsigned int h = 0; h < hinges.size(); ++h)
    {
      const HingeForm<double> form = hinge_gradient(h, positions);
      for (int i = 0; i < 4; ++i)
        of_hinges[h] += dot(form[i], place_in(along, hinges[h].nodes[i]));
    }
    std::vector<ShellStrain> result;
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
    {
      const auto &nodes = mesh.triangles()[t].nodes;
      result.push_back(triangle(t, positions)
                           .change({ { place_in(along, nodes[0]), place_in(along, nodes[1]),
                                       place_in(along, nodes[2]) } },
                                   turns_of(t, along, of_hinges)));
    }
    return result;
  }

  void
  ShellStrains::add_pulled_back(const Vector                   &positions,
                                const std::vector<ShellStrain> &stresses,
                                Vector                         &to) const
  {
    const auto add = [&to](const unsigned int node, const double factor, const Vector3<double> &of)
    {
      for (unsigned int c = 0; c < 3; ++c)
        to[3 * node + c] += factor * of[c];
    };
    std::vector<double> of_hinges(hinges.size(), 0.);
    for (unsigned int t = 0; t < stresses.size(); ++t)
    {
      const auto at      = triangle(t, positions);
      const auto forces  = at.forces(stresses[t]);
      const auto moments = at.moments(stresses[t]);
      for (int i = 0; i < 3; ++i)
      {
        add(mesh.triangles()[t].nodes[i], 1., forces[i]);
        const ShellTurn &turn = turns_of_triangles[t][i];
        if (turn.hinge >= 0)
          of_hinges[turn.hinge] += turn.of_hinge * moments[i];
        if (turn.slope >= 0)
          to[turn.slope] += turn.of_slope * moments[i];
      }
    }
    for (unsigned int h = 0; h < hinges.size(); ++h)
    {
      const HingeForm<double> form = hinge_gradient(h, positions);
      for (int i = 0; i < 4; ++i)
        add(hinges[h].nodes[i], of_hinges[h], form[i]);
    }
  }

  double
  ShellStrains::angle_of_triangles(const unsigned int edge, const Vector &positions) const
  {
    const ShellEdge &of = mesh.edges()[edge];
    if (of.is_border())
      return 0.;
    return nearest(edge, 0,
                   HingeAngle<double>(place_in(positions, of.begin), place_in(positions, of.end),
                                      place_in(positions, of.opposite[0]),
                                      place_in(positions, of.opposite[1]))
                       .value());
  }

  std::vector<double>
  ShellStrains::slopes(const Vector &positions) const
  {
    std::vector<double> result(mesh.edges().size());
    for (unsigned int edge = 0; edge < result.size(); ++edge)
      if (!is_held(edge))
        result[edge] = positions[3 * mesh.slope_node(edge)];
    for (unsigned int i = 0; i < hinges.size(); ++i)
      if (hinges[i].kind == 1)
      {
        const unsigned int edge = hinges[i].edge;
        const ShellEdge   &of   = mesh.edges()[edge];
        result[edge]            = of.length
                       * (change(i, hinge_angle(i, positions))
                          - 0.5 * (angle_of_triangles(edge, positions) - of.angle));
      }
    return result;
  }

  Vector3<double>
  ShellStrains::tip(const unsigned int edge, const Vector &positions) const
  {
    const ShellEdge      &of    = mesh.edges()[edge];
    const Vector3<double> begin = place_in(positions, of.begin), end = place_in(positions, of.end);
    const HingeSide<double> side(begin, end, place_in(positions, of.opposite[0]));
    const HingeSide<double> rest(mesh.vertex(of.begin), mesh.vertex(of.end),
                                 mesh.vertex(of.opposite[0]));
    const double            turn = std::atan2(dot(of.normal, rest.t), dot(of.normal, rest.n))
                        + 0.5 * (angle_of_triangles(edge, positions) - of.angle)
                        + positions[3 * mesh.slope_node(edge)] / of.length;
    const Vector3<double> normal = combine(std::cos(turn), side.n, std::sin(turn), side.t);
    return combine(1., combine(0.5, begin, 0.5, end), of.length, normal);
  }

  Vector3<double>
  ShellStrains::held_node(const unsigned int     edge,
                          const Vector3<double> &tip,
                          const Vector          &positions) const
  {
    const ShellEdge &of    = mesh.edges()[edge];
    const int        frame = frame_of_edge[edge];
    return frame < 0 ? tip
                     : frames[frame].node(place_in(positions, of.begin),
                                          place_in(positions, of.end), tip);
  }

  std::vector<double>
  ShellStrains::least_bending_slopes(
      const Vector &positions, const std::function<ShellElasticity(unsigned int)> &elasticity) const
  {
    std::vector<double> half_changes;
    for (unsigned int edge = 0; edge < mesh.edges().size(); ++edge)
      half_changes.push_back(0.5
                             * (angle_of_triangles(edge, positions) - mesh.edges()[edge].angle));
    BendingSystem system(mesh);
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
    {
      const ShellTriangle  &triangle = mesh.triangles()[t];
      std::array<double, 3> turns{};
      for (int i = 0; i < 3; ++i)
        turns[i] = half_changes[triangle.edges[i]];
      system.add(triangle, elasticity(t), turns);
    }
    std::vector<double> slopes = system.solve();
    for (unsigned int edge = 0; edge < slopes.size(); ++edge)
      slopes[edge] *= mesh.edges()[edge].length;
    return slopes;
  }

  std::vector<ShellStrain>
  ShellStrains::adjoint_of_least_bending(
      const std::vector<double>                          &by_slopes,
      const std::function<ShellElasticity(unsigned int)> &elasticity) const
  {
    BendingSystem system(mesh);
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
      system.add(mesh.triangles()[t], elasticity(t), {});
    std::vector<double> by_turns = by_slopes;
    for (unsigned int edge = 0; edge < by_turns.size(); ++edge)
      by_turns[edge] *= mesh.edges()[edge].length;
    const std::vector<double> adjoint = system.solve(std::move(by_turns));
    std::vector<ShellStrain>  result;
    for (const ShellTriangle &triangle : mesh.triangles())
    {
      std::array<double, 3> turns{};
      for (int i = 0; i < 3; ++i)
        turns[i] = triangle.signs[i] * adjoint[triangle.edges[i]];
      result.push_back(curvature_of(triangle, turns));
    }
    return result;
  }

  std::size_t
  ShellStrains::memory_consumption() const
  {
    return hinges.capacity() * sizeof(ShellHinge) + last_angles.capacity() * sizeof(last_angles[0])
           + turns_of_triangles.capacity() * sizeof(turns_of_triangles[0]) + held.capacity()
           + frames.capacity() * sizeof(TipFrame) + frame_of_edge.capacity() * sizeof(int);
  }
} // namespace Exemplar
