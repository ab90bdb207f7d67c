// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_motion_recovery_h
#define exemplar_motion_recovery_h

#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// A linear combination of nodal values, put together node by node.
  class NodalSum
  {
  public:
    explicit NodalSum(unsigned int n_nodes) : coefficients(n_nodes, 0.), is_in(n_nodes, false) {}

    void
    add(unsigned int node, double coefficient);

    /// A summand: the coefficient of a node.
    struct Share
    {
      unsigned int node;
      double       coefficient;
    };

    /// The summands, by ascending nodes. Begins a new sum.
    std::vector<Share>
    take();

  private:
    std::vector<double>       coefficients;
    std::vector<bool>         is_in;
    std::vector<unsigned int> nodes;
  };

  /// The motion around nodes to second order, recovered from the displacements of the nodes around
  /// them. In the cells the gradient is constant; here a quadratic polynomial is fitted to the
  /// values at a node's neighbours, as the polynomial-preserving recovery does (Zhang and Naga
  /// 2005, SIAM J. Sci. Comput. 26), so that first and second derivatives are exact for quadratic
  /// motions, at the boundary, too. On a mesh one cell thick, where squares and linear functions
  /// coincide at the nodes, linear motions are still exact. The fit depends on places at rest
  /// alone: no motion makes it fail.
  class MotionRecovery
  {
  public:
    /// Prepares the fit at those nodes of the mesh for which `is_wanted`.
    MotionRecovery(const Mesh &mesh, const std::vector<bool> &is_wanted);

    /// Add factor (g . first + 1/2 second . H . second) to a sum over nodal values u, where g and H
    /// are the derivatives of u at a node that was wanted. Where `second` goes beyond the
    /// neighbours, its share grows no more, as the fit says nothing there.
    void
    add_change(unsigned int                node,
               const dealii::Tensor<1, 3> &first,
               const dealii::Tensor<1, 3> &second,
               double                      factor,
               NodalSum                   &sum) const;

  private:
    static constexpr std::size_t n_monomials = 9; ///< monomials of degree 1 and 2

    /// Monomials of degree 1, then of degree 2.
    static std::array<double, n_monomials>
    monomials(const dealii::Tensor<1, 3> &d);

    /// Coefficients of the polynomial: a value a monomial for each neighbour's difference from
    /// the node.
    struct Fit
    {
      dealii::Tensor<2, 3>      to_round; ///< map that makes the neighbourhood round
      std::vector<unsigned int> neighbours;
      std::vector<std::array<double, n_monomials>> coefficients;
    };

    static Fit
    make_fit(unsigned int node, const std::vector<unsigned int> &neighbourhood, const Mesh &mesh);

    /// Take rounding out of what a fit gives for linear motions.
    static void
    make_exact_for_linear(Fit &fit, unsigned int node, const Mesh &mesh);

    std::vector<Fit> fits; ///< fit of each node
  };
} // namespace Exemplar

#endif
