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
        const auto with_turns = [&](const std::array<double, 3> &some)
        {
          ShellStrain strain{};
          for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
              strain[3 + k] += some[i] * triangle.bending[i][k];
          return strain;
        };
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
        solver->factorize({});
        solver->solve(right_side);
        return std::move(right_side);
      }

    private:
      const ShellMesh             &mesh;
      SymmetricPattern             pattern;
      std::unique_ptr<SpdOperator> solver;
      std::vector<double>          right_side;
    };
  } // namespace

  ShellStrains::ShellStrains(const ShellMesh &mesh)
      : mesh(mesh), held(mesh.edges().size(), false),
        last_angles(mesh.edges().size(), angles_in_a_plane)
  {
    find_turns();
  }

  void
  ShellStrains::set_held(const std::vector<bool> &new_held)
  {
    held = new_held;
    find_turns();
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
      hinge.rest   = HingeAngle<double>(x[0], x[1], x[2], x[3]).value();
      hinge.rest   = nearest(number, hinge.kind, hinge.rest);
      hinges.push_back(hinge);
      return static_cast<int>(hinges.size()) - 1;
    };
    if (held[number])
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
    const auto &nodes = hinges[hinge].nodes;
    return { place_in(positions, nodes[0]), place_in(positions, nodes[1]),
             place_in(positions, nodes[2]), place_in(positions, nodes[3]) };
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
    return nearest(of.edge, of.kind, angle.value()) - of.rest;
  }

  void
  ShellStrains::update_branches(const Vector &positions)
  {
    for (unsigned int i = 0; i < hinges.size(); ++i)
      last_angles[hinges[i].edge][hinges[i].kind]
          = hinges[i].rest + change(i, hinge_angle(i, positions));
  }

  MembraneStrain<double>
  ShellStrains::membrane(const unsigned int triangle, const Vector &positions) const
  {
    const ShellTriangle  &of = mesh.triangles()[triangle];
    const Vector3<double> x0 = place_in(positions, of.nodes[0]);
    const Vector3<double> u  = difference(place_in(positions, of.nodes[1]), x0),
                          v  = difference(place_in(positions, of.nodes[2]), x0);
    const auto &g            = of.gradients;
    return { combine(g[1][0], u, g[2][0], v), combine(g[1][1], u, g[2][1], v) };
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

  ShellStretch
  ShellStrains::stretch(const unsigned int triangle,
                        const unsigned int i,
                        const Vector      &positions) const
  {
    const auto           &nodes = mesh.triangles()[triangle].nodes;
    const Vector3<double> edge
        = difference(place_in(positions, nodes[(i + 1) % 3]), place_in(positions, nodes[i]));
    const double length = norm(edge);
    return { times(1. / length, edge), length };
  }

  ShellStrain
  ShellStrains::strain(const unsigned int            t,
                       const Vector                 &positions,
                       const MembraneStrain<double> &membrane,
                       const std::array<double, 3>  &turns) const
  {
    const ShellTriangle     &triangle = mesh.triangles()[t];
    const Symmetric2<double> of_plane = membrane.strain();
    ShellStrain              result   = { { of_plane[0], of_plane[1], of_plane[2], 0., 0., 0. } };
    for (unsigned int i = 0; i < 3 && mesh.kind() == ShellKind::hinges; ++i)
      result[i] = stretch(t, i, positions).length / mesh.edges()[triangle.edges[i]].length - 1.;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        result[3 + k] += turns[i] * triangle.bending[i][k];
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
      result.push_back(
          strain(t, positions, membrane(t, positions), turns_of(t, positions, of_hinges)));
    return result;
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
      if (!held[edge])
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

  std::size_t
  ShellStrains::memory_consumption() const
  {
    return hinges.capacity() * sizeof(ShellHinge) + last_angles.capacity() * sizeof(last_angles[0])
           + turns_of_triangles.capacity() * sizeof(turns_of_triangles[0]) + held.capacity() / 8;
  }
} // namespace Exemplar
