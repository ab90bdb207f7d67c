// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inertia_h
#define exemplar_inertia_h

#include <exemplar/fe_space.h>
#include <exemplar/material.h>
#include <exemplar/state.h>

#include <deal.II/base/tensor.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

namespace Exemplar
{
  /// Sums over the moving body, with the nodal momenta p = M v.
  struct MotionSums
  {
    double               kinetic_energy = 0.; ///< 1/2 v^T M v [J]
    dealii::Tensor<1, 3> momentum;            ///< sum p [kg m/s]
    dealii::Tensor<1, 3> angular_momentum;    ///< sum x times p, about the origin [kg m^2/s]
  };

  /// Mass and time stepping of dynamic scenes: implicit Euler, Eq. (12). Statics and
  /// interpolation have no such object.
  class Inertia
  {
  public:
    Inertia(const FESpace &fe_space, const Material &material, MassMatrix kind);

    /// Start a step of length h [s] from `state`: x_hat = x + h v.
    void
    begin_step(const State &state, double step_size);

    /// Add M (x - x_hat) / h^2 [N] to `gradient`, and the length of this nodal
    /// vector to the entry of `force_scale` of each node.
    void
    add_gradient(const dealii::Vector<double> &positions,
                 dealii::Vector<double>       &gradient,
                 dealii::Vector<double>       &force_scale) const;

    /// 1/(2 h^2) (x - x_hat)^T M (x - x_hat) [J].
    double
    step_energy(const dealii::Vector<double> &positions) const;

    /// x_hat, where the body would be without forces.
    const dealii::Vector<double> &
    predicted_positions() const
    {
      return predicted;
    }

    /// M/h^2 is the product of the nodal mass matrix [kg] with I_3 and this factor.
    double
    matrix_factor() const
    {
      return 1. / (step_size * step_size);
    }

    const dealii::SparseMatrix<double> &
    nodal_mass() const
    {
      return mass;
    }

    /// v = (x - x_old) / h.
    void
    end_step(const dealii::Vector<double> &old_positions, State &state) const;

    MotionSums
    motion_sums(const State &state) const;

  private:
    dealii::Vector<double>
    mass_times(const dealii::Vector<double> &field) const;

    dealii::SparsityPattern      pattern;
    dealii::SparseMatrix<double> mass;
    double                       step_size = 0.;
    dealii::Vector<double>       predicted; ///< x_hat
  };
} // namespace Exemplar

#endif
