// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inertia_h
#define exemplar_inertia_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/body/state.h>
#include <exemplar/body/time_axis.h>

#include <deal.II/base/tensor.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <limits>
#include <vector>

namespace Exemplar
{
  /// Sums over the moving body, with the nodal momenta p = M v.
  struct MotionSums
  {
    double               kinetic_energy = 0.; ///< 1/2 v^T M v [J]
    dealii::Tensor<1, 3> momentum;            ///< sum p [kg m/s]
    dealii::Tensor<1, 3> angular_momentum;    ///< sum x times p, about the origin [kg m^2/s]
  };

  /// Positions of earlier steps and their weights in a formula of the time scheme.
  struct WeightedPositions
  {
    double                        weight;
    const dealii::Vector<double> *positions; ///< by degree of freedom [m]
  };

  /// Mass, time stepping and mass damping of dynamic scenes, Eqs. (12), (21) and (22). Statics and
  /// interpolation have no such object. Rates at the end of a step are
  /// v = gamma (x - x_star), with x_star from earlier positions.
  class Inertia
  {
  public:
    Inertia(const FESpace        &fe_space,
            const Material       &material,
            MassMatrix            kind,
            const TimeParameters &time = TimeParameters());

    /// Start a step of length h [s] from `state`.
    void
    begin_step(const State &state, double step_size);

    /// Add [M (gamma^2 + a gamma)] (x - x_hat) [N], inertia and mass damping a, to
    /// `gradient`, and the length of this nodal vector to the entry of `force_scale` of
    /// each node. Returns half the square of x - x_hat in that matrix [J].
    double
    add_gradient(const dealii::Vector<double> &positions,
                 dealii::Vector<double>       &gradient,
                 dealii::Vector<double>       &force_scale) const;

    /// A nodal force [N] that is nothing but the rounding of x - x_hat.
    double
    rounding_force() const
    {
      return 4. * std::numeric_limits<double>::epsilon() * predicted.linfty_norm() * greatest_mass
             * matrix_factor();
    }

    /// x_hat, where the body would be without forces.
    const dealii::Vector<double> &
    predicted_positions() const
    {
      return predicted;
    }

    /// The matrix is the product of the nodal mass matrix [kg] with I_3 and this factor.
    double
    matrix_factor() const
    {
      return gamma * (gamma + mass_damping);
    }

    /// Whether half the square of x - x_hat, which a step minimises with the energy, is
    /// |v_(n+1) - v_n|^2_M/2: where the energy bound of doc/method.md, Eq. (12), can hold.
    bool
    is_undamped_implicit_euler() const
    {
      return scheme == TimeScheme::implicit_euler && mass_damping == 0. && stiffness_damping == 0.;
    }

    /// Stiffness damping over the time that gamma stands for [-].
    double
    stiffness_damping_factor() const
    {
      return stiffness_damping * gamma;
    }

    /// The positions that make x_star in the step from `state`.
    std::vector<WeightedPositions>
    history(const State &state) const;

    const dealii::SparseMatrix<double> &
    nodal_mass() const
    {
      return mass;
    }

    /// Velocities, and what the next step needs of the one from `old` to `state`.
    void
    end_step(const State &old, State &state) const;

    MotionSums
    motion_sums(const State &state) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    dealii::Vector<double>
    mass_times(const dealii::Vector<double> &field) const;

    void
    copy_rows();

    dealii::SparsityPattern      pattern;
    dealii::SparseMatrix<double> mass;
    std::vector<std::size_t>     row_start; ///< the matrix once more: its entries are visited in
    std::vector<unsigned int>    columns;   ///< every iteration, and deal.II's iterators are slow
    std::vector<double>          values;
    const TimeScheme             scheme;
    const double                 mass_damping;       ///< [1/s]
    const double                 stiffness_damping;  ///< [s]
    double                       greatest_mass = 0.; ///< of a node, its row's sum [kg]
    double                       step_size     = 0.;
    double                       gamma         = 0.; ///< [1/s]
    double                       c_last        = 1.; ///< x_star = c_last x_n + c_previous x_(n-1)
    double                       c_previous    = 0.;
    dealii::Vector<double>       base;      ///< x_star
    dealii::Vector<double>       predicted; ///< x_hat
  };
} // namespace Exemplar

#endif
