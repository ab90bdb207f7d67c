// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loads_h
#define exemplar_loads_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/load_parameters.h>
#include <exemplar/body/material.h>
#include <exemplar/prm/expression.h>

#include <deal.II/lac/vector.h>

#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Gravity and dead forces.
  class Loads
  {
  public:
    /// The files of nodes are among `nodes`. Gravity acts on the masses of `mass_matrix`. Throws
    /// UserError for a load that selects nothing or that is not understood.
    Loads(const LoadsParameters &parameters,
          const Mesh            &mesh,
          const FESpace         &fe_space,
          const Material        &material,
          const NamedNodes      &nodes       = {},
          MassMatrix             mass_matrix = MassMatrix::consistent);

    /// From now on gravity is this acceleration [m/s^2], in a body of this material. Throws UserError
    /// for a weight that is not finite.
    void
    set_gravity(const std::array<double, 3> &acceleration,
                const FESpace               &fe_space,
                const Material              &material);

    /// From now on this force [N] acts on each node of this process, by degree of freedom, beside the
    /// named loads; empty: none does.
    void
    set_nodal_forces(dealii::Vector<double> forces)
    {
      nodal_force = std::move(forces);
    }

    const dealii::Vector<double> &
    nodal_forces() const
    {
      return nodal_force;
    }

    bool
    has_gravity() const
    {
      return gravity_force.size() > 0;
    }

    /// Nodal forces are one, without a name.
    bool
    has_named_loads() const
    {
      return !loads.empty() || nodal_force.size() > 0;
    }

    /// How many named ones there are.
    unsigned int
    size() const
    {
      return loads.size();
    }

    const std::string &
    name(const unsigned int load) const
    {
      return loads[load].name;
    }

    /// What a named one acts on, in this process.
    const std::vector<unsigned int> &
    nodes(const unsigned int load) const
    {
      return loads[load].nodes;
    }

    /// What multiplies all loads at time t: with Ramp = increments t, which goes from 0 to 1, else 1.
    double
    ramp_factor(const double time) const
    {
      return ramp == LoadRamp::increments ? time : 1.;
    }

    /// Nodal forces of gravity in full [N]; empty without gravity.
    const dealii::Vector<double> &
    gravity() const
    {
      return gravity_force;
    }

    /// Sum of the nodal forces of the named loads at time t [s], ramp included, into `force` [N].
    void
    named_loads(double time, dealii::Vector<double> &force) const;

  private:
    /// A dead force and the nodes of this process that share it.
    struct Load
    {
      std::string               name;
      std::vector<unsigned int> nodes;
      std::vector<double>       shares; ///< of each node; they sum to one
      Expression                force;
    };

    const LoadRamp         ramp;
    const MassMatrix       mass_matrix; ///< on whose masses gravity acts
    dealii::Vector<double> gravity_force;
    dealii::Vector<double> nodal_force; ///< see set_nodal_forces(); without the ramp
    std::vector<Load>      loads;
  };
} // namespace Exemplar

#endif
