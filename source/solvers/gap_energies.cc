// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/solvers/gap_energies.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    constexpr double kept_part = 0.1; ///< of a gap in one go

    enum Kind : char
    {
      along_normal,
      first_across,
      second_across
    };

    Barrier
    barrier(const Gap &gap)
    {
      return { gap.stiffness, gap.width };
    }

    /// f, f'/y and f'' of friction's energy, which is smooth at no slip.
    struct Smoothed
    {
      double value, slope_over_slip, curvature;
    };

    Smoothed
    smoothed(const double slip, const double width)
    {
      const double s = slip / width;
      if (s >= 1.)
        return { slip - width / 3., 1. / slip, 0. };
      return { width * s * s * (1. - s / 3.), (2. - s) / width, 2. * (1. - s) / width };
    }

    /// A unit vector at right angles to one.
    dealii::Tensor<1, 3>
    across(const dealii::Tensor<1, 3> &normal)
    {
      unsigned int least = 0;
      for (unsigned int c = 1; c < 3; ++c)
        if (std::abs(normal[c]) < std::abs(normal[least]))
          least = c;
      dealii::Tensor<1, 3> axis;
      axis[least]                      = 1.;
      const dealii::Tensor<1, 3> other = dealii::cross_product_3d(normal, axis);
      return other / other.norm();
    }
  } // namespace

  GapEnergies::GapEnergies(std::vector<Gap> new_gaps) : gaps(std::move(new_gaps))
  {
    const auto add = [&](const unsigned int gap, const dealii::Tensor<1, 3> &direction, Kind kind)
    {
      rows.push_back({ gap, direction });
      kinds.push_back(kind);
    };
    for (unsigned int g = 0; g < gaps.size(); ++g)
    {
      if (gaps[g].stiffness > 0.)
        add(g, gaps[g].normal, along_normal);
      if (gaps[g].friction <= 0.)
        continue;
      const dealii::Tensor<1, 3> first = across(gaps[g].friction_normal);
      add(g, first, first_across);
      add(g, dealii::cross_product_3d(gaps[g].friction_normal, first), second_across);
    }
  }

  std::vector<double>
  GapEnergies::changes(const Vector &displacement) const
  {
    std::vector<double> result(n_rows());
    for (std::size_t r = 0; r < n_rows(); ++r)
    {
      const Gap &gap = gap_of(r);
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
      {
        const auto [factor, vector] = gap.derivative(i, rows[r].direction);
        for (unsigned int c = 0; c < 3; ++c)
          result[r] += factor * vector[c] * displacement[3 * gap.nodes[i] + c];
      }
    }
    return result;
  }

  std::vector<double>
  GapEnergies::distances(const Vector &displacement) const
  {
    const std::vector<double> all = changes(displacement);
    std::vector<double>       result(gaps.size(), std::numeric_limits<double>::infinity());
    for (std::size_t r = 0; r < n_rows(); ++r)
      if (kinds[r] == along_normal)
        result[rows[r].gap] = gap_of(r).distance + all[r];
    return result;
  }

  void
  GapEnergies::add_forces(const std::vector<double> &by_row, Vector &field) const
  {
    for (std::size_t r = 0; r < n_rows(); ++r)
    {
      const Gap &gap = gap_of(r);
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
      {
        const auto [factor, vector] = gap.derivative(i, rows[r].direction);
        for (unsigned int c = 0; c < 3; ++c)
          field[3 * gap.nodes[i] + c] += by_row[r] * factor * vector[c];
      }
    }
  }

  GapEnergies::Slip
  GapEnergies::slip(const std::size_t row, const std::vector<double> &changes) const
  {
    const Gap   &gap = gap_of(row);
    const double x   = gap.slip * rows[row].direction + changes[row],
                 y   = gap.slip * rows[row + 1].direction + changes[row + 1];
    return { x, y, std::hypot(x, y) };
  }

  double
  GapEnergies::value(const std::vector<double> &changes) const
  {
    double sum = 0.;
    for (std::size_t r = 0; r < n_rows(); ++r)
    {
      const Gap &gap = gap_of(r);
      if (kinds[r] == along_normal)
        sum += barrier(gap).value(gap.distance + changes[r]);
      else if (kinds[r] == first_across)
        sum += gap.friction * smoothed(slip(r, changes).length, gap.slip_width).value;
    }
    return sum;
  }

  std::vector<double>
  GapEnergies::slopes(const std::vector<double> &changes) const
  {
    std::vector<double> result(n_rows());
    for (std::size_t r = 0; r < n_rows(); ++r)
    {
      const Gap &gap = gap_of(r);
      if (kinds[r] == along_normal)
        result[r] = barrier(gap).slope(gap.distance + changes[r]);
      else if (kinds[r] == first_across)
      {
        const Slip   u = slip(r, changes);
        const double f = gap.friction * smoothed(u.length, gap.slip_width).slope_over_slip;
        result[r]      = f * u.x;
        result[r + 1]  = f * u.y;
      }
    }
    return result;
  }

  GapEnergies::Blocks
  GapEnergies::root_of_curvatures(const std::vector<double> &changes) const
  {
    Blocks root;
    root.diagonal.resize(n_rows());
    root.beside_next.resize(n_rows());
    for (std::size_t r = 0; r < n_rows(); ++r)
    {
      const Gap &gap = gap_of(r);
      if (kinds[r] == along_normal)
        root.diagonal[r] = std::sqrt(barrier(gap).curvature(gap.distance + changes[r]));
      else if (kinds[r] == first_across)
      {
        const Slip     u     = slip(r, changes);
        const Smoothed f     = smoothed(u.length, gap.slip_width);
        const double   a     = std::sqrt(gap.friction * f.slope_over_slip), // across the slip
            b                = std::sqrt(gap.friction * f.curvature);       // along it
        const double x       = u.length > 0. ? u.x / u.length : 1.,
                     y       = u.length > 0. ? u.y / u.length : 0.;
        root.diagonal[r]     = a * y * y + b * x * x;
        root.diagonal[r + 1] = a * x * x + b * y * y;
        root.beside_next[r]  = (b - a) * x * y;
      }
    }
    return root;
  }

  void
  GapEnergies::Blocks::multiply(const std::vector<double> &vector,
                                std::vector<double>       &product) const
  {
    product.resize(vector.size());
    for (std::size_t r = 0; r < vector.size(); ++r)
      product[r] = diagonal[r] * vector[r];
    for (std::size_t r = 0; r + 1 < vector.size(); ++r)
      if (beside_next[r] != 0.)
      {
        product[r] += beside_next[r] * vector[r + 1];
        product[r + 1] += beside_next[r] * vector[r];
      }
  }

  dealii::LAPACKFullMatrix<double>
  GapEnergies::Blocks::on_both_sides_of(const dealii::FullMatrix<double> &matrix) const
  {
    const std::size_t                m = diagonal.size();
    dealii::LAPACKFullMatrix<double> result(m, m);
    std::vector<double>              sum(m);
    for (std::size_t i = 0; i < m; ++i)
    {
      const std::size_t begin = i > 0 ? i - 1 : 0; // what entries beside the diagonal need, too
      for (std::size_t j = begin; j < m; ++j)
        sum[j] = diagonal[i] * matrix(i, j);
      const auto add = [&](const double factor, const std::size_t row)
      {
        if (factor != 0.)
          for (std::size_t j = begin; j < m; ++j)
            sum[j] += factor * matrix(row, j);
      };
      add(i > 0 ? beside_next[i - 1] : 0., i - 1);
      add(beside_next[i], i + 1);
      double *column = &result(0, i); // stored by columns
      for (std::size_t j = i; j < m; ++j)
        column[j] = diagonal[j] * sum[j];
      for (std::size_t j = i; j + 1 < m; ++j)
        column[j] += beside_next[j] * sum[j + 1];
      for (std::size_t j = std::max<std::size_t>(i, 1); j < m; ++j)
        column[j] += beside_next[j - 1] * sum[j - 1];
    }
    return result;
  }

  double
  GapEnergies::longest_part(const std::vector<double> &changes,
                            const std::vector<double> &further) const
  {
    double part = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < n_rows(); ++r)
      if (kinds[r] == along_normal && further[r] < 0.)
        part = std::min(part, (1. - kept_part) * (gap_of(r).distance + changes[r]) / -further[r]);
    return part;
  }
} // namespace Exemplar
