// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gap_h
#define exemplar_gap_h

#include <deal.II/base/tensor.h>

#include <array>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A gap between the body and what it may not pass: distance d > 0 [m] of a point sum c_i x_{n_i} (or of a pair)
  /// and its gradient along `normal`: that by x_{n_i} is c_i * normal. Its barrier's energy is that of
  /// Barrier{stiffness, width}; a stiffness of 0 says that it has none. Where it rubs it has the energy `friction` f(y), too,
  /// with y the length of the slip across `friction_normal`, f' = 2 y/e - (y/e)^2 below e = `slip_width` and 1 beyond.
  struct Gap
  {
    /// Four points of a pair, each of up to five nodes.
    static constexpr unsigned int max_nodes = 20;

    unsigned int                        n_nodes = 0;
    std::array<unsigned int, max_nodes> nodes{};
    std::array<double, max_nodes>       coefficients{};
    dealii::Tensor<1, 3>                normal;
    double                              distance  = 0.; ///< [m]
    double                              stiffness = 0.; ///< k [N]
    double                              width     = 0.; ///< d_hat [m]
    double                              coordinates
        = 0.; ///< greatest one beside the nodes' own that the distance was made of [m]
    double friction   = 0.; ///< coefficient times the lagged normal force [N]; 0: there is none
    double slip_width = 0.; ///< e [m]
    dealii::Tensor<1, 3> friction_normal; ///< the lagged normal, of length 1
    dealii::Tensor<1, 3>
        slip; ///< of the point relative to the obstacle in this step [m]; what is along the normal does not count
    /// Derivatives of the slip by the nodes' positions; empty: the coefficients times the unit matrix.
    std::vector<dealii::Tensor<2, 3>> slip_by_nodes;

    /// The factor and the vector whose product is the derivative by a node's position of the distance's or slip's part along
    /// a direction.
    std::pair<double, dealii::Tensor<1, 3>>
    derivative(const unsigned int node, const dealii::Tensor<1, 3> &direction) const
    {
      if (slip_by_nodes.empty())
        return { coefficients[node], direction };
      return { 1., direction * slip_by_nodes[node] };
    }
  };
} // namespace Exemplar

#endif
