// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/solvers/step_path.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr double least_determinant = 1e-12; ///< of the cube of the trace
  }

  StepPath::StepPath(const Vector                    &positions,
                     Vector                           new_displacement,
                     const std::vector<unsigned int> &pieces,
                     const FreeDofs                  &free_dofs)
      : start(positions), displacement(std::move(new_displacement)), pieces(pieces)
  {
    if (free_dofs.exchange().any(!pieces.empty()))
      find_motions(free_dofs);
  }

  namespace
  {
    /// Sums over the nodes of each piece, of all processes: `add` adds a node's numbers to its piece's.
    template <unsigned int n, typename Add>
    std::vector<std::array<double, n>>
    sums_over_pieces(const std::size_t                n_pieces,
                     const std::vector<unsigned int> &pieces,
                     const Exchange                  &exchange,
                     const Add                       &add)
    {
      std::vector<double> sums(n * n_pieces);
      for (unsigned int node = 0; node < pieces.size(); ++node)
        if (exchange.owns(node))
          add(node, &sums[n * pieces[node]]);
      exchange.sum(sums);
      std::vector<std::array<double, n>> result(n_pieces);
      for (std::size_t i = 0; i < sums.size(); ++i)
        result[i / n][i % n] = sums[i];
      return result;
    }

    /// The angular velocity of a body with this angular momentum and these moments and products of inertia; 0 if they do not
    /// determine it.
    SpaceVector3
    turn_of(const std::array<double, 9> &sums)
    {
      dealii::Tensor<2, 3> inertia;
      for (unsigned int c = 0; c < 3; ++c)
      {
        const unsigned int i = (c + 1) % 3, j = (c + 2) % 3;
        inertia[c][c] = sums[3 + c];
        inertia[i][j] = inertia[j][i] = sums[6 + c];
      }
      const double size = trace(inertia);
      if (!(determinant(inertia) > least_determinant * size * size * size))
        return {};
      return dealii::invert(inertia) * dealii::Point<3>(sums[0], sums[1], sums[2]);
    }
  } // namespace

  void
  StepPath::find_motions(const FreeDofs &free_dofs)
  {
    const Exchange    &exchange = free_dofs.exchange();
    const unsigned int last  = pieces.empty() ? 0 : *std::max_element(pieces.begin(), pieces.end());
    const auto         n     = static_cast<std::size_t>(exchange.max(last)) + 1;
    const auto         means = sums_over_pieces<8>(
        n, pieces, exchange,
        [&](const unsigned int node, double *sums)
        {
          sums[0] += 1.;
          for (unsigned int c = 0; c < 3; ++c)
          {
            sums[1] += free_dofs.free_index(3 * node + c) == FreeDofs::held ? 1. : 0.;
            sums[2 + c] += start[3 * node + c];
            sums[5 + c] += displacement[3 * node + c];
          }
        });
    for (const std::array<double, 8> &of : means)
      motions.push_back({ dealii::Point<3>(of[2], of[3], of[4]) / of[0],
                          dealii::Point<3>(of[5], of[6], of[7]) / of[0], SpaceVector3() });
    const auto momenta = sums_over_pieces<9>(
        n, pieces, exchange,
        [&](const unsigned int node, double *sums)
        {
          const SpaceVector3 r = at_node(start, node) - motions[pieces[node]].centre;
          const SpaceVector3 l = dealii::cross_product_3d(r, at_node(displacement, node));
          for (unsigned int c = 0; c < 3; ++c)
          {
            sums[c] += l[c];
            sums[3 + c] += r.norm_square() - r[c] * r[c];
            sums[6 + c] -= r[(c + 1) % 3] * r[(c + 2) % 3];
          }
        });
    for (std::size_t piece = 0; piece < n; ++piece)
      if (const double n_held = means[piece][1]; n_held == 0.)
        motions[piece].turn = turn_of(momenta[piece]);
  }

  void
  StepPath::bend(const Vector &by)
  {
    if (bent.size() == 0)
      bent.reinit(by.size());
    bent += by;
  }

  Vector
  StepPath::at(const double part) const
  {
    Vector result = start;
    result.add(part, displacement);
    std::vector<dealii::Tensor<2, 3>> turns;
    for (const Motion &motion : motions)
      turns.push_back(rotation_by(part * motion.turn));
    for (unsigned int node = 0; node < pieces.size(); ++node)
    {
      const Motion &motion = motions[pieces[node]];
      if (motion.turn.norm_square() == 0.)
        continue;
      const SpaceVector3 r      = at_node(start, node) - motion.centre;
      const SpaceVector3 strain = at_node(displacement, node) - motion.translation
                                  - dealii::cross_product_3d(motion.turn, r);
      const SpaceVector3 x
          = motion.centre + part * motion.translation + turns[pieces[node]] * (r + part * strain);
      for (unsigned int c = 0; c < 3; ++c)
        result[3 * node + c] = x[c];
    }
    if (bent.size() > 0)
      result.add(part * part, bent);
    return result;
  }

  Vector
  StepPath::way(const double part) const
  {
    Vector result = displacement;
    if (is_straight() && bent.size() == 0)
      result *= part;
    else
    {
      result = at(part);
      result -= start;
    }
    return result;
  }
} // namespace Exemplar
