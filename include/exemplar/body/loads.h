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
    /// `nodes` contains the files of nodes. Gravity acts on the masses of `mass_matrix`. Throws
    /// UserError for a load that selects nothing or has an invalid formula.
    Loads(const LoadsParameters &parameters,
          const Mesh            &mesh,
          const FESpace         &fe_space,
          const Material        &material,
          const NamedNodes      &nodes       = {},
          MassMatrix             mass_matrix = MassMatrix::consistent);

    /// Set the acceleration of gravity [m/s^2], in a body of this material. Throws UserError for a
    /// weight that is not finite.
    void
    set_gravity(const std::array<double, 3> &acceleration,
                const FESpace               &fe_space,
                const Material              &material);

    /// Set further forces [N] at the nodes of this process, by degree of freedom, beside the named
    /// loads; empty: none.
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

    /// Whether there are loads apart from gravity; nodal forces count as one.
    bool
    has_named_loads() const
    {
      return !loads.empty() || nodal_force.size() > 0;
    }

    /// Number of named loads.
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

    /// Nodes of this process that a named load acts on.
    const std::vector<unsigned int> &
    nodes(const unsigned int load) const
    {
      return loads[load].nodes;
    }

    /// Factor of all loads at time t: t with Ramp = increments, which goes from 0 to 1, else 1.
    double
    ramp_factor(const double time) const
    {
      return ramp == LoadRamp::increments ? time : 1.;
    }

    /// Nodal forces of gravity without the ramp [N]; empty without gravity.
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
      std::vector<double>       shares; ///< share of each node; they sum to one
      Expression                force;
    };

    const LoadRamp         ramp;
    const MassMatrix       mass_matrix; ///< masses that gravity acts on
    dealii::Vector<double> gravity_force;
    dealii::Vector<double> nodal_force; ///< see set_nodal_forces(); without the ramp
    std::vector<Load>      loads;
  };
} // namespace Exemplar

#endif
