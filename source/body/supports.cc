// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/body/supports.h>
#include <exemplar/mesh/rigid_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace Exemplar
{
  namespace
  {
    std::vector<dealii::Point<3>>
    nodes_of(const dealii::Vector<double> &positions)
    {
      std::vector<dealii::Point<3>> nodes;
      for (unsigned int dof = 0; dof < positions.size(); dof += 3)
        nodes.emplace_back(positions[dof], positions[dof + 1], positions[dof + 2]);
      return nodes;
    }

    /// The first nodes of the whole body, which are places.
    std::vector<dealii::Point<3>>
    places_of(const Exchange               &exchange,
              const dealii::Vector<double> &positions,
              const unsigned int            n_places)
    {
      std::vector<dealii::Point<3>> nodes = nodes_of(whole(exchange, positions, true));
      nodes.resize(std::min<std::size_t>(nodes.size(), n_places));
      return nodes;
    }

    void
    move_rigidly(const RigidMotion      &motion,
                 dealii::Vector<double> &positions,
                 const unsigned int      n_places)
    {
      std::vector<dealii::Point<3>> nodes = nodes_of(positions);
      nodes.resize(std::min<std::size_t>(nodes.size(), n_places));
      for (unsigned int node = 0; node < nodes.size(); ++node)
      {
        const dealii::Point<3> moved = motion(nodes[node]);
        for (unsigned int c = 0; c < 3; ++c)
          positions[3 * node + c] = moved[c];
      }
    }

    /// Union of the processes' degrees of freedom, numbered in the whole body.
    std::vector<unsigned int>
    in_whole(const Exchange                  &exchange,
             const std::size_t                n_dofs,
             const std::vector<unsigned int> &dofs)
    {
      std::vector<double> mask(n_dofs, 0.);
      for (const unsigned int dof : dofs)
        mask[dof] = 1.;
      mask = exchange.whole(mask.data(), 3, n_dofs / 3, true);
      std::vector<unsigned int> all;
      for (unsigned int dof = 0; dof < mask.size(); ++dof)
        if (mask[dof] > 0.)
          all.push_back(dof);
      return all;
    }

    unsigned int
    max_component(const dealii::Tensor<1, 3> &v)
    {
      unsigned int maximum = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(v[d]) > std::abs(v[maximum]))
          maximum = d;
      return maximum;
    }

    template <std::size_t n>
    unsigned int
    cell_nearest_to(const dealii::Point<3>                         &center,
                    const std::vector<dealii::Point<3>>            &nodes,
                    const std::vector<std::array<unsigned int, n>> &cells)
    {
      unsigned int nearest          = 0;
      double       nearest_distance = std::numeric_limits<double>::max();
      for (unsigned int cell = 0; cell < cells.size(); ++cell)
      {
        dealii::Point<3> middle;
        for (const unsigned int node : cells[cell])
          middle += nodes[node] / double(n);
        if (const double distance = middle.distance(center); distance < nearest_distance)
        {
          nearest          = cell;
          nearest_distance = distance;
        }
      }
      return nearest;
    }
  } // namespace

  namespace
  {
    /// The same of nodes about a center, of which some degrees of freedom are held, and turns about some axes; lengths are in
    /// diameters.
    unsigned int
    n_free_rigid_motions(const std::vector<dealii::Point<3>>     &nodes,
                         const dealii::Point<3>                  &center,
                         const double                             diameter,
                         const std::vector<unsigned int>         &held,
                         const std::vector<dealii::Tensor<1, 3>> &axes)
    {
      // rows: the values of the six rigid motions at a held degree of freedom
      dealii::FullMatrix<double> motions(held.size() + axes.size(), 6);
      for (unsigned int row = 0; row < held.size(); ++row)
      {
        const unsigned int         node = held[row] / 3, c = held[row] % 3;
        const unsigned int         d = (c + 1) % 3, e = (c + 2) % 3;
        const dealii::Tensor<1, 3> r = (nodes[node] - center) / diameter;
        motions(row, c)              = 1.;
        motions(row, 3 + d)          = r[e]; // (omega x r)_c = omega_d r_e - omega_e r_d
        motions(row, 3 + e)          = -r[d];
      }
      for (unsigned int row = 0; row < axes.size(); ++row)
        for (unsigned int c = 0; c < 3; ++c)
          motions(held.size() + row, 3 + c) = axes[row][c];
      return 6 - rank(motions, 1e-8);
    }
  } // namespace

  std::vector<unsigned int>
  n_free_rigid_motions(const Mesh                      &mesh,
                       const FESpace                   &fe_space,
                       const std::vector<unsigned int> &held_dofs,
                       const std::vector<unsigned int> &joined,
                       const HeldTips                  &tips)
  {
    const Exchange                     &exchange = mesh.exchange();
    const auto                         &rest     = fe_space.rest_positions();
    const std::vector<dealii::Point<3>> nodes    = nodes_of(whole(exchange, rest, true));
    const std::vector<unsigned int>     held     = in_whole(exchange, rest.size(), held_dofs);
    const std::vector<unsigned int>     own      = fe_space.numbering().pieces();
    const std::vector<double>           own_numbers(own.begin(), own.end());
    const std::vector<double>           pieces
        = exchange.whole(own_numbers.data(), 1, own_numbers.size(), true);
    const auto leader_of = [&](const double piece)
    {
      const auto own_piece = static_cast<unsigned int>(piece);
      return joined.empty() ? own_piece : joined[own_piece];
    };
    const unsigned int first_tip = fe_space.numbering().n_places();
    const auto         follows   = [&](const unsigned int node)
    { return !tips.empty() && node >= first_tip && follows_edge(tips[node - first_tip]); };
    const auto direction_of_edge = [&](const unsigned int node)
    {
      const auto &[a, b]              = fe_space.numbering().ends(node);
      const dealii::Tensor<1, 3> edge = nodes[b] - nodes[a];
      return edge / edge.norm();
    };
    std::vector<unsigned int> n_free;
    for (unsigned int piece = 0; piece < mesh.n_pieces(); ++piece)
    {
      std::vector<dealii::Point<3>> vertices;
      std::vector<unsigned int>     of_piece;
      for (unsigned int node = 0; node < mesh.whole().n_nodes; ++node)
        if (leader_of(pieces[node]) == piece)
          vertices.push_back(nodes[node]);
      std::vector<dealii::Tensor<1, 3>> axes;
      for (const unsigned int dof : held)
        if (leader_of(pieces[dof / 3]) == piece)
        {
          if (!follows(dof / 3))
            of_piece.push_back(dof);
          else if (dof % 3 == 0)
            axes.push_back(direction_of_edge(dof / 3));
        }
      n_free.push_back(vertices.empty() ? 0
                                        : n_free_rigid_motions(nodes, centroid(vertices),
                                                               mesh.diameter(), of_piece, axes));
    }
    return n_free;
  }

  namespace
  {
    /// The support in a cell with these nodes, of a triangle the first one twice.
    StaticallyDeterminateSupport
    support_in(const std::array<unsigned int, 4> &cell, const std::vector<dealii::Point<3>> &x)
    {
      const auto a = cell[0], b = cell[1], c = cell[2];

      // b may move along the dominant direction of ab only, c within the plane abc
      const unsigned int along  = max_component(x[b] - x[a]);
      const unsigned int normal = max_component(dealii::cross_product_3d(x[b] - x[a], x[c] - x[a]));
      std::vector<unsigned int> held = { 3 * a, 3 * a + 1, 3 * a + 2, 3 * c + normal };
      for (unsigned int d = 0; d < 3; ++d)
        if (d != along)
          held.push_back(3 * b + d);
      std::sort(held.begin(), held.end());
      return { cell, { { x[a], x[b], x[c], x[cell[3]] } }, { { a, b, c } }, held };
    }
  } // namespace

  StaticallyDeterminateSupport
  support_near_centroid(const std::vector<dealii::Point<3>>            &x,
                        const std::vector<std::array<unsigned int, 4>> &cells)
  {
    return support_in(cells[cell_nearest_to(centroid(x), x, cells)], x);
  }

  StaticallyDeterminateSupport
  support_near_centroid(const std::vector<dealii::Point<3>>            &x,
                        const std::vector<std::array<unsigned int, 3>> &triangles)
  {
    const auto &[a, b, c] = triangles[cell_nearest_to(centroid(x), x, triangles)];
    return support_in({ { a, b, c, a } }, x);
  }

  bool
  turn_to_support(const StaticallyDeterminateSupport &support,
                  const double                        angle,
                  dealii::Vector<double>             &positions,
                  const Exchange                     &exchange,
                  const unsigned int                  n_places)
  {
    const Vector                  all = whole(exchange, positions, true);
    std::vector<dealii::Point<3>> rest(support.rest.begin(), support.rest.end()), current;
    for (const unsigned int node : support.corners)
      current.emplace_back(all[3 * node], all[3 * node + 1], all[3 * node + 2]);
    const RigidMotion motion = best_rigid_motion(current, rest);
    if (axis_and_angle(motion.rotation).angle < angle)
      return false;
    move_rigidly(motion, positions, n_places);
    return true;
  }

  void
  remove_rigid_motion(const dealii::Vector<double> &positions,
                      dealii::Vector<double>       &displacement,
                      const Exchange               &exchange,
                      const unsigned int            n_places)
  {
    const std::vector<dealii::Point<3>> x = places_of(exchange, positions, n_places),
                                        u = places_of(exchange, displacement, n_places);
    const dealii::Point<3> center = centroid(x), shift = centroid(u);
    dealii::Tensor<2, 3>   inertia;
    dealii::Tensor<1, 3>   moment;
    for (unsigned int node = 0; node < x.size(); ++node)
    {
      const dealii::Tensor<1, 3> arm = x[node] - center;
      moment += dealii::cross_product_3d(arm, u[node] - shift);
      inertia += arm.norm_square() * dealii::unit_symmetric_tensor<3>() - outer_product(arm, arm);
    }
    // collinear points have no inertia about their line: then only the translation is taken out
    const bool has_volume = determinant(inertia) > 1e-12 * std::pow(trace(inertia), 3);
    const dealii::Tensor<1, 3> rotation
        = has_volume ? invert(inertia) * moment : dealii::Tensor<1, 3>();
    const std::vector<dealii::Point<3>> own = nodes_of(positions);
    for (unsigned int node = 0; node < std::min<std::size_t>(own.size(), n_places); ++node)
    {
      const dealii::Tensor<1, 3> rigid
          = shift + dealii::cross_product_3d(rotation, own[node] - center);
      for (unsigned int c = 0; c < 3; ++c)
        displacement[3 * node + c] -= rigid[c];
    }
  }

  void
  align(const dealii::Vector<double> &reference,
        dealii::Vector<double>       &positions,
        const Exchange               &exchange,
        const unsigned int            n_places)
  {
    move_rigidly(best_rigid_motion(places_of(exchange, positions, n_places),
                                   places_of(exchange, reference, n_places)),
                 positions, n_places);
  }

  void
  align_at(const std::vector<unsigned int> &dofs,
           const dealii::Vector<double>    &reference,
           dealii::Vector<double>          &positions,
           const Exchange                  &exchange)
  {
    const auto                           all     = nodes_of(whole(exchange, positions, true));
    const auto                           targets = nodes_of(whole(exchange, reference, true));
    std::map<unsigned int, unsigned int> n_components;
    for (const unsigned int dof : in_whole(exchange, positions.size(), dofs))
      ++n_components[dof / 3];
    std::vector<dealii::Point<3>> from, to;
    for (const auto &[node, n] : n_components)
      if (n == 3)
      {
        from.push_back(all[node]);
        to.push_back(targets[node]);
      }
    if (from.size() < 3 || are_collinear(from) || are_collinear(to))
      align(reference, positions, exchange);
    else
      move_rigidly(best_rigid_motion(from, to), positions, all_places);
  }
} // namespace Exemplar
