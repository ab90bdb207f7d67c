// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_potential_term_h
#define exemplar_potential_term_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/body/state.h>

#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A summand of the incremental potential beside the cells: inertia, loads. A term that a scene
  /// does not have is not there. Positions, forces and displacements are by degree of freedom.
  class PotentialTerm
  {
  public:
    virtual ~PotentialTerm() = default;

    /// What it is, in a word.
    virtual std::string
    name() const = 0;

    /// A step begins at `start`; the term belongs to it until leave_step().
    virtual void
    begin_step(const State & /*start*/)
    {
    }

    /// From now on states are evaluated without a step that leads to them.
    virtual void
    leave_step()
    {
    }

    /// From now on the term is that of time t [s].
    virtual void
    set_time(double /*time*/)
    {
    }

    /// Whether set_time() for these two times [s] makes different terms.
    virtual bool
    differs(double /*time*/, double /*other_time*/) const
    {
      return false;
    }

    /// Add the derivative by the positions [N] to `gradient`, and the size of its forces at each
    /// node to `force_scale` [N]. Returns the energy [J].
    virtual double
    add(const Vector &positions, Vector &gradient, Vector &force_scale) const = 0;

    /// Pairs of nodes that its tangent couples beside those that share a cell.
    virtual std::vector<std::pair<unsigned int, unsigned int>>
    couplings() const
    {
      return {};
    }

    /// The pattern on which add_tangent() will write is known now, and with whom a process shares the
    /// body: then add_tangent() adds what belongs to its own cells, and add() gives the energy of the
    /// whole body.
    virtual void
    attach(const SymmetricPattern & /*pattern*/, const FreeDofs & /*free_dofs*/)
    {
    }

    /// Add its tangent [N/m] to the values on the pattern.
    virtual void
    add_tangent(const Vector & /*positions*/, std::vector<double> & /*values*/) const
    {
    }

    /// A residual force [N] that is nothing but rounding.
    virtual double
    rounding_force() const
    {
      return 0.;
    }

    /// Append what statistics.csv shall show of the term, names and values, where its energy is
    /// `energy` [J].
    virtual void
    append_columns(double /*energy*/,
                   std::vector<std::pair<std::string, double>> & /*columns*/) const
    {
    }

    /// In bytes.
    virtual std::size_t
    memory_consumption() const = 0;
  };
} // namespace Exemplar

#endif
