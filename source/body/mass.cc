// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/padded_nodes.h>
#include <exemplar/base/errors.h>
#include <exemplar/body/mass.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/memory_consumption.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Lump a matrix: row sums on the diagonal.
    void
    sum_rows(dealii::SparseMatrix<double> &mass)
    {
      for (unsigned int row = 0; row < mass.m(); ++row)
      {
        double sum = 0.;
        for (auto entry = mass.begin(row); entry != mass.end(row); ++entry)
        {
          sum += entry->value();
          entry->value() = 0.;
        }
        mass.set(row, row, sum);
      }
    }

    /// Lumping where row sums are negative at vertices, as for quadratic elements: the diagonal of
    /// each cell's matrix is scaled to the cell's mass (Hinton, Rock, Zienkiewicz 1976).
    void
    scale_diagonals(const FESpace                &fe_space,
                    const std::vector<double>    &density,
                    dealii::SparseMatrix<double> &mass)
    {
      std::vector<double> diagonal(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        fe_space.share_out(density[cell] * fe_space.cell_volume(cell), ShareRule::lumped, cell,
                           diagonal);
      mass = 0.;
      for (unsigned int node = 0; node < diagonal.size(); ++node)
        mass.set(node, node, diagonal[node]);
    }
  } // namespace

  Mass::Mass(const FESpace &fe_space, const Material &material, const MassMatrix kind)
      : with_others(fe_space.exchange()), kernels(best_kernels(fe_space.element())), kind(kind),
        pattern(fe_space.nodal_pattern()), matrix(pattern)
  {
    set_material(fe_space, material);
  }

  void
  Mass::set_material(const FESpace &fe_space, const Material &material)
  {
    matrix = 0.;
    std::vector<double> density(fe_space.n_cells());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      density[cell] = material.density(cell);
    fe_space.compute_mass_matrix(density, matrix);
    max_row_sum = with_others.max(matrix.linfty_norm());
    if (!std::isfinite(max_row_sum))
      throw UserError("Material/Density: the mass of the body is not a finite number. Look at the "
                      "density, and at the mesh's unit.");
    if (kind == MassMatrix::lumped)
    {
      if (traits_of(fe_space.element()).in_cell.consistent.vertex < 0.)
        scale_diagonals(fe_space, density, matrix);
      else
        sum_rows(matrix);
    }
    copy_rows();
  }

  void
  Mass::copy_rows()
  {
    row_start.assign(1, 0);
    columns.clear();
    values.clear();
    for (unsigned int row = 0; row < matrix.m(); ++row)
    {
      columns.push_back(row);
      values.push_back(matrix.diag_element(row));
      for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
        if (entry->column() > row && entry->value() != 0.)
        {
          columns.push_back(entry->column());
          values.push_back(entry->value());
        }
      row_start.push_back(columns.size());
    }
  }

  void
  Mass::multiply(const Padded &field, Padded &product) const
  {
    product.fill(0.);
    kernels.multiply_nodes({ row_start.data(), columns.data(), values.data() }, field.size() / 4,
                           field.data(), product.data());
  }

  Vector
  Mass::times(const Vector &field) const
  {
    const std::size_t n = field.size() / 3;
    Padded            x(4 * n), product;
    product.resize_fast(4 * n);
    pad_nodes(field, x);
    multiply(x, product);
    OwnSums<Vector> sums(Vector(field.size()));
    for (std::size_t node = 0; node < n; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        (*sums)[3 * node + c] = product[4 * node + c];
    return complete(with_others, std::move(sums));
  }

  MotionSums
  Mass::motion_sums(const State &state) const
  {
    const Vector p  = times(state.velocities);
    const auto   at = [](const Vector &field, const unsigned int node) {
      return dealii::Tensor<1, 3>({ field[3 * node], field[3 * node + 1], field[3 * node + 2] });
    };
    MotionSums sums;
    sums.kinetic_energy = 0.5 * with_others.product(state.velocities, p);
    for (unsigned int node = 0; node < p.size() / 3; ++node)
      if (with_others.owns(node))
      {
        sums.momentum += at(p, node);
        sums.angular_momentum += dealii::cross_product_3d(at(state.positions, node), at(p, node));
      }
    with_others.sum(sums.momentum.begin_raw(), 3);
    with_others.sum(sums.angular_momentum.begin_raw(), 3);
    return sums;
  }

  std::size_t
  Mass::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return pattern.memory_consumption() + matrix.memory_consumption()
           + memory_consumption(row_start) + memory_consumption(columns)
           + memory_consumption(values);
  }
} // namespace Exemplar
