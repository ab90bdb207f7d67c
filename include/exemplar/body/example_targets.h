// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_targets_h
#define exemplar_example_targets_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/body/target_block.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A block with the energies of its numbers.
  struct TargetEnergy
  {
    const TargetBlock &block;
    TargetForm         form;   ///< the energy of what examples ask for, Eq. (9)
    TargetForm         excess; ///< the further part of H in the blended energy; without a dual: see
                               ///< ExampleTargets::add_blended()
  };

  /// The examples as their weights know them: names, regions, and sums over blocks of points at which
  /// they ask for lists of numbers. Empty in a scene without examples.
  class ExampleTargets : public WeightNumbers
  {
  public:
    /// The examples with these names, of which those before `first_strained` ask for zeros, in the
    /// regions that share out these measures. Users know the first one as `first_number`. All
    /// processes must call this and what computes sums.
    ExampleTargets(std::vector<std::string>   names,
                   unsigned int               first_strained,
                   const RegionShares        &shares,
                   const std::vector<double> &measures,
                   const Exchange            &exchange,
                   unsigned int               first_number = 0);

    /// Name of example i.
    const std::string &
    name(const unsigned int i) const
    {
      return names[i];
    }

    /// Number by which users know example i.
    unsigned int
    number(const unsigned int i) const
    {
      return first_number + i;
    }

    /// RegionShares::id().
    std::optional<unsigned int>
    region_id(const unsigned int region) const
    {
      return ids[region];
    }

    /// The fraction of the body's measure in each region, weighted by shares; they sum to one.
    const std::vector<double> &
    fractions() const
    {
      return fraction_of_region;
    }

    /// The measure at rest of the region that each weight acts on.
    std::vector<double>
    measures_of_weights() const;

    /// Examples/Importance eta, by which the numbers are scaled.
    double
    importance() const
    {
      return eta;
    }

    void
    set_importance(const double importance)
    {
      eta = importance;
    }

    /// Find the norms anew.
    void
    measure(const TargetBlock &block);

    /// (sum of measures times |dt/dw|^2)^(1/2) of each weight, over the block of measure().
    const std::vector<double> &
    norms() const
    {
      return norm_of_weight;
    }

    /// Find the forms of the weights anew, as sums over these blocks.
    void
    compute(const std::vector<TargetEnergy> &blocks);

    /// The Gram matrix of the weights in energy, Eq. (9) [J].
    const dealii::FullMatrix<double> &
    gram() const
    {
      return gram_matrix;
    }

    /// Add `factor` times the further part of H in the blended energy [J]: the excess of the blocks,
    /// or (1 - eta)/eta times the Gram matrix if they have none.
    void
    add_blended(double factor, dealii::FullMatrix<double> &sum) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    const Exchange                          &exchange;
    unsigned int                             first_number;
    std::vector<std::string>                 names;
    std::vector<std::optional<unsigned int>> ids;
    double                                   total; ///< measure of the whole body
    std::vector<double>                      fraction_of_region;
    double                                   eta = 0.;
    std::vector<double>                      norm_of_weight;
    dealii::FullMatrix<double>               gram_matrix;
    dealii::FullMatrix<double>               blended; ///< the excess; empty without
  };
} // namespace Exemplar

#endif
