// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/inertia.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    void
    lump(dealii::SparseMatrix<double> &mass)
    {
      for (unsigned int row = 0; row < mass.m(); ++row)
      {
        double sum = 0.;
        for (auto entry = mass.begin(row); entry != mass.end(row); ++entry)
        {
          sum += entry->value();
          entry->value() = 0.;
        }
        mass.set(row, row, sum);
      }
    }
  } // namespace

  Inertia::Inertia(const FESpace        &fe_space,
                   const Material       &material,
                   const MassMatrix      kind,
                   const TimeParameters &time)
      : pattern(fe_space.nodal_pattern()), mass(pattern), scheme(time.scheme),
        mass_damping(time.mass_damping), stiffness_damping(time.stiffness_damping)
  {
    std::vector<double> density(fe_space.n_cells());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      density[cell] = material.density(cell);
    fe_space.compute_mass_matrix(density, mass);
    greatest_mass = mass.linfty_norm(); // the greatest sum of a row
    if (kind == MassMatrix::lumped)
      lump(mass);
    copy_rows();
  }

  void
  Inertia::copy_rows()
  {
    row_start.push_back(0);
    for (unsigned int row = 0; row < mass.m(); ++row)
    {
      for (auto entry = mass.begin(row); entry != mass.end(row); ++entry)
        if (entry->value() != 0.)
        {
          columns.push_back(entry->column());
          values.push_back(entry->value());
        }
      row_start.push_back(columns.size());
    }
  }

  void
  Inertia::begin_step(const State &state, const double step_size)
  {
    this->step_size = step_size;
    if (scheme == TimeScheme::bdf2 && state.previous_step > 0.)
    {
      // BDF2 for steps whose ratio is r; the first step is one of implicit Euler
      const double r = step_size / state.previous_step;
      gamma          = (1. + 2. * r) / ((1. + r) * step_size);
      c_last         = (1. + r) * (1. + r) / (1. + 2. * r);
      c_previous     = -r * r / (1. + 2. * r);
    }
    else
    {
      gamma      = 1. / step_size;
      c_last     = 1.;
      c_previous = 0.;
    }
    base                              = state.positions;
    dealii::Vector<double> velocities = state.velocities; // v_star
    if (c_previous != 0.)
    {
      base.sadd(c_last, c_previous, state.previous_positions);
      velocities.sadd(c_last, c_previous, state.previous_velocities);
    }
    predicted = base;
    predicted.add(1. / (gamma + mass_damping), velocities);
  }

  std::vector<WeightedPositions>
  Inertia::history(const State &state) const
  {
    std::vector<WeightedPositions> terms = { { c_last, &state.positions } };
    if (c_previous != 0.)
      terms.push_back({ c_previous, &state.previous_positions });
    return terms;
  }

  dealii::Vector<double>
  Inertia::mass_times(const dealii::Vector<double> &field) const
  {
    dealii::Vector<double> product(field.size());
    for (unsigned int row = 0; row + 1 < row_start.size(); ++row)
    {
      double sum[3] = { 0., 0., 0. };
      for (std::size_t entry = row_start[row]; entry < row_start[row + 1]; ++entry)
      {
        const double *node = field.begin() + 3 * columns[entry];
        for (unsigned int c = 0; c < 3; ++c)
          sum[c] += values[entry] * node[c];
      }
      for (unsigned int c = 0; c < 3; ++c)
        product[3 * row + c] = sum[c];
    }
    return product;
  }

  double
  Inertia::add_gradient(const dealii::Vector<double> &positions,
                        dealii::Vector<double>       &gradient,
                        dealii::Vector<double>       &force_scale) const
  {
    dealii::Vector<double> difference = positions;
    difference -= predicted;
    const dealii::Vector<double> product = mass_times(difference);
    const double                 factor  = matrix_factor();
    double                       energy  = 0.;
    for (unsigned int node = 0; node < force_scale.size(); ++node)
    {
      double square = 0.;
      for (unsigned int dof = 3 * node; dof < 3 * node + 3; ++dof)
      {
        const double force = factor * product[dof];
        gradient[dof] += force;
        square += force * force;
        energy += 0.5 * force * difference[dof];
      }
      force_scale[node] += std::sqrt(square);
    }
    return energy;
  }

  void
  Inertia::end_step(const State &old, State &state) const
  {
    state.velocities = state.positions;
    state.velocities -= base;
    state.velocities *= gamma;
    if (scheme == TimeScheme::bdf2)
    {
      state.previous_positions  = old.positions;
      state.previous_velocities = old.velocities;
      state.previous_step       = step_size;
    }
  }

  MotionSums
  Inertia::motion_sums(const State &state) const
  {
    const dealii::Vector<double> p = mass_times(state.velocities);
    const auto at = [](const dealii::Vector<double> &field, const unsigned int node) {
      return dealii::Tensor<1, 3>({ field[3 * node], field[3 * node + 1], field[3 * node + 2] });
    };
    MotionSums sums;
    sums.kinetic_energy = 0.5 * (state.velocities * p);
    for (unsigned int node = 0; node < p.size() / 3; ++node)
    {
      sums.momentum += at(p, node);
      sums.angular_momentum += dealii::cross_product_3d(at(state.positions, node), at(p, node));
    }
    return sums;
  }

  std::size_t
  Inertia::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return pattern.memory_consumption() + mass.memory_consumption() + memory_consumption(row_start)
           + memory_consumption(columns) + memory_consumption(values) + base.memory_consumption()
           + predicted.memory_consumption();
  }
} // namespace Exemplar
