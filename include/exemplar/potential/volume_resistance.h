// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_volume_resistance_h
#define exemplar_volume_resistance_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/enclosed_volumes.h>
#include <exemplar/body/example_targets.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/potential/evaluation.h>

#include <vector>

namespace Exemplar
{
  /// What the volumes that a shell encloses add to its body, Eq. (48): K V/2 (v - D)^2 of each piece with its volume V at rest, the
  /// change v of it over V, and what the examples ask for, D. Its tangent has an outer product over all nodes of a piece.
  class VolumeResistance
  {
  public:
    /// `targets` has one number a piece for each weight of `examples`; both must outlive this. `stiffness` is K [Pa].
    VolumeResistance(const EnclosedVolumes &volumes,
                     double                 stiffness,
                     const ExampleTargets  &examples,
                     const TargetBlock     &targets);

    bool
    empty() const
    {
      return volumes.size() == 0;
    }

    void
    set_stiffness(const double new_stiffness)
    {
      stiffness = new_stiffness;
    }

    /// As ElasticBody::begin_step(); leave_step() before.
    void
    begin_step(double s, const std::vector<WeightedPositions> &past);

    void
    leave_step();

    /// The positions of what follows.
    void
    find_changes(const Vector &positions);

    /// Add energies and forces, and the derivatives by the weights if there are any in the sums.
    void
    add(const Vector              &positions,
        const std::vector<double> &weights,
        bool                       with_weights,
        ElasticSums               &sums) const;

    /// As ElasticBody::weight_linear_term(), to be added.
    void
    add_weight_linear_term(std::vector<double> &c) const;

    /// As ElasticBody::assemble_tangent(); the columns may be empty, and the outer products are always apart.
    void
    add_tangent(Tangent                    kind,
                const Vector              &positions,
                const std::vector<double> &weights,
                const SymmetricPattern    &pattern,
                const FreeDofs            &free_dofs,
                std::vector<double>       &values,
                std::vector<double>       &columns,
                OuterProducts             &products) const;

    /// Add what a displacement changes by that tangent, in forces and in the derivatives by the weights, of which there may be none.
    void
    add_response(Tangent                    kind,
                 const Vector              &displacement,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 Vector                    &gradient,
                 std::vector<double>       &by_weights) const;

    /// The square of a stress, over a volume as ElasticEvaluation::stress_square has it, that comes of an error of the positions [m].
    double
    stress_square_of(double error) const;

    /// The force at a node [N] that comes of it.
    double
    force_of(double error) const;

    std::size_t
    memory_consumption() const;

  private:
    /// K V [J].
    double
    unit(const unsigned int piece) const
    {
      return stiffness * volumes.rest(piece);
    }

    double
    wanted(unsigned int piece, const std::vector<double> &weights) const;

    /// The derivative of the energy, that of damping included, by the change of a volume [J].
    double
    pressure(unsigned int piece, const std::vector<double> &weights) const;

    void
    add_columns(unsigned int         piece,
                const Vector        &gradient,
                const FreeDofs      &free_dofs,
                std::vector<double> &columns) const;

    const EnclosedVolumes volumes;
    double                stiffness;
    const ExampleTargets &examples;
    const TargetBlock    &targets;
    std::vector<double>   changes;      ///< v of find_changes()
    double                damping = 0.; ///< s
    std::vector<double>   past;         ///< v*; with damping alone
  };
} // namespace Exemplar

#endif
