// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laboratory_h
#define exemplar_laboratory_h

#include <exemplar/potential/incremental_potential.h>
#include <exemplar/run/problem/row_matrix.h>

#include <memory>
#include <optional>
#include <vector>

namespace Exemplar
{
  class Problem;

  /// Of each cell the mean over its quadrature points, weighted by their volumes.
  struct CellMeans
  {
    std::vector<Matrix3<double>> strains;  ///< what the law of the cell takes for its strain [-]
    std::vector<Matrix3<double>> stresses; ///< R T R^T of the corotated stress T [Pa]
    std::vector<double>          det_F;    ///< the least
  };

  /// Where a potential is asked for: the weights are as many as the problem's.
  struct Place
  {
    Vector              positions; ///< by degree of freedom [m]
    std::vector<double> weights;   ///< of the examples
  };

  /// The incremental potential Phi of a problem (Eqs. (5), (12), (22)) anywhere: in a dynamic scene that
  /// of the step that would be made next, at its end; else that of the state's time. It is a potential of
  /// its own, in which nothing is held, so that nothing here changes what the problem's next steps find.
  ///
  /// In one process only. With Model/Gradient = frozen, gradients and tangents are the paper's, with the
  /// rotations of the place.
  class Laboratory
  {
  public:
    /// The problem must outlive it. Throws UserError where several processes share the body.
    explicit Laboratory(Problem &problem);

    /// The problem's material, poses, importance or loads are others from now on.
    void
    follow_parameters();

    /// Positions and weights of the problem's state.
    Place
    here() const;

    /// Phi and its gradient by all degrees of freedom; valid until the next call of any function here.
    const Evaluation &
    evaluate(const Place &at);

    /// d Phi/dw [J], kinks of weights that yield aside. Throws UserError where no weight is unknown.
    std::vector<double>
    weight_gradient(const Place &at);

    /// d2 Phi/dx2 [N/m], or for Tangent::convex what takes its place.
    RowMatrix
    hessian(const Place &at, Tangent kind);

    /// G = -d2 Phi/dx dw of Eq. (10), one column a weight after the other [N]: n entries each.
    /// Throws UserError where no weight is unknown.
    std::vector<double>
    coupling(const Place &at, Tangent kind);

    /// H = d2 Phi/dw2 of Eq. (9) [J]. Throws UserError where no weight is unknown.
    dealii::FullMatrix<double>
    weight_hessian();

    /// P with dw = P G^T dx for the weights that minimise Phi under their sums while those at their
    /// bounds stay there: the Hessian of min over w of Phi is A - G P G^T. Zero where no weight is
    /// unknown. Throws SolverFailure if they are not determined.
    dealii::FullMatrix<double>
    weight_compliance(const Place &at);

    CellMeans
    cell_means(const Place &at);

    /// eta E_i of the examples at the cells, one example after the other.
    std::vector<Matrix3<double>>
    example_strains() const;

  private:
    /// The potential becomes that of the next step.
    void
    stand();

    void
    require_unknown_weights() const;

    /// Weights that are neither at their bound nor stuck where they were.
    std::vector<unsigned int>
    weights_in_motion(const Place &at);

    /// Evaluate, and assemble the tangent of this kind.
    void
    assemble(const Place &at, Tangent kind);

    Problem                              &problem;
    ExampleWeights                        weights;
    const std::unique_ptr<TimeIntegrator> integrator; ///< in dynamic scenes
    FreeDofs                              free_dofs;  ///< all
    std::vector<PotentialTerm *>          own_terms;
    IncrementalPotential                  potential;
    Evaluation                            evaluation;
    std::vector<double>                   values, columns; ///< of the last assembly
    SymmetricRows                         rows;
  };
} // namespace Exemplar

#endif
