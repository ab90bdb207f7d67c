// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/target_block.h>

#include <deal.II/base/memory_consumption.h>

#include <utility>

namespace Exemplar
{
  double
  TargetSpace::product(const double *a, const double *b) const
  {
    double sum = 0.;
    for (const unsigned int k : order)
      sum += a[k] * b[k];
    return sum;
  }

  TargetBlock::TargetBlock(TargetSpace          space,
                           const WeightNumbers &weights,
                           std::vector<double>  measures,
                           RegionShares         shares)
      : space(std::move(space)), weights(weights), measures(std::move(measures)),
        shares(std::move(shares))
  {
    clear();
  }

  void
  TargetBlock::clear()
  {
    numbers.clear();
    numbers.resize(batched_size(n_points(), space.n * weights.n_strained()), 0.);
  }

  void
  TargetBlock::round_to_single()
  {
    in_single.resize_fast(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = in_single[i] = static_cast<float>(numbers[i]);
  }

  ExampleArrays
  TargetBlock::arrays() const
  {
    return { weights.n_strained(), weights.first_strained(),
             weights.size(),       weights.n_weights(),
             numbers.data(),       shares.starts(),
             shares.list(),        in_single.empty() ? nullptr : in_single.data() };
  }

  void
  TargetBlock::load(const unsigned int point, std::vector<double> &lists) const
  {
    for (std::size_t k = 0; k < lists.size(); ++k)
      lists[k] = numbers[batch_index(point, lists.size(), k)];
  }

  std::vector<double>
  TargetBlock::squares() const
  {
    std::vector<double> sums(weights.n_weights(), 0.), lists(space.n * weights.n_strained());
    for (unsigned int point = 0; point < n_points(); ++point)
    {
      load(point, lists);
      for_each_weight(point,
                      [&](const unsigned int weight, const unsigned int i, const double share)
                      {
                        const double *a = &lists[space.n * (i - weights.first_strained())];
                        sums[weight] += measures[point] * share * share * space.product(a, a);
                      });
    }
    return sums;
  }

  void
  TargetBlock::add_gram(const TargetForm &form, dealii::FullMatrix<double> &sum) const
  {
    std::vector<double> lists(space.n * weights.n_strained()), T(space.n);
    const auto          list_of
        = [&](const unsigned int i) { return &lists[space.n * (i - weights.first_strained())]; };
    for (unsigned int point = 0; point < n_points(); ++point)
    {
      load(point, lists);
      const double factor = form.factor(point);
      for_each_weight(point,
                      [&](const unsigned int v, const unsigned int i, const double share_v)
                      {
                        form.dual(point, list_of(i), T.data());
                        for_each_weight(
                            point,
                            [&](const unsigned int w, const unsigned int j, const double share_w)
                            {
                              sum(v, w) += factor
                                           * (measures[point] * share_v * share_w
                                              * space.product(T.data(), list_of(j)));
                            });
                      });
    }
  }

  std::size_t
  TargetBlock::memory_consumption() const
  {
    return numbers.memory_consumption() + in_single.memory_consumption()
           + dealii::MemoryConsumption::memory_consumption(measures);
  }
} // namespace Exemplar
