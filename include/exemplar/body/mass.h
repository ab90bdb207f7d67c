// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mass_h
#define exemplar_mass_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/body/state.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/tensor.h>
#include <deal.II/lac/sparse_matrix.h>

#include <vector>

namespace Exemplar
{
  /// Kinetic energy and momenta of the body, where p = M v are the nodal momenta.
  struct MotionSums
  {
    double               kinetic_energy = 0.; ///< 1/2 v^T M v [J]
    dealii::Tensor<1, 3> momentum;            ///< sum p [kg m/s]
    dealii::Tensor<1, 3> angular_momentum;    ///< sum x times p, about the origin [kg m^2/s]
  };

  /// The mass matrix of dynamic scenes: the product of a nodal matrix [kg] with I_3.
  class Mass
  {
  public:
    Mass(const FESpace &fe_space, const Material &material, MassMatrix kind);

    /// Replace the densities.
    void
    set_material(const FESpace &fe_space, const Material &material);

    /// The nodal matrix of this process' cells, a partial sum over processes.
    const dealii::SparseMatrix<double> &
    nodal() const
    {
      return matrix;
    }

    /// M times a field, by degree of freedom. This and motion_sums() are collective.
    Vector
    times(const Vector &field) const;

    /// A field as products take it: four numbers a node, of which the last is not used.
    using Padded = dealii::AlignedVector<double>;

    /// The partial sum of M times a field over the cells of this process. The product has the size
    /// of the field.
    void
    multiply(const Padded &field, Padded &product) const;

    /// Greatest row sum of the consistent matrix [kg].
    double
    max_nodal_mass() const
    {
      return max_row_sum;
    }

    MotionSums
    motion_sums(const State &state) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    copy_rows();

    const Exchange              &with_others;
    const CellKernels           &kernels;
    const MassMatrix             kind;
    dealii::SparsityPattern      pattern;
    dealii::SparseMatrix<double> matrix;
    std::vector<std::size_t>     row_start; ///< copy of its upper triangle, for fast products in
    std::vector<unsigned int>    columns;   ///< every iteration: deal.II's iterators are slow
    std::vector<double>          values;
    double                       max_row_sum = 0.; ///< row sum of the consistent matrix [kg]
  };
} // namespace Exemplar

#endif
