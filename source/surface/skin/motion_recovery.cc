// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/motion_recovery.h>

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Exemplar
{
  namespace
  {
    using Neighbours = std::vector<std::vector<unsigned int>>;

    constexpr std::size_t  n_sufficient = 24; ///< neighbours; two rings inside have more
    constexpr unsigned int max_rings    = 3;

    /// The nodes that share a cell with each node, itself included.
    Neighbours
    neighbours_of_nodes(const Mesh &mesh)
    {
      Neighbours neighbours(mesh.n_nodes());
      for (const auto &cell : mesh.get_cells())
        for (const unsigned int node : cell)
          neighbours[node].insert(neighbours[node].end(), cell.begin(), cell.end());
      for (std::vector<unsigned int> &of_node : neighbours)
      {
        std::sort(of_node.begin(), of_node.end());
        of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
      }
      return neighbours;
    }

    /// The node and as many rings of nodes around it as a fit needs.
    std::vector<unsigned int>
    neighbourhood_of(const unsigned int node, const Neighbours &neighbours)
    {
      std::set<unsigned int> neighbourhood = { node };
      for (unsigned int ring = 0; ring < max_rings && neighbourhood.size() <= n_sufficient; ++ring)
        for (const unsigned int inner :
             std::vector<unsigned int>(neighbourhood.begin(), neighbourhood.end()))
          neighbourhood.insert(neighbours[inner].begin(), neighbours[inner].end());
      return { neighbourhood.begin(), neighbourhood.end() };
    }

    /// The inverse of the Cholesky factor of the mean of d d^T over the differences d of the
    /// neighbourhood's places from the node's: flat neighbourhoods are as good as round ones.
    dealii::Tensor<2, 3>
    rounding_map(const unsigned int               node,
                 const std::vector<unsigned int> &neighbourhood,
                 const Mesh                      &mesh)
    {
      dealii::Tensor<2, 3> M, L;
      for (const unsigned int other : neighbourhood)
      {
        const dealii::Tensor<1, 3> d = mesh.get_nodes()[other] - mesh.get_nodes()[node];
        M += dealii::outer_product(d, d) / static_cast<double>(neighbourhood.size());
      }
      dealii::FullMatrix<double> factor(3, 3);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          factor(i, j) = M[i][j];
      factorize_by_cholesky(factor, [](unsigned int, const double pivot, const double entry)
                            { return std::max(pivot, 1e-28 * entry); });
      factor.copy_to(L);
      return dealii::invert(L);
    }
  } // namespace

  void
  NodalSum::add(const unsigned int node, const double coefficient)
  {
    if (!is_in[node])
    {
      is_in[node] = true;
      nodes.push_back(node);
    }
    coefficients[node] += coefficient;
  }

  std::vector<NodalSum::Share>
  NodalSum::take()
  {
    std::sort(nodes.begin(), nodes.end());
    std::vector<Share> shares;
    for (const unsigned int node : nodes)
    {
      shares.push_back({ node, coefficients[node] });
      coefficients[node] = 0.;
      is_in[node]        = false;
    }
    nodes.clear();
    return shares;
  }

  std::array<double, MotionRecovery::n_monomials>
  MotionRecovery::monomials(const dealii::Tensor<1, 3> &d)
  {
    return { { d[0], d[1], d[2], d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[1] * d[2],
               d[2] * d[0] } };
  }

  MotionRecovery::MotionRecovery(const Mesh &mesh, const std::vector<bool> &is_wanted)
      : fits(mesh.n_nodes())
  {
    const Neighbours neighbours = neighbours_of_nodes(mesh);
    for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
      if (is_wanted[node])
        fits[node] = make_fit(node, neighbourhood_of(node, neighbours), mesh);
  }

  MotionRecovery::Fit
  MotionRecovery::make_fit(const unsigned int               node,
                           const std::vector<unsigned int> &neighbourhood,
                           const Mesh                      &mesh)
  {
    Fit fit;
    fit.to_round = rounding_map(node, neighbourhood, mesh);
    dealii::FullMatrix<double> matrix(n_monomials, n_monomials); // matrix of the normal equations
    for (const unsigned int other : neighbourhood)
      if (other != node)
      {
        const auto p = monomials(fit.to_round * (mesh.get_nodes()[other] - mesh.get_nodes()[node]));
        fit.neighbours.push_back(other);
        fit.coefficients.push_back(p);
        for (std::size_t i = 0; i < n_monomials; ++i)
          for (std::size_t j = 0; j < n_monomials; ++j)
            matrix(i, j) += p[i] * p[j];
      }
    // the ridge makes squares that cannot be told from linear functions vanish, and is too small
    // to be felt elsewhere
    const double ridge = 1e-10 * matrix.trace();
    for (std::size_t i = 3; i < n_monomials; ++i)
      matrix(i, i) += ridge;
    matrix.gauss_jordan();
    for (auto &of_neighbour : fit.coefficients)
    {
      const auto p = of_neighbour;
      for (std::size_t i = 0; i < n_monomials; ++i)
      {
        of_neighbour[i] = 0.;
        for (std::size_t j = 0; j < n_monomials; ++j)
          of_neighbour[i] += matrix(i, j) * p[j];
      }
    }
    make_exact_for_linear(fit, node, mesh);
    return fit;
  }

  void
  MotionRecovery::make_exact_for_linear(Fit &fit, const unsigned int node, const Mesh &mesh)
  {
    std::array<dealii::Tensor<1, 3>, n_monomials> seen; // derivatives of y itself by the fit
    for (std::size_t k = 0; k < fit.neighbours.size(); ++k)
    {
      const auto y = fit.to_round * (mesh.get_nodes()[fit.neighbours[k]] - mesh.get_nodes()[node]);
      for (std::size_t i = 0; i < n_monomials; ++i)
        seen[i] += fit.coefficients[k][i] * y;
    }
    dealii::Tensor<2, 3> A;
    for (unsigned int i = 0; i < 3; ++i)
      A[i] = seen[i];
    A = dealii::invert(A);
    for (auto &of_neighbour : fit.coefficients)
    {
      const dealii::Tensor<1, 3> linear
          = A * dealii::Tensor<1, 3>({ of_neighbour[0], of_neighbour[1], of_neighbour[2] });
      for (std::size_t i = 0; i < n_monomials; ++i)
        if (i < 3)
          of_neighbour[i] = linear[static_cast<unsigned int>(i)];
        else
          of_neighbour[i] -= seen[i] * linear;
    }
  }

  void
  MotionRecovery::add_change(const unsigned int          node,
                             const dealii::Tensor<1, 3> &first,
                             const dealii::Tensor<1, 3> &second,
                             const double                factor,
                             NodalSum                   &sum) const
  {
    const Fit                 &fit     = fits[node];
    const dealii::Tensor<1, 3> along   = fit.to_round * first;
    const dealii::Tensor<1, 3> outward = fit.to_round * second;
    auto                       values  = monomials(outward);
    // 3 is the mean square of the neighbours' distances in the round neighbourhood
    const double held = 3. / std::max(3., outward.norm_square());
    for (std::size_t i = 0; i < n_monomials; ++i)
      values[i] = i < 3 ? along[static_cast<unsigned int>(i)] : held * values[i];
    double whole = 0.;
    for (std::size_t k = 0; k < fit.neighbours.size(); ++k)
    {
      double coefficient = 0.;
      for (std::size_t i = 0; i < n_monomials; ++i)
        coefficient += factor * values[i] * fit.coefficients[k][i];
      sum.add(fit.neighbours[k], coefficient);
      whole += coefficient;
    }
    sum.add(node, -whole);
  }
} // namespace Exemplar
