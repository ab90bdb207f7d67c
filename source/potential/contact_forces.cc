// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/contact_forces.h>
#include <exemplar/potential/nodal_vectors.h>

#include <deal.II/lac/lapack_templates.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace Exemplar
{
  namespace
  {
    /// With all of its stiffness.
    Barrier
    full_barrier(const Touch &touch)
    {
      return { touch.full_stiffness, touch.gap.width };
    }

    /// The edge of a node of two edges, and the derivative of its vector by the node.
    constexpr std::array<unsigned int, 4> edges_of_nodes{ { 0, 0, 1, 1 } };
    constexpr std::array<double, 4>       signs_of_nodes{ { -1., 1., -1., 1. } };
  } // namespace

  double
  energy_of(const Touch &touch)
  {
    const double full = full_barrier(touch).value(touch.gap.distance);
    return touch.part.m == 0. && touch.gap.distance > 0. ? 0.
           : touch.part.m == 1.                          ? full
                                                         : touch.part.m * full;
  }

  ContactGradient
  gradient_of(const Touch &touch)
  {
    const Barrier   barrier = full_barrier(touch);
    const Gap      &gap     = touch.gap;
    const double    slope   = touch.part.m * barrier.slope(gap.distance);
    ContactGradient result;
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      result[i] = slope * gap.coefficients[i] * gap.normal;
    if (touch.part.m < 1.)
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        result[i]
            += signs_of_nodes[i] * barrier.value(gap.distance) * touch.part.by[edges_of_nodes[i]];
    return result;
  }

  dealii::Tensor<2, 2>
  inverse_of_free(const Nearest &at)
  {
    dealii::Tensor<2, 2> inverse;
    if (at.n_free == 2)
    {
      const double a = at.dv[0] * at.dv[0], b = at.dv[0] * at.dv[1], d = at.dv[1] * at.dv[1];
      const double determinant = a * d - b * b;
      if (determinant > 1e-14 * a * d)
      {
        inverse[0][0] = d / determinant;
        inverse[1][1] = a / determinant;
        inverse[0][1] = inverse[1][0] = -b / determinant;
      }
      else if (a > 0.)
        inverse[0][0] = 1. / a;
    }
    else if (at.n_free == 1)
      inverse[0][0] = 1. / (at.dv[0] * at.dv[0]);
    return inverse;
  }

  namespace
  {
    /// The second derivative of the distance: that of the least square over the free parameters, of which that of
    /// its root follows.
    ContactHessian
    curvature_of_distance(const Touch &touch)
    {
      ContactHessian result;
      const Nearest &at     = touch.at.nearest;
      const double   length = at.way.norm();
      const unsigned n      = touch.gap.n_nodes;
      const auto    &c      = touch.gap.coefficients;
      if (touch.at.is_flat || length == 0.)
        return result;
      const dealii::Tensor<2, 2>                 inverse = inverse_of_free(at);
      std::array<std::array<SpaceVector3, 2>, 4> mixed; // d^2 (v^2/2) / dx dtheta
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int k = 0; k < at.n_free; ++k)
          mixed[i][k] = c[i] * at.dv[k] + touch.by_free[k][i] * at.way;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          dealii::Tensor<2, 3> &block = result[i][j];
          for (unsigned int d = 0; d < 3; ++d)
            block[d][d] = c[i] * c[j];
          for (unsigned int k = 0; k < at.n_free; ++k)
            for (unsigned int l = 0; l < at.n_free; ++l)
              block -= inverse[k][l] * dealii::outer_product(mixed[i][k], mixed[j][l]);
          block -= c[i] * c[j] * dealii::outer_product(touch.gap.normal, touch.gap.normal);
          block /= length;
        }
      return result;
    }
  } // namespace

  namespace
  {
    /// Without the curvature of the distance, which a barrier counts the other way round where the distance is convex.
    ContactHessian
    hessian_along_normal(const Touch &touch)
    {
      const Gap     &gap       = touch.gap;
      const double   curvature = touch.part.m * full_barrier(touch).curvature(gap.distance);
      const auto     n_n       = dealii::outer_product(gap.normal, gap.normal);
      ContactHessian result;
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        for (unsigned int j = 0; j < gap.n_nodes; ++j)
          result[i][j] = curvature * gap.coefficients[i] * gap.coefficients[j] * n_n;
      return result;
    }

    ContactHessian
    exact_hessian(const Touch &touch)
    {
      const Barrier  barrier = full_barrier(touch);
      const Gap     &gap     = touch.gap;
      const double   d = gap.distance, slope = barrier.slope(d);
      ContactHessian result      = hessian_along_normal(touch),
                     of_distance = curvature_of_distance(touch);
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        for (unsigned int j = 0; j < gap.n_nodes; ++j)
        {
          result[i][j] += touch.part.m * slope * of_distance[i][j];
          if (touch.part.m == 1.)
            continue;
          const double       c_i = gap.coefficients[i], c_j = gap.coefficients[j];
          const double       s_i = signs_of_nodes[i], s_j = signs_of_nodes[j];
          const unsigned int e_i = edges_of_nodes[i], e_j = edges_of_nodes[j];
          result[i][j]
              += slope
                     * (c_i * s_j * dealii::outer_product(gap.normal, touch.part.by[e_j])
                        + s_i * c_j * dealii::outer_product(touch.part.by[e_i], gap.normal))
                 + barrier.value(d) * s_i * s_j * touch.part.twice[e_i][e_j];
        }
      return result;
    }

    constexpr unsigned int most_rows = 12; ///< of the blocks of a pair

    /// The eigenvalues of a symmetric matrix between `lower` and 0, and their vectors, by columns. LAPACK is called without
    /// deal.II, which prints an error for vectors of eigenvalues that are 0 but for rounding and have not converged: they do no harm.
    struct NegativeEigenvalues
    {
      NegativeEigenvalues(const unsigned int                         n_rows,
                          std::array<double, most_rows * most_rows> &matrix,
                          const double                               lower)
      {
        const dealii::types::blas_int rows = n_rows, one = 1, n_work = work.size();
        const double                  upper = 0., accuracy = 0.;
        dealii::types::blas_int       info = 0;
        dealii::syevx("V", "V", "U", &rows, matrix.data(), &rows, &lower, &upper, &one, &one,
                      &accuracy, &n, values.data(), vectors.data(), &rows, work.data(), &n_work,
                      integers.data(), failed.data(), &info);
      }

      dealii::types::blas_int                   n = 0;
      std::array<double, most_rows>             values{};
      std::array<double, most_rows * most_rows> vectors{};

    private:
      std::array<double, 40 * most_rows>                 work;
      std::array<dealii::types::blas_int, 5 * most_rows> integers;
      std::array<dealii::types::blas_int, most_rows>     failed;
    };

    /// The nearest matrix without negative eigenvalues.
    void
    project(ContactHessian &blocks, const unsigned int n_nodes)
    {
      const unsigned int                        n = 3 * n_nodes;
      std::array<double, most_rows * most_rows> matrix{};
      double                                    greatest = 0.;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          const double entry = blocks[i / 3][j / 3][i % 3][j % 3];
          matrix[i + n * j]  = entry;
          greatest           = std::max(greatest, std::abs(entry));
        }
      if (greatest == 0.)
        return;
      const NegativeEigenvalues negative(n, matrix, -2. * n * greatest);
      const auto               &v = negative.vectors;
      for (int e = 0; e < negative.n; ++e)
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            blocks[i / 3][j / 3][i % 3][j % 3] -= negative.values[e] * v[i + n * e] * v[j + n * e];
    }
  } // namespace

  ContactHessian
  hessian_of(const Touch &touch, const Tangent kind)
  {
    // the distance of a node from what is convex, as from all parts of an obstacle, is convex: nothing of it is left
    const bool is_of_node = touch.gap.n_nodes == 1;
    if (kind == Tangent::convex && is_of_node)
      return hessian_along_normal(touch);
    ContactHessian result = exact_hessian(touch);
    if (kind == Tangent::convex)
      project(result, touch.gap.n_nodes);
    return result;
  }

  Gap
  on_nodes(const Gap &gap, const ContactPoints &points)
  {
    if (points.empty())
      return gap;
    Gap result     = gap;
    result.n_nodes = 0;
    result.slip_by_nodes.clear();
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      points.visit(gap.nodes[i],
                   [&](const unsigned int node, const double weight)
                   {
                     const auto end   = result.nodes.begin() + result.n_nodes;
                     const auto place = std::find(result.nodes.begin(), end, node);
                     const auto n     = static_cast<std::size_t>(place - result.nodes.begin());
                     if (place == end)
                     {
                       result.nodes[n]        = node;
                       result.coefficients[n] = 0.;
                       ++result.n_nodes;
                       if (!gap.slip_by_nodes.empty())
                         result.slip_by_nodes.emplace_back();
                     }
                     result.coefficients[n] += weight * gap.coefficients[i];
                     if (!gap.slip_by_nodes.empty())
                       result.slip_by_nodes[n] += weight * gap.slip_by_nodes[i];
                   });
    return result;
  }

  namespace
  {
    void
    add_block(const unsigned int          node,
              const unsigned int          other,
              const dealii::Tensor<2, 3> &block,
              const SymmetricPattern     &pattern,
              const FreeDofs             &free_dofs,
              std::vector<double>        &values)
    {
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
        {
          const int row    = free_dofs.free_index(3 * node + a);
          const int column = free_dofs.free_index(3 * other + b);
          if (row != FreeDofs::held && column != FreeDofs::held && row >= column)
            values[pattern.position(row, column)] += block[a][b];
        }
    }
  } // namespace

  void
  add_blocks(const Gap              &gap,
             const ContactHessian   &blocks,
             const ContactPoints    &points,
             const SymmetricPattern &pattern,
             const FreeDofs         &free_dofs,
             std::vector<double>    &values)
  {
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
        points.visit(gap.nodes[i],
                     [&](const unsigned int node, const double weight)
                     {
                       points.visit(gap.nodes[j],
                                    [&](const unsigned int other, const double other_weight) {
                                      add_block(node, other, weight * other_weight * blocks[i][j],
                                                pattern, free_dofs, values);
                                    });
                     });
  }

  void
  add_products(const Gap            &gap,
               const ContactHessian &blocks,
               const ContactPoints  &points,
               const Vector         &displacement,
               Vector               &field)
  {
    for (unsigned int i = 0; i < gap.n_nodes; ++i)
      for (unsigned int j = 0; j < gap.n_nodes; ++j)
        points.add_to(field, gap.nodes[i], blocks[i][j] * points.value(displacement, gap.nodes[j]));
  }

  double
  rounding_of_distance(const Gap &gap, const double size)
  {
    // both points are rounded
    return 4. * std::numeric_limits<double>::epsilon() * std::max(size, gap.coordinates);
  }

  double
  rounding_force_of(const std::vector<Gap> &gaps, const Vector &positions)
  {
    if (gaps.empty())
      return 0.;
    constexpr double least_distance
        = 1e4; ///< roundings: nearer the whole force is rounding, and nothing is solved
    const double        size = max_entry(positions.begin(), positions.end());
    std::vector<double> squares(positions.size() / 3);
    for (const Gap &gap : gaps)
    {
      const double rounding = rounding_of_distance(gap, size);
      if (gap.distance <= least_distance * rounding)
        continue;
      const double force = rounding * Barrier{ gap.stiffness, gap.width }.curvature(gap.distance);
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        squares[gap.nodes[i]] += std::pow(gap.coefficients[i] * force, 2);
    }
    return std::sqrt(max_entry(squares));
  }

  std::pair<double, double>
  force_and_change_of(const std::vector<Rubbing> &now, const std::vector<Rubbing> &before)
  {
    double     greatest = 0., change = 0.;
    auto       old        = before.begin();
    const auto is_earlier = [](const Rubbing &a, const Rubbing &b)
    { return std::tie(a.obstacle, a.key) < std::tie(b.obstacle, b.key); };
    for (const Rubbing &at : now)
    {
      for (; old != before.end() && is_earlier(*old, at); ++old)
        change = std::max(change, old->force);
      const bool is_old = old != before.end() && !is_earlier(at, *old);
      greatest          = std::max(greatest, at.force);
      change            = std::max(change, std::abs(at.force - (is_old ? old->force : 0.)));
      if (is_old)
        ++old;
    }
    for (; old != before.end(); ++old)
      change = std::max(change, old->force);
    return { greatest, change };
  }

  double
  SlipEnergy::value(const double slip) const
  {
    const double s = slip / e;
    return greatest * (s < 1. ? slip * s * (1. - s / 3.) : slip - e / 3.);
  }

  double
  SlipEnergy::force_by_slip(const double slip) const
  {
    const double s = slip / e;
    return greatest * (s < 1. ? (2. - s) / e : 1. / slip);
  }

  dealii::Tensor<2, 3>
  SlipEnergy::curvature(const SpaceVector3 &slip, const SpaceVector3 &normal) const
  {
    const double         y      = slip.norm();
    dealii::Tensor<2, 3> result = -dealii::outer_product(normal, normal);
    for (unsigned int c = 0; c < 3; ++c)
      result[c][c] += 1.;
    result *= force_by_slip(y);
    if (y > 0.)
    {
      // along the slip f'' takes the place of f' / y
      const double second = y < e ? greatest * 2. / e * (1. - y / e) : 0.;
      result += (second - force_by_slip(y)) / (y * y) * dealii::outer_product(slip, slip);
    }
    return result;
  }
} // namespace Exemplar
