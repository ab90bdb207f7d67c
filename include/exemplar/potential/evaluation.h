// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_evaluation_h
#define exemplar_evaluation_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/vector.h>

#include <vector>

namespace Exemplar
{
  /// The matrix with which a step is solved.
  enum class Tangent
  {
    exact, ///< the derivative of the gradient, Eq. (18)
    convex ///< never indefinite, together with the weights: R K R^T, Eq. (8), or its counterpart
  };

  /// Psi and its derivatives at given positions and weights: what the cells find, and terms add.
  struct ElasticEvaluation
  {
    Vector              gradient;             ///< internal forces dPsi/dx [N], Eq. (6)
    Vector              force_scale;          ///< a node: sum V (|C:e| + eta |C:E(w)|) |g_a| [N]
    std::vector<double> weight_gradient;      ///< dPsi/dw_i [J], Eq. (7)
    double              weight_scale     = 0; ///< of the weight gradient [J]
    double              stress_square    = 0; ///< sum V (|C:e| + eta |C:E(w)|)^2
    double              energy           = 0; ///< Psi [J], Eq. (5), ridge included
    double              energy_elastic   = 0; ///< sum V/2 e:C:e of it [J]
    double              energy_damping   = 0; ///< whose gradient is the stiffness damping [J]
    double              energy_inelastic = 0; ///< of it: hardening, and potentials of flow [J]
    double              energy_memory    = 0; ///< of weights that remember [J]; no part of Psi
    double              rounding_energy = 0; ///< of terms: what of their energy is nothing else [J]
    double              min_det_F       = 0;
    unsigned int        inverted_cells  = 0;
    unsigned int        guarded_cells   = 0; ///< in which the guard of Eq. (16) acts

    /// What else is in Psi [J]; near an example it almost cancels the elastic energy.
    double
    energy_example() const
    {
      return energy - energy_elastic - energy_inelastic;
    }
  };

  /// What terms add to. Its counts, the least det F and the scale of the weight gradient are the cells'.
  using ElasticSums = OwnSums<ElasticEvaluation>;

  /// Energies, derivatives, scales and counts of the body; all processes must call this.
  ElasticEvaluation
  complete(const Exchange &exchange, ElasticSums &&sums);

  /// The incremental potential at given positions and weights, and what it is made of.
  struct Evaluation
  {
    ElasticEvaluation   elastic;
    Vector              gradient;      ///< of the whole [N]; on held components the reaction
    Vector              force_scale;   ///< a node, of all forces [N]
    std::vector<double> term_energies; ///< of the terms beside the cells, in their order [J]
    double              potential = 0; ///< Phi [J], Eq. (22)
    double              rounding_energy
        = 0; ///< what of the terms' energies is rounding, beyond that of sums [J]
  };
} // namespace Exemplar

#endif
