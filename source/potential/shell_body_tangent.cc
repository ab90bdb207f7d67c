// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/loop_parts.h>
#include <exemplar/potential/shell_body.h>

#include <algorithm>

// The matrix of a shell, and the couplings of its weights.

namespace Exemplar
{
  namespace
  {
    /// Position of an entry of a lower triangle by rows.
    unsigned int
    lower(const unsigned int row, const unsigned int column)
    {
      return row * (row + 1) / 2 + column;
    }

    /// The nodes that the strains of a triangle may depend on with its unknowns sheared, whatever is held.
    std::vector<unsigned int>
    nodes_of(const ShellMesh &mesh, const ShellTriangle &triangle)
    {
      std::vector<unsigned int> nodes(triangle.nodes.begin(), triangle.nodes.end());
      for (const unsigned int edge : triangle.edges)
      {
        if (mesh.kind() == ShellKind::plate)
          nodes.push_back(mesh.slope_node(edge));
        else
          for (const unsigned int opposite : mesh.edges()[edge].opposite)
            if (opposite != ShellEdge::none)
              nodes.push_back(opposite);
      }
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace

  SymmetricPattern
  ShellBody::make_pattern(const NodePairs &more, bool in_parts) const
  {
    std::vector<std::vector<unsigned int>> neighbours(parts.mesh.n_nodes()); // and the node itself
    for (const ShellTriangle &triangle : parts.mesh.triangles())
    {
      const std::vector<unsigned int> nodes = nodes_of(parts.mesh, triangle);
      for (const unsigned int node : nodes)
        neighbours[node].insert(neighbours[node].end(), nodes.begin(), nodes.end());
    }
    for (const auto &[a, b] : more)
    {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
    for (std::vector<unsigned int> &of_node : neighbours)
    {
      std::sort(of_node.begin(), of_node.end());
      of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
    }
    SymmetricPattern result;
    result.products_are_apart = in_parts; // of terms
    result.is_of_surface      = true;
    result.column_start.push_back(0);
    for (const unsigned int dof : parts.free_dofs.local_list())
    {
      for (const unsigned int node : neighbours[dof / 3])
        for (unsigned int other = std::max(3 * node, dof); other < 3 * node + 3; ++other)
          if (const int row = parts.free_dofs.free_index(other); row != FreeDofs::held)
            result.row.push_back(row);
      result.column_start.push_back(result.row.size());
    }
    return result;
  }

  void
  ShellBody::attach(const SymmetricPattern &new_pattern)
  {
    pattern               = &new_pattern;
    const ShellMesh &mesh = parts.mesh;
    HeldTips         held(mesh.edges().size(), 0);
    for (unsigned int edge = 0; edge < mesh.n_slopes(); ++edge)
      if (parts.free_dofs.free_index(3 * mesh.slope_node(edge)) == FreeDofs::held)
        held[edge] = parts.held_tips != nullptr ? (*parts.held_tips)[edge] : held_in_space;
    strains.set_held(held);
    write_hinges();
    write_triangles();
    dofs.clear();
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
      dofs.push_back(find_dofs(t));
  }

  ShellBody::TriangleDofs
  ShellBody::find_dofs(const unsigned int triangle) const
  {
    TriangleDofs result;
    const auto   index_of_node = [&](const unsigned int node)
    {
      for (unsigned int i = 0; i < result.n; i += 3)
        if (result.dofs[i] == 3 * node)
          return i;
      for (unsigned int c = 0; c < 3; ++c)
        result.dofs[result.n++] = 3 * node + c;
      return result.n - 3;
    };
    for (const unsigned int node : parts.mesh.triangles()[triangle].nodes)
      index_of_node(node);
    for (int i = 0; i < 3; ++i)
      if (const ShellTurn &turn = strains.turns(triangle)[i]; turn.hinge >= 0)
        for (int k = 0; k < 4; ++k)
        {
          const unsigned int node = strains.get_hinges()[turn.hinge].nodes[k];
          if (!turn.is_sheared())
            result.hinges[i][k] = index_of_node(node);
          for (unsigned int c = 0; c < 3; ++c)
            result.is_beside_held |= parts.free_dofs.free_index(3 * node + c) == FreeDofs::held;
        }
    for (int i = 0; i < 3; ++i)
      if (const ShellTurn &turn = strains.turns(triangle)[i]; turn.slope >= 0)
      {
        result.slopes[i]        = result.n;
        result.dofs[result.n++] = turn.slope;
      }
    result.positions.fill(FreeDofs::held);
    for (unsigned int p = 0; p < result.n; ++p)
    {
      const int row = parts.free_dofs.free_index(result.dofs[p]);
      result.is_beside_held |= row == FreeDofs::held;
      for (unsigned int q = 0; q <= p && row != FreeDofs::held; ++q)
        if (const int column = parts.free_dofs.free_index(result.dofs[q]); column != FreeDofs::held)
          result.positions[lower(p, q)]
              = pattern->position(std::max(row, column), std::min(row, column));
    }
    return result;
  }

  void
  ShellBody::find_strain_slopes(const unsigned int            t,
                                const TriangleStrain<double> &at,
                                const Vector                 &positions,
                                TriangleTangent              &to) const
  {
    const ShellTriangle &triangle = parts.mesh.triangles()[t];
    to.B.fill({});
    for (unsigned int p = 0; p < 9; ++p)
    {
      Vector3<double> unit{};
      unit[p % 3]   = 1.;
      const auto &g = triangle.gradients[p / 3];
      to.changes[p] = at.membrane().change(unit, g[0], g[1]);
      for (int k = 0; k < 3; ++k)
        to.B[p][k] = to.changes[p].dU[k];
    }
    if (parts.mesh.kind() == ShellKind::hinges)
      find_stretch_slopes(at, triangle, to);
    const auto add = [&](const int edge, const double turn, ShellStrain &strain)
    {
      for (int k = 0; k < 3; ++k)
        strain[3 + k] += turn * triangle.bending[edge][k];
    };
    for (int i = 0; i < 3; ++i)
    {
      const ShellTurn &turn = strains.turns(t)[i];
      if (turn.is_sheared())
      {
        const auto gradient = at.side(i).of_turn();
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < 3; ++c)
            add(i, gradient[k][c], to.B[3 * ((i + k) % 3) + c]);
      }
      else if (turn.hinge >= 0)
      {
        const HingeForm<double> gradient = strains.hinge_gradient(turn.hinge, positions);
        for (int k = 0; k < 4; ++k)
          for (int c = 0; c < 3; ++c)
            add(i, turn.of_hinge * gradient[k][c], to.B[dofs[t].hinges[i][k] + c]);
      }
      if (turn.slope >= 0)
        add(i, turn.of_slope, to.B[dofs[t].slopes[i]]);
    }
    for (unsigned int p = 0; p < dofs[t].n; ++p)
      to.CB[p] = elasticities[t].stress(to.B[p]);
  }

  void
  ShellBody::find_stretch_slopes(const TriangleStrain<double> &at,
                                 const ShellTriangle          &triangle,
                                 TriangleTangent              &to) const
  {
    for (unsigned int i = 0; i < 3; ++i)
    {
      const Vector3<double> direction = at.stretch(i).direction;
      for (unsigned int node = 0; node < 3; ++node)
        for (unsigned int c = 0; c < 3; ++c)
          to.B[3 * node + c][i] = node == i             ? -direction[c] / triangle.lengths[i]
                                  : node == (i + 1) % 3 ? direction[c] / triangle.lengths[i]
                                                        : 0.;
    }
  }

  void
  ShellBody::add_stretch_geometry(const unsigned int            t,
                                  const TriangleStrain<double> &at,
                                  const bool                    convex,
                                  TriangleTangent              &to) const
  {
    const ShellTriangle &triangle = parts.mesh.triangles()[t];
    const ShellStrain    T        = driven_stress(t);
    for (unsigned int i = 0; i < 3; ++i)
    {
      const EdgeStretch<double> stretch = at.stretch(i);
      const double              factor
          = (i == 2 ? 2. : 1.) * triangle.volume() * T[i] / (triangle.lengths[i] * stretch.length);
      if (convex && factor < 0.)
        continue;
      const unsigned int begin = 3 * i, end = 3 * ((i + 1) % 3);
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
        {
          const double across
              = factor * ((c == d ? 1. : 0.) - stretch.direction[c] * stretch.direction[d]);
          if (d <= c)
          {
            to.entries[lower(begin + c, begin + d)] += across;
            to.entries[lower(end + c, end + d)] += across;
          }
          to.entries[begin > end ? lower(begin + c, end + d) : lower(end + c, begin + d)] -= across;
        }
    }
  }

  void
  ShellBody::add_membrane_geometry(const unsigned int            t,
                                   const TriangleStrain<double> &at,
                                   const bool                    convex,
                                   TriangleTangent              &to) const
  {
    const ShellTriangle           &triangle = parts.mesh.triangles()[t];
    const MembraneStrain<double>  &membrane = at.membrane();
    const ShellStrain              T        = driven_stress(t);
    const double                   volume   = triangle.volume();
    const MembraneGeometry<double> geometry
        = membrane.geometry({ { volume * T[0], volume * T[1], volume * T[2] } }, convex);
    std::array<double, 9> L;
    for (unsigned int p = 0; p < 9; ++p)
      L[p] = geometry.of(to.changes[p]);
    for (unsigned int p = 0; p < 9; ++p)
      for (unsigned int q = 0; q <= p; ++q)
      {
        const double spin_p = to.changes[p].spin, spin_q = to.changes[q].spin;
        const auto  &g = triangle.gradients[p / 3], &h = triangle.gradients[q / 3];
        const double out = g[0] * (geometry.S[0] * h[0] + geometry.S[2] * h[1])
                           + g[1] * (geometry.S[2] * h[0] + geometry.S[1] * h[1]);
        to.entries[lower(p, q)] += geometry.of_spin * spin_p * spin_q
                                   + geometry.of_product * (spin_p * L[q] + spin_q * L[p])
                                   + geometry.of_square * L[p] * L[q]
                                   + membrane.normal()[p % 3] * membrane.normal()[q % 3] * out;
      }
  }

  void
  ShellBody::add_turn_geometry(const unsigned int            t,
                               const int                     edge,
                               const TriangleStrain<double> &at,
                               TriangleTangent              &to) const
  {
    for (const SideProduct<double> &of : at.side(edge).second_of_turn())
    {
      std::array<double, 9> a, b;
      for (int k = 0; k < 9; ++k)
      {
        const int place = 3 * ((edge + k / 3) % 3) + k % 3;
        a[place]        = moments[strains.turns(t)[edge].hinge] * of.factor * of.a[k / 3][k % 3];
        b[place]        = of.b[k / 3][k % 3];
      }
      for (unsigned int p = 0; p < 9; ++p)
        for (unsigned int q = 0; q <= p; ++q)
          to.entries[lower(p, q)] += a[p] * b[q] + b[p] * a[q];
    }
  }

  void
  ShellBody::add_hinge_geometry(const unsigned int t,
                                const int          edge,
                                const Vector      &positions,
                                TriangleTangent   &to) const
  {
    const int   hinge = strains.turns(t)[edge].hinge;
    const auto &at    = dofs[t].hinges[edge];
    for (const HingeProduct<double> &of : strains.hinge_hessian(hinge, positions))
      for (unsigned int p = 0; p < 12; ++p)
        for (unsigned int q = 0; q < 12; ++q)
          if (const unsigned int row = at[p / 3] + p % 3, column = at[q / 3] + q % 3; row >= column)
            to.entries[lower(row, column)] += moments[hinge] * of.factor
                                              * (of.a[p / 3][p % 3] * of.b[q / 3][q % 3]
                                                 + of.b[p / 3][p % 3] * of.a[q / 3][q % 3]);
  }

  void
  ShellBody::find_tangent(const unsigned int t,
                          const Tangent      kind,
                          const Vector      &positions,
                          TriangleTangent   &to) const
  {
    const bool                   convex = kind == Tangent::convex;
    const double                 factor = (1. + damping) * parts.mesh.triangles()[t].volume();
    const TriangleStrain<double> at     = strains.triangle(t, positions);
    find_strain_slopes(t, at, positions, to);
    for (unsigned int p = 0; p < dofs[t].n; ++p)
      for (unsigned int q = 0; q <= p; ++q)
        to.entries[lower(p, q)]
            = factor * (p < 9 ? contract(to.CB[p], to.B[q]) : contract_bending(to.CB[p], to.B[q]));
    if (parts.mesh.kind() == ShellKind::hinges)
      add_stretch_geometry(t, at, convex, to);
    else
      add_membrane_geometry(t, at, convex, to);
    // what moments have that is positive makes steps shorter, and twice as many
    for (int edge = 0; edge < 3 && !convex; ++edge)
      if (const ShellTurn &turn = strains.turns(t)[edge]; turn.is_sheared())
        add_turn_geometry(t, edge, at, to);
      else if (turn.hinge >= 0 && strains.get_hinges()[turn.hinge].owner == t)
        add_hinge_geometry(t, edge, positions, to);
  }

  void
  ShellBody::add_columns(const unsigned int     t,
                         const TriangleTangent &of,
                         std::vector<double>   &columns) const
  {
    const std::size_t n      = parts.free_dofs.local_list().size();
    const double      volume = parts.mesh.triangles()[t].volume();
    parts.targets.for_each_weight(
        t,
        [&](const unsigned int weight, const unsigned int i, const double share)
        {
          const ShellStrain E      = example_strain(t, i);
          double           *column = columns.data() + n * parts.examples.strained_index(weight);
          for (unsigned int p = 0; p < dofs[t].n; ++p)
            if (const int row = parts.free_dofs.free_index(dofs[t].dofs[p]); row != FreeDofs::held)
              column[row] += share * volume * contract(of.CB[p], E);
        });
  }

  void
  ShellBody::assemble_tangent(const Tangent              kind,
                              const Vector              &positions,
                              const std::vector<double> &weights,
                              std::vector<double>       &matrix_values,
                              std::vector<double>       &columns,
                              OuterProducts             *products)
  {
    constexpr std::size_t at_once = 256;
    find_strains(positions, RotationUse::keep);
    find_stresses(positions, weights);
    columns.clear();
    if (parts.weights.n_unknown() > 0)
      columns.assign(parts.free_dofs.local_list().size() * parts.examples.n_strained_weights(), 0.);
    std::vector<TriangleTangent> tangents(std::min(at_once, dofs.size()));
    for (std::size_t first = 0; first < dofs.size(); first += at_once)
    {
      const std::size_t n = std::min(at_once, dofs.size() - first);
      for_each_part(parts.n_threads, n, parts.n_threads,
                    [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                    {
                      for (std::size_t i = begin; i < end; ++i)
                        find_tangent(first + i, kind, positions, tangents[i]);
                    });
      for (std::size_t i = 0; i < n; ++i)
      {
        const TriangleDofs &of = dofs[first + i];
        for (unsigned int entry = 0; entry < of.n * (of.n + 1) / 2; ++entry)
          if (of.positions[entry] >= 0)
            matrix_values[of.positions[entry]] += tangents[i].entries[entry];
        if (!columns.empty())
          add_columns(first + i, tangents[i], columns);
      }
    }
    UnknownShear shear;
    find_shear(positions, shear);
    const std::size_t n_rows = parts.free_dofs.local_list().size();
    for (std::size_t begin = 0; begin < columns.size(); begin += n_rows)
      shear.forces_from_sheared(columns.data() + begin);
    if (!volumes.empty())
      volumes.add_tangent(kind, positions, weights, *pattern, parts.free_dofs, matrix_values,
                          columns, *products);
  }

  template <typename IndexOf>
  UnknownShear
  ShellBody::shear_by(const Vector &positions, const IndexOf &index_of) const
  {
    UnknownShear shear;
    shear.others.reserve(12 * parts.mesh.n_slopes());
    shear.factors.reserve(12 * parts.mesh.n_slopes());
    for (std::size_t h = 0; h < strains.get_hinges().size() && parts.mesh.n_slopes() > 0; ++h)
    {
      const ShellHinge &hinge = strains.get_hinges()[h];
      if (hinge.kind != 0)
        continue; // of a slope that is held
      const HingeAngle<double> angle = strains.hinge_angle(h, positions);
      const HingeForm<double> first = angle.gradient_of_side(0), second = angle.gradient_of_side(1);
      const double            half_length = 0.5 * parts.mesh.edges()[hinge.edge].length;
      for (int i = 0; i < 4; ++i)
        for (int c = 0; c < 3; ++c)
          if (const int other = index_of(3 * hinge.nodes[i] + c); other != FreeDofs::held)
          {
            shear.others.push_back(other);
            shear.factors.push_back(half_length * (second[i][c] - first[i][c]));
          }
      shear.sheared.push_back(index_of(3 * parts.mesh.slope_node(hinge.edge)));
      shear.ends.push_back(shear.others.size());
    }
    return shear;
  }

  void
  ShellBody::find_shear(const Vector &positions, UnknownShear &shear) const
  {
    shear = shear_by(positions,
                     [&](const unsigned int dof) { return parts.free_dofs.free_index(dof); });
  }

  void
  ShellBody::add_product(const unsigned int     t,
                         const TriangleTangent &tangent,
                         const Vector          &displacement,
                         Vector                &gradient) const
  {
    for (unsigned int p = 0; p < dofs[t].n; ++p)
      for (unsigned int q = 0; q < dofs[t].n; ++q)
        gradient[dofs[t].dofs[q]] += tangent.entries[lower(std::max(p, q), std::min(p, q))]
                                     * displacement[dofs[t].dofs[p]];
  }

  void
  ShellBody::add_response(const Tangent              kind,
                          const Vector              &displacement,
                          const Vector              &positions,
                          const std::vector<double> &weights,
                          ElasticEvaluation         &result)
  {
    find_strains(positions, RotationUse::keep);
    find_stresses(positions, weights);
    const UnknownShear shear
        = shear_by(positions, [](const unsigned int dof) { return static_cast<int>(dof); });
    Vector moved = displacement, gradient(positions.size());
    shear.to_sheared(moved.begin());
    std::vector<double> by_weights(result.weight_gradient.size(), 0.);
    TriangleTangent     tangent;
    for (unsigned int t = 0; t < dofs.size(); ++t)
    {
      if (!dofs[t].is_beside_held)
        continue;
      find_tangent(t, kind, positions, tangent);
      add_product(t, tangent, moved, gradient);
      ShellStrain stress{};
      for (unsigned int p = 0; p < dofs[t].n; ++p)
        for (int k = 0; k < 6; ++k)
          stress[k] += moved[dofs[t].dofs[p]] * tangent.CB[p][k];
      if (!by_weights.empty())
        add_weight_products(t, stress, -1., by_weights);
    }
    shear.forces_from_sheared(gradient.begin());
    volumes.add_response(kind, displacement, positions, weights, gradient, by_weights);
    const Exchange &exchange = parts.fe_space.exchange();
    exchange.assemble(gradient.begin(), 3);
    exchange.sum(by_weights);
    result.gradient += gradient;
    for (std::size_t i = 0; i < by_weights.size(); ++i)
      result.weight_gradient[i] += by_weights[i];
  }

  void
  ShellBody::add_exact_response(const Vector              &displacement,
                                const Vector              &positions,
                                const std::vector<double> &weights,
                                Vector                    &gradient)
  {
    find_strains(positions, RotationUse::keep);
    find_stresses(positions, weights);
    const UnknownShear shear
        = shear_by(positions, [](const unsigned int dof) { return static_cast<int>(dof); });
    Vector moved = displacement, response(positions.size());
    shear.to_sheared(moved.begin());
    TriangleTangent tangent;
    for (unsigned int t = 0; t < dofs.size(); ++t)
    {
      find_tangent(t, Tangent::exact, positions, tangent);
      add_product(t, tangent, moved, response);
    }
    shear.forces_from_sheared(response.begin());
    gradient += response;
  }
} // namespace Exemplar
