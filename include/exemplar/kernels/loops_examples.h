// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_examples_h
#define exemplar_loops_examples_h

#include <exemplar/kernels/loops_io.h>

// The examples in the cells of a group: the target strain D of Eq. (16) and the sums for the
// derivatives by the weights.

namespace Exemplar::Loops
{
  /// The weight of example i in the cells of a group.
  template <typename Number>
  inline Number
  weight(const CellTask &task, const LaneGroup<Number> &group, const unsigned int i)
  {
    const ExampleArrays &examples = task.examples;
    if (examples.share_start == nullptr)
      return Number(task.weights[examples.first + i]);
    alignas(64) double sum[LaneGroup<Number>::width] = {};
    for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
      if (const std::size_t cell = group.cell(lane); cell < task.cells.n_cells)
        for (std::size_t s = examples.share_start[cell]; s < examples.share_start[cell + 1]; ++s)
          sum[lane]
              += examples.shares[s].value
                 * task.weights[examples.shares[s].region * examples.n_all + examples.first + i];
    return Lanes<Number>::load(sum);
  }

  template <typename Number, typename Stored>
  [[gnu::always_inline]] inline void
  add_targets(const CellTask           &task,
              const LaneGroup<Number>  &group,
              const Stored             *strains,
              SymmetricEntries<Number> &sum)
  {
    const ExampleArrays &examples = task.examples;
    for (unsigned int i = 0; i < examples.n; ++i)
    {
      if (examples.share_start == nullptr && task.weights[examples.first + i] == 0.)
        continue; // with many examples and bounded weights most weights are 0
      const Number w = weight(task, group, i);
      for (std::size_t k = 0; k < n_symmetric; ++k)
        sum[k] += w * load(strains, group, n_symmetric * examples.n, n_symmetric * i + k);
    }
  }

  /// The target strain eta E(w) in the cells of a group.
  template <typename Number>
  [[gnu::always_inline]] inline Matrix3<Number>
  target(const CellTask &task, const LaneGroup<Number> &group)
  {
    SymmetricEntries<Number> sum;
    for (Number &entry : sum.value)
      entry = Number(0.);
    if (task.examples.in_single != nullptr)
      add_targets(task, group, task.examples.in_single, sum);
    else
      add_targets(task, group, task.examples.strains, sum);
    return unpack(sum);
  }

  /// Add a cell's value to the sum of weight i of every region, times the region's share.
  template <typename Number>
  inline void
  share_out(const CellTask          &task,
            const LaneGroup<Number> &group,
            const unsigned int       i,
            const Number            &sum,
            double                  *weight_sums)
  {
    const ExampleArrays &examples = task.examples;
    alignas(64) double   of_cell[LaneGroup<Number>::width];
    Lanes<Number>::store(sum, of_cell);
    for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
      if (const std::size_t cell = group.cell(lane); cell < task.cells.n_cells)
        for (std::size_t s = examples.share_start[cell]; s < examples.share_start[cell + 1]; ++s)
          weight_sums[batch_size * (examples.shares[s].region * examples.n_all + examples.first + i)
                      + group.lane + lane]
              += examples.shares[s].value * of_cell[lane];
  }

  template <typename Number, typename Stored>
  [[gnu::always_inline]] inline void
  add_contractions(const CellTask          &task,
                   const LaneGroup<Number> &group,
                   const Number (&T)[n_symmetric],
                   const Stored *strains,
                   double       *weight_sums)
  {
    const ExampleArrays &examples = task.examples;
    for (unsigned int i = 0; i < examples.n; ++i)
    {
      Number sum = Number(0.);
      for (std::size_t k = 0; k < n_symmetric; ++k)
        sum += T[k] * load(strains, group, n_symmetric * examples.n, n_symmetric * i + k);
      if (examples.share_start == nullptr)
      {
        double *to = weight_sums + batch_size * (examples.first + i) + group.lane;
        Lanes<Number>::store(Lanes<Number>::load(to) + sum, to);
      }
      else
        share_out(task, group, i, sum, weight_sums);
    }
  }

  /// Add factor T : eta E_i to the sums of the weights, for every example i. Each pair of
  /// off-diagonal entries of T is summed first, because E_i is symmetric.
  template <typename Number>
  [[gnu::always_inline]] inline void
  add_weight_sums(const CellTask          &task,
                  const LaneGroup<Number> &group,
                  const Number            &factor, ///< V or -V
                  const Matrix3<Number>   &T,
                  double                  *weight_sums)
  {
    const Number once[n_symmetric] = { factor * T[0][0],
                                       factor * T[1][1],
                                       factor * T[2][2],
                                       factor * (T[1][2] + T[2][1]),
                                       factor * (T[0][2] + T[2][0]),
                                       factor * (T[0][1] + T[1][0]) };
    if (task.examples.in_single != nullptr)
      add_contractions(task, group, once, task.examples.in_single, weight_sums);
    else
      add_contractions(task, group, once, task.examples.strains, weight_sums);
  }
} // namespace Exemplar::Loops

#endif
