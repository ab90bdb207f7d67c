// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elastic_body_h
#define exemplar_elastic_body_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/kernels/cell_task.h>
#include <exemplar/potential/evaluation.h>

#include <utility>
#include <vector>

namespace Exemplar
{
  class CellOrder;

  /// Pairs of nodes whose degrees of freedom a matrix couples.
  using NodePairs = std::vector<std::pair<unsigned int, unsigned int>>;

  /// What frames show of a cell: means over its quadrature points, and the least det F.
  struct CellResults
  {
    std::vector<double> strain_energy_density; ///< 1/2 e:C:e of the elastic strain [J/m^3]
    std::vector<double> det_F;                 ///< of a shell the ratio of the area to that at rest
    std::vector<double> von_mises_stress;      ///< of the corotated stress C:(e - eta E(w)) [Pa]
    std::vector<double> plastic_strain
        = {}; ///< the equivalent one [-]; empty unless cells may yield
    std::vector<int> weight_region
        = {}; ///< number of the region with the greatest share; empty unless regions were found
  };

  /// Psi(x, w), Eqs. (5) and (16), with the stiffness damping, as solvers know it, whatever the body is
  /// made of. Rotations are kept ("frozen") until update_rotations() or an evaluation that updates
  /// them. Positions, displacements and forces are by degree of freedom.
  class ElasticBody
  {
  public:
    virtual ~ElasticBody() = default;

    /// The pattern of its tangent and these couplings; `in_parts`: without the couplings of outer products.
    virtual SymmetricPattern
    make_pattern(const NodePairs &more, bool in_parts) const = 0;

    /// Whether its tangent has outer products, which a pattern may be without.
    virtual bool
    couples_by_products() const = 0;

    /// Whether its tangent has outer products over many nodes, which no pattern takes: assemble_tangent() needs
    /// OuterProducts then, whatever the pattern is.
    virtual bool
    has_dense_products() const
    {
      return false;
    }

    /// Whether the matrix of its tangent is by other unknowns than degrees of freedom, which find_shear() gives.
    virtual bool
    shears_unknowns() const
    {
      return false;
    }

    /// Set the shear of the free degrees of freedom at these positions. Values of assemble_tangent() are those of T^T A T; its columns
    /// are by degree of freedom.
    virtual void
    find_shear(const Vector & /*positions*/, UnknownShear &shear) const
    {
      shear.clear();
    }

    /// The pattern, of make_pattern(), or what is held, is another from now on. It outlives the body.
    virtual void
    attach(const SymmetricPattern &pattern)
        = 0;

    /// The material, the importance of the examples or the weights' form are others from now on.
    virtual void
    follow_parameters()
        = 0;

    /// A step begins with the stiffness damping s, Eq. (22), towards the strains of earlier positions.
    virtual void
    begin_step(double s, const std::vector<WeightedPositions> &past)
        = 0;

    /// From now on states are evaluated without a step that leads to them, and so without damping.
    virtual void
    leave_step()
        = 0;

    /// Let the laws know the size of the step [s], infinite in statics; 0: no step, in which history
    /// variables stay.
    virtual void
    set_step_size(double size)
        = 0;

    /// How what processes have of State::history becomes that of the whole body.
    virtual const CellOrder &
    history_order() const = 0;

    /// Whether a law has history variables.
    virtual bool
    remembers() const = 0;

    /// What the laws remember before the first step, in the layout of State::history; empty: nothing.
    virtual std::vector<double>
    initial_history() const = 0;

    /// Let the laws remember this, in the layout of State::history; empty: nothing.
    virtual void
    set_history(const std::vector<double> &history)
        = 0;

    /// What the laws remember after a step that ends at these positions, of which the rotations are.
    virtual std::vector<double>
    advance_history(const Vector &positions) = 0;

    /// Let the rotations be those of these positions.
    virtual void
    update_rotations(const Vector &positions)
        = 0;

    /// About the rotation of each node: nine numbers a node, by rows.
    virtual void
    node_rotations(std::vector<float> &rotations)
        = 0;

    /// Energies and their derivatives. If the caller has the weight_linear_term() of these
    /// positions, the derivatives by the weights are H w - c, and the loop need not sum them.
    virtual void
    evaluate(const Vector              &positions,
             const std::vector<double> &weights,
             ElasticEvaluation         &evaluation,
             RotationUse                rotations   = RotationUse::keep,
             const std::vector<double> *linear_term = nullptr)
        = 0;

    /// Add what the cells of this process give to A, Eq. (8) or (18), to the values on the pattern
    /// [N/m], and to `products` where the pattern wants them apart, and, with weights to find, set
    /// what they give to the coupling G, Eqs. (9) and (40): a column a strained weight on
    /// FreeDofs::local_list(), one after the other [N]. An exact tangent needs the rotations of these
    /// positions.
    virtual void
    assemble_tangent(Tangent                    tangent,
                     const Vector              &positions,
                     const std::vector<double> &weights,
                     std::vector<double>       &matrix_values,
                     std::vector<double>       &columns,
                     OuterProducts             *products = nullptr)
        = 0;

    /// Add what `displacement` [m] from `positions`, zero but on held degrees of freedom, changes
    /// by that tangent in the forces and the weight gradient. Only cells beside held nodes feel it.
    virtual void
    add_response(Tangent                    tangent,
                 const Vector              &displacement,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 ElasticEvaluation         &evaluation)
        = 0;

    /// c_i with dPsi/dw = H w - c at these positions [J].
    virtual std::vector<double>
    weight_linear_term(const Vector &positions, RotationUse rotations = RotationUse::keep) = 0;

    /// What frames show.
    virtual CellResults
    cell_results(const Vector &positions, const std::vector<double> &weights)
        = 0;

    /// A residual force [N] that is nothing but the rounding of the positions. Their greatest coordinate is `size` [m], or
    /// what it is at rest if that is more.
    virtual double
    rounding_force(double size) const = 0;

    /// A change of the energy [J] that is nothing but the rounding of the positions, where it is more than that of sums.
    virtual double
    rounding_energy(const ElasticEvaluation & /*at*/) const
    {
      return 0.;
    }

    /// A derivative of the energy by a weight [J] that is nothing but the rounding of the positions.
    virtual double
    rounding_weight_gradient() const = 0;

    /// In bytes, its pattern included.
    virtual std::size_t
    memory_consumption() const = 0;

    /// Whether an earlier tangent that turns with the nodes is good for many steps. It is not in sheets, whose triangles turn against
    /// each other, and are much stiffer along themselves than across.
    virtual bool
    keeps_its_tangent() const
    {
      return true;
    }
  };
} // namespace Exemplar

#endif
