// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/padded_nodes.h>
#include <exemplar/potential/cell_field.h>

namespace Exemplar
{
  void
  StretchField::reinit(const unsigned int n_points)
  {
    for (dealii::AlignedVector<double> *values :
         { &transitions, &by_F, &stiffnesses, &energies, &pressures })
    {
      values->resize_fast(batched_size(n_points, 1));
      values->fill(0.);
    }
    elasticity.resize_fast(batched_size(n_points, 2));
    elasticity.fill(0.);
  }

  StretchArrays
  StretchField::arrays()
  {
    if (!acts)
      return {};
    return { transitions.data(), by_F.data(), stiffnesses.data(), elasticity.data(),
             energies.data() };
  }

  std::size_t
  StretchField::memory_consumption() const
  {
    return transitions.memory_consumption() + by_F.memory_consumption()
           + stiffnesses.memory_consumption() + elasticity.memory_consumption()
           + energies.memory_consumption() + pressures.memory_consumption();
  }

  void
  VolumeField::resize(const unsigned int n_points)
  {
    changes.resize(batched_size(n_points, 1));
    cofactors.resize(batched_size(n_points, 9));
    pressures.resize(batched_size(n_points, 1));
  }

  VolumeArrays
  VolumeField::arrays()
  {
    if (changes.empty())
      return {};
    return { changes.data(), cofactors.data(), pressures.data() };
  }

  std::size_t
  VolumeField::memory_consumption() const
  {
    return changes.memory_consumption() + cofactors.memory_consumption()
           + pressures.memory_consumption();
  }

  void
  DilatationField::resize(const unsigned int n_points)
  {
    for (dealii::AlignedVector<double> *values : { &traces, &squares, &pressures, &scales })
      values->resize(batched_size(n_points, 1));
    flags.resize(batched_size(n_points, 1) / batch_size);
  }

  DilatationArrays
  DilatationField::arrays()
  {
    if (traces.empty())
      return {};
    return { traces.data(), squares.data(),   flags.data(),   pressures.data(),
             scales.data(), stretch.arrays(), volume.arrays() };
  }

  std::size_t
  DilatationField::memory_consumption() const
  {
    return traces.memory_consumption() + squares.memory_consumption()
           + pressures.memory_consumption() + scales.memory_consumption() + flags.capacity()
           + stretch.memory_consumption() + volume.memory_consumption();
  }

  CellField::CellField(LawsOfCells             laws,
                       const ExampleConstants &examples,
                       const FESpace          &fe_space,
                       const Material         &material,
                       const unsigned int      n_threads)
      : fe_space(fe_space), kernels(best_kernels(fe_space.element())),
        batches(fe_space, material, std::move(laws), examples),
        nodal_sums(
            batches.arrays(), nodes_per_cell(fe_space.element()), fe_space.n_nodes(), n_threads),
        node_positions(4 * fe_space.n_nodes())
  {
  }

  CellTask
  CellField::task(const Vector &positions, RotationUse rotations)
  {
    // what acts on the dilatation takes a loop of its own, which needs the rotations
    if (!dilatation.traces.empty() && rotations == RotationUse::find_and_forget)
      rotations = RotationUse::update;
    if (rotations == RotationUse::keep)
      refresh_rotations();
    rotations_are_forgotten = rotations == RotationUse::find_and_forget;
    pad_nodes(positions, node_positions);
    CellTask task;
    task.cells        = batches.arrays();
    task.positions    = node_positions.data();
    task.places       = nodal_sums.get_places();
    task.rotation_use = rotations;
    task.damping      = damping.arrays();
    task.dilatation   = dilatation.arrays();
    return task;
  }

  CellTask
  CellField::task_elsewhere(const double *positions)
  {
    CellTask task;
    task.cells        = batches.arrays();
    task.positions    = positions;
    task.rotation_use = RotationUse::find_and_forget;
    return task;
  }

  LawInput<double>
  CellField::law_input(const unsigned int point, const Matrix3<double> &F) const
  {
    LawInput<double> in = batches.law_input(point, rotation(point), F);
    in.has_target       = true;
    in.damping          = damping.factor(point);
    in.is_damped        = in.damping > 0.;
    if (in.is_damped)
      in.past = damping.past_strain(point);
    in.has_pressure    = true; // 0 without patches
    in.pressure        = dilatation.pressure(point);
    in.volume_pressure = dilatation.volume.pressure(point);
    return in;
  }

  void
  CellField::for_each_law_in_stripes(
      const CellTask &task, void (*CellKernels::*loop)(const CellTask &, std::size_t, std::size_t))
  {
    nodal_sums.for_each_stripe(
        [&](std::size_t /*stripe*/, const std::size_t begin, const std::size_t end, double *) {
          for_each_law(task, [&](const CellTask &of_law) { (kernels.*loop)(of_law, begin, end); });
        });
  }

  void
  CellField::update_dilatations(const Vector &positions, const RotationUse rotations)
  {
    dilatation.clear_flags();
    for_each_law_in_stripes(task(positions, rotations), &CellKernels::dilatations);
  }

  void
  CellField::update_stretch_energies(const Vector &positions)
  {
    for_each_law_in_stripes(task(positions, RotationUse::keep), &CellKernels::stretch_energies);
  }

  void
  CellField::update_rotations(const Vector &positions)
  {
    for_each_law_in_stripes(task(positions, RotationUse::update), &CellKernels::update_rotations);
  }

  void
  CellField::refresh_rotations()
  {
    if (!rotations_are_forgotten)
      return;
    CellTask last;
    last.cells     = batches.arrays();
    last.positions = node_positions.data();
    for_each_law_in_stripes(last, &CellKernels::update_rotations);
    rotations_are_forgotten = false;
  }

  void
  CellField::node_rotations(std::vector<float> &rotations)
  {
    refresh_rotations();
    CellTask task;
    task.cells  = batches.arrays();
    task.places = nodal_sums.get_places();
    rotation_sums.resize_fast(12 * nodal_sums.n_places());
    rotation_sums.fill(0.);
    rotations.resize(9 * n_nodes());
    nodal_sums.for_each_stripe(
        [&](std::size_t /*stripe*/, const std::size_t begin, const std::size_t end, double *)
        { kernels.add_rotations(task, begin, end, rotation_sums.data()); });
    nodal_sums.join(rotation_sums.data(), 12);
    fe_space.exchange().assemble(rotation_sums.data(), 12);
    // whole groups of nodes, so that no number depends on the parts
    for_each_part(n_threads(), (n_nodes() + batch_size - 1) / batch_size, n_threads(),
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    const std::size_t first = batch_size * begin;
                    const std::size_t last  = std::min<std::size_t>(batch_size * end, n_nodes());
                    kernels.closest_rotations(last - first, &rotation_sums[12 * first],
                                              &rotations[9 * first]);
                  });
  }

  std::vector<double>
  CellField::advance_history(const Vector &positions)
  {
    if (batches.remembers())
      for_each_law(task(positions, RotationUse::keep), [&](const CellTask &of_law)
                   { kernels.advance_history(of_law, 0, of_law.cells.n_batches()); });
    batches.set_step_size(0.);
    return batches.history();
  }

  double
  CellField::dissipated_energy() const
  {
    double sum = 0.;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      sum += fe_space.volume(point)
             * batches.history_number(point, traits_of(batches.law(point)).dissipated);
    return sum;
  }

  std::size_t
  CellField::memory_consumption() const
  {
    return batches.memory_consumption() + node_positions.memory_consumption()
           + rotation_sums.memory_consumption() + damping.memory_consumption()
           + dilatation.memory_consumption() + nodal_sums.memory_consumption();
  }
} // namespace Exemplar
