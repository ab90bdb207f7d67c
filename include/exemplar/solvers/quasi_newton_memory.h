// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_quasi_newton_memory_h
#define exemplar_quasi_newton_memory_h

#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/linear_prediction.h>

#include <deal.II/lac/vector.h>

namespace Exemplar
{
  /// What the quasi-Newton method carries from step to step beside the state. With it a
  /// resumed run goes on as if it had never stopped.
  struct QuasiNewtonMemory
  {
    dealii::Vector<double> factor_positions;     ///< where the factor was made [m]; empty: none was
    double                 factor_inertia  = 0.; ///< Inertia::matrix_factor() then
    unsigned int           steps           = 0;  ///< since then
    unsigned int           iterations      = 0;  ///< in these steps
    unsigned int           last_iterations = 0;  ///< in the last of them
    Lbfgs                  lbfgs;                ///< in the frame of the factor
    LinearPrediction       velocities;           ///< of the last steps, by free degree of freedom

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return factor_positions.memory_consumption() + lbfgs.memory_consumption()
             + velocities.memory_consumption();
    }

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &factor_positions &factor_inertia &steps &iterations &last_iterations &lbfgs
          &velocities;
    }
  };
} // namespace Exemplar

#endif
