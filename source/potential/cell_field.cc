// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/cell_field.h>

namespace Exemplar
{
  void
  DilatationField::resize(const unsigned int n_points)
  {
    for (dealii::AlignedVector<double> *values : { &traces, &squares, &pressures, &scales })
      values->resize(batched_size(n_points, 1));
  }

  DilatationArrays
  DilatationField::arrays()
  {
    return { traces.data(), squares.data(), pressures.data(), scales.data() };
  }

  std::size_t
  DilatationField::memory_consumption() const
  {
    return traces.memory_consumption() + squares.memory_consumption()
           + pressures.memory_consumption() + scales.memory_consumption();
  }

  CellField::CellField(LawsOfCells             laws,
                       const ExampleConstants &examples,
                       const FESpace          &fe_space,
                       const Material         &material,
                       const unsigned int      n_threads)
      : fe_space(fe_space), kernels(best_kernels(fe_space.element())),
        batches(fe_space, material, std::move(laws), examples), nodal_sums(fe_space, n_threads),
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
    for (unsigned int node = 0; node < n_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        node_positions[4 * node + c] = positions[3 * node + c];
    CellTask task;
    task.cells        = batches.arrays();
    task.positions    = node_positions.data();
    task.rotation_use = rotations;
    task.damping      = damping.arrays();
    task.dilatation   = dilatation.arrays();
    return task;
  }

  void
  CellField::update_dilatations(const Vector &positions)
  {
    for_each_law(task(positions, RotationUse::keep), [&](const CellTask &of_law)
                 { kernels.dilatations(of_law, 0, of_law.cells.n_batches()); });
  }

  void
  CellField::update_rotations(const Vector &positions)
  {
    for_each_law(task(positions, RotationUse::update), [&](const CellTask &of_law)
                 { kernels.update_rotations(of_law, 0, of_law.cells.n_batches()); });
  }

  void
  CellField::refresh_rotations()
  {
    if (!rotations_are_forgotten)
      return;
    CellTask last;
    last.cells     = batches.arrays();
    last.positions = node_positions.data();
    for_each_law(last, [&](const CellTask &of_law)
                 { kernels.update_rotations(of_law, 0, of_law.cells.n_batches()); });
    rotations_are_forgotten = false;
  }

  void
  CellField::node_rotations(std::vector<float> &rotations)
  {
    refresh_rotations();
    CellTask task;
    task.cells = batches.arrays();
    rotation_sums.resize(12 * n_nodes());
    rotation_sums.fill(0.);
    rotations.resize(9 * n_nodes());
    kernels.add_rotations(task, 0, task.cells.n_batches(), rotation_sums.data());
    fe_space.exchange().assemble(rotation_sums.data(), 12);
    kernels.closest_rotations(n_nodes(), rotation_sums.data(), rotations.data());
  }

  std::vector<double>
  CellField::advance_history(const Vector &positions)
  {
    if (batches.remembers())
      for_each_law(task(positions, RotationUse::keep), [&](const CellTask &of_law)
                   { kernels.advance_history(of_law, 0, of_law.cells.n_batches()); });
    return batches.history();
  }

  std::size_t
  CellField::memory_consumption() const
  {
    return batches.memory_consumption() + node_positions.memory_consumption()
           + rotation_sums.memory_consumption() + damping.memory_consumption()
           + dilatation.memory_consumption() + nodal_sums.memory_consumption();
  }
} // namespace Exemplar
