// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laboratory_h
#define exemplar_laboratory_h

#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/run/problem/row_matrix.h>

#include <memory>
#include <optional>
#include <vector>

namespace Exemplar
{
  class Problem;

  /// Means over each cell's quadrature points, weighted by their volumes.
  struct CellMeans
  {
    std::vector<Matrix3<double>> strains;  ///< strain as defined by the cell's law [-]
    std::vector<Matrix3<double>> stresses; ///< R T R^T of the corotated stress T [Pa]
    std::vector<double>          det_F;    ///< the minimum, not the mean
  };

  /// Arguments of the potential; there are as many weights as in the problem.
  struct Place
  {
    Vector              positions; ///< by degree of freedom [m]
    std::vector<double> weights;   ///< of the examples
  };

  /// The incremental potential Phi of a problem (Eqs. (5), (12), (22)) at arbitrary arguments: in a
  /// dynamic scene that of the next step, at its end; else that of the state's time. It is a
  /// separate potential without held nodes, so that evaluations here do not affect the problem's
  /// steps.
  /// One process only. With Model/Gradient = frozen, gradients and tangents are the paper's, with
  /// the rotations at the arguments.
  class Laboratory
  {
  public:
    /// The problem must outlive it. Throws UserError where several processes share the body.
    explicit Laboratory(Problem &problem);

    /// Update after changes of the problem's material, poses, importance or loads.
    void
    follow_parameters();

    /// Positions and weights of the problem's state.
    Place
    here() const;

    /// Phi and its gradient by all degrees of freedom; valid until the next call of any member
    /// function.
    const Evaluation &
    evaluate(const Place &at);

    /// d Phi/dw [J], without the kinks of weights that yield. Throws UserError if no weight is
    /// unknown.
    std::vector<double>
    weight_gradient(const Place &at);

    /// d2 Phi/dx2 [N/m], or with Tangent::convex its convexified substitute.
    RowMatrix
    hessian(const Place &at, Tangent kind);

    /// G = -d2 Phi/dx dw of Eq. (10) [N], n entries a weight, one weight after the other. Throws
    /// UserError if no weight is unknown.
    std::vector<double>
    coupling(const Place &at, Tangent kind);

    /// H = d2 Phi/dw2 of Eq. (9) [J]. Throws UserError if no weight is unknown.
    dealii::FullMatrix<double>
    weight_hessian();

    /// P with dw = P G^T dx for the weights that minimise Phi with fixed sums, weights at bounds
    /// kept there: the Hessian of min over w of Phi is A - G P G^T. Zero if no weight is unknown.
    /// Throws SolverFailure if the weights are not determined uniquely.
    dealii::FullMatrix<double>
    weight_compliance(const Place &at);

    CellMeans
    cell_means(const Place &at);

    /// eta E_i at the cells, one example after the other.
    std::vector<Matrix3<double>>
    example_strains() const;

  private:
    /// Set up the potential of the next step.
    void
    stand();

    void
    require_unknown_weights() const;

    /// Weights that are neither at a bound nor held by their memory.
    std::vector<unsigned int>
    weights_in_motion(const Place &at);

    /// Evaluate, and assemble the tangent of this kind.
    void
    assemble(const Place &at, Tangent kind);

    Problem                              &problem;
    ExampleWeights                        weights;
    const std::unique_ptr<TimeIntegrator> integrator; ///< in dynamic scenes
    FreeDofs                              free_dofs;  ///< all are free
    std::vector<PotentialTerm *>          own_terms;
    ElasticPotential                      cells;
    IncrementalPotential                  potential;
    Evaluation                            evaluation;
    std::vector<double>                   values, columns; ///< of the last assembled tangent
    SymmetricRows                         rows;
  };
} // namespace Exemplar

#endif
