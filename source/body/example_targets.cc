// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_targets.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace Exemplar
{
  ExampleTargets::ExampleTargets(std::vector<std::string>   names_of_examples,
                                 const unsigned int         first_strained,
                                 const RegionShares        &shares,
                                 const std::vector<double> &measures,
                                 const Exchange            &exchange,
                                 const unsigned int         first_number)
      : WeightNumbers(names_of_examples.size(), first_strained, shares.n_regions()),
        exchange(exchange), first_number(first_number), names(std::move(names_of_examples)),
        total(exchange.sum(std::accumulate(measures.begin(), measures.end(), 0.))),
        fraction_of_region(n_regions(), 0.)
  {
    for (unsigned int region = 0; region < n_regions(); ++region)
      ids.push_back(shares.id(region));
    for (unsigned int point = 0; point < measures.size(); ++point)
      shares.for_each(point, [&](const unsigned int region, const double share)
                      { fraction_of_region[region] += share * measures[point] / total; });
    exchange.sum(fraction_of_region);
    if (n_regions() == 1)
      fraction_of_region = { 1. }; // exactly, without rounding of the sum
  }

  std::vector<double>
  ExampleTargets::measures_of_weights() const
  {
    std::vector<double> result;
    for (const double fraction : fraction_of_region)
      result.insert(result.end(), size(), total * fraction);
    return result;
  }

  void
  ExampleTargets::measure(const TargetBlock &block)
  {
    norm_of_weight = block.squares();
    exchange.sum(norm_of_weight);
    for (double &norm : norm_of_weight)
      norm = std::sqrt(norm);
  }

  void
  ExampleTargets::compute(const std::vector<TargetEnergy> &blocks)
  {
    gram_matrix.reinit(n_weights(), n_weights());
    blended.reinit(0, 0);
    for (const TargetEnergy &of : blocks)
    {
      of.block.add_gram(of.form, gram_matrix);
      if (!of.excess.dual)
        continue;
      if (blended.empty())
        blended.reinit(n_weights(), n_weights());
      of.block.add_gram(of.excess, blended);
    }
    for (auto *const matrix : { &gram_matrix, &blended })
      if (!matrix->empty())
        exchange.sum(&(*matrix)(0, 0), matrix->n_elements());
  }

  void
  ExampleTargets::add_blended(const double factor, dealii::FullMatrix<double> &sum) const
  {
    if (!blended.empty())
      sum.add(factor, blended);
    else
      sum.add(factor * (1. - eta) / eta, gram_matrix);
  }

  std::size_t
  ExampleTargets::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(norm_of_weight)
           + gram_matrix.memory_consumption() + blended.memory_consumption();
  }
} // namespace Exemplar
