// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/inertia_term.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>
#include <limits>

namespace Exemplar
{
  InertiaTerm::InertiaTerm(const Mass           &mass,
                           const TimeIntegrator &integrator,
                           const bool            is_reported)
      : mass(mass), integrator(integrator), is_reported(is_reported)
  {
  }

  void
  InertiaTerm::begin_step(const State & /*start*/, double /*step_size*/)
  {
    in_step        = true;
    predicted_size = max_entry(integrator.predicted_positions().begin(),
                               integrator.predicted_positions().end());
  }

  void
  InertiaTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    if (!in_step)
      return;
    const Vector     &predicted = integrator.predicted_positions();
    const std::size_t n         = sums->force_scale.size();
    const double      factor    = integrator.mass_factor();
    double            energy    = 0.;
    difference.resize(4 * n);
    product.resize(4 * n);
    for (std::size_t node = 0; node < n; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        difference[4 * node + c] = at.positions[3 * node + c] - predicted[3 * node + c];
    mass.multiply(difference, product);
    for (std::size_t node = 0; node < n; ++node)
    {
      double square = 0.;
      for (unsigned int c = 0; c < 3; ++c)
      {
        const double force = factor * product[4 * node + c];
        sums->gradient[3 * node + c] += force;
        square += force * force;
        energy += 0.5 * force * difference[4 * node + c];
      }
      sums->force_scale[node] += std::sqrt(square);
    }
    sums->energy += energy;
  }

  void
  InertiaTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
    follow_parameters();
  }

  void
  InertiaTerm::follow_parameters()
  {
    mass_values.assign(pattern->n_values(), 0.);
    const dealii::SparseMatrix<double> &nodal = mass.nodal();
    for (const unsigned int dof : free_dofs->local_list())
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
      {
        const unsigned int other = 3 * entry->column() + dof % 3;
        if (other >= dof && free_dofs->free_index(other) != FreeDofs::held)
          mass_values[pattern->position(free_dofs->free_index(other), free_dofs->free_index(dof))]
              = entry->value();
      }
  }

  void
  InertiaTerm::add_tangent(const TermPoint & /*at*/,
                           Tangent /*kind*/,
                           std::vector<double> &values,
                           std::vector<double> & /*columns*/)
  {
    const double factor = integrator.mass_factor();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] += factor * mass_values[i];
  }

  double
  InertiaTerm::rounding_force() const
  {
    return in_step ? 4. * std::numeric_limits<double>::epsilon() * predicted_size
                         * mass.max_nodal_mass() * integrator.mass_factor()
                   : 0.;
  }

  std::size_t
  InertiaTerm::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(mass_values)
           + difference.memory_consumption() + product.memory_consumption();
  }
} // namespace Exemplar
