// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_target_block_h
#define exemplar_target_block_h

#include <exemplar/body/region_shares.h>
#include <exemplar/kernels/lanes.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <vector>

namespace Exemplar
{
  /// Lists of n numbers, as the strain at a point is one.
  struct TargetSpace
  {
    unsigned int n;

    /// a.b is the sum of a_k b_k over these k: a number that stands for two equal ones occurs twice.
    std::vector<unsigned int> order;

    double
    product(const double *a, const double *b) const;
  };

  /// The numbers of weights: weight r size() + i is that of example i in region r.
  class WeightNumbers
  {
  public:
    /// No examples.
    WeightNumbers() = default;

    /// Examples before the first strained one ask for zeros.
    WeightNumbers(const unsigned int n_examples,
                  const unsigned int first_strained = 0,
                  const unsigned int n_regions      = 1)
        : n_examples(n_examples), first(first_strained), regions(n_regions)
    {
    }

    /// Number of examples.
    unsigned int
    size() const
    {
      return n_examples;
    }

    unsigned int
    n_regions() const
    {
      return regions;
    }

    unsigned int
    n_weights() const
    {
      return regions * n_examples;
    }

    unsigned int
    first_strained() const
    {
      return first;
    }

    unsigned int
    n_strained() const
    {
      return n_examples - first;
    }

    /// Whether a weight changes what is asked for anywhere; not so for the rest pose.
    bool
    is_strained(const unsigned int weight) const
    {
      return weight % n_examples >= first;
    }

    unsigned int
    n_strained_weights() const
    {
      return regions * n_strained();
    }

    /// The index of a weight among the strained ones.
    unsigned int
    strained_index(const unsigned int weight) const
    {
      return weight / n_examples * n_strained() + weight % n_examples - first;
    }

  private:
    unsigned int n_examples = 0, first = 0, regions = 1;
  };

  /// A quadratic form a:C:b of the numbers at a point, given by who knows what they are.
  struct TargetForm
  {
    /// Writes T with T.b = a:C:b for the numbers a at a point [J a unit of its measure].
    std::function<void(unsigned int point, const double *a, double *T)> dual;

    /// A factor of the form at a point.
    std::function<double(unsigned int point)> factor = [](unsigned int) { return 1.; };
  };

  /// What examples ask for at the points of one kind: a list of numbers of each example, and the
  /// shares by which weights act there. Neither shape nor dimension of the points is known here.
  class TargetBlock
  {
  public:
    /// Zeros at points with these measures at rest, as volumes are.
    TargetBlock(TargetSpace          space,
                const WeightNumbers &weights,
                std::vector<double>  measures,
                RegionShares         shares = {});

    unsigned int
    n_points() const
    {
      return measures.size();
    }

    double
    measure(const unsigned int point) const
    {
      return measures[point];
    }

    const RegionShares &
    get_shares() const
    {
      return shares;
    }

    /// Ask for zeros.
    void
    clear();

    /// The numbers of the strained examples, number k of the i-th of them at batch_index(point, n * n_strained(),
    /// n * i + k) as ExampleArrays has them.
    double *
    data()
    {
      return numbers.data();
    }

    const double *
    data() const
    {
      return numbers.data();
    }

    /// Number k of a strained example.
    double
    number(const unsigned int point, const unsigned int example, const unsigned int k) const
    {
      return numbers[position(point, example, k)];
    }

    double &
    number(const unsigned int point, const unsigned int example, const unsigned int k)
    {
      return numbers[position(point, example, k)];
    }

    /// Round the numbers to single precision, in which loops then read them.
    void
    round_to_single();

    ExampleArrays
    arrays() const;

    /// Call function(weight, example, share) for the weights that act at a point. The rest pose,
    /// where it is included, asks for zeros and is left out.
    template <typename Function>
    void
    for_each_weight(const unsigned int point, const Function &function) const
    {
      shares.for_each(point,
                      [&](const unsigned int region, const double share)
                      {
                        for (unsigned int i = weights.first_strained(); i < weights.size(); ++i)
                          function(region * weights.size() + i, i, share);
                      });
    }

    /// Add the numbers that examples with these weights ask for at a point.
    void
    add_blend(unsigned int point, const std::vector<double> &w, double *sum) const
    {
      for_each_weight(point,
                      [&](const unsigned int weight, const unsigned int i, const double share)
                      {
                        for (unsigned int k = 0; k < space.n; ++k)
                          sum[k] += share * w[weight] * number(point, i, k);
                      });
    }

    /// sum of measure times |dt/dw|^2 for each weight.
    std::vector<double>
    squares() const;

    /// Add the sum over the points of the form, for all pairs of weights.
    void
    add_gram(const TargetForm &form, dealii::FullMatrix<double> &sum) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    std::size_t
    position(const unsigned int point, const unsigned int example, const unsigned int k) const
    {
      return batch_index(point, space.n * weights.n_strained(),
                         space.n * (example - weights.first_strained()) + k);
    }

    /// The numbers of the strained examples at a point, one list after the other.
    void
    load(unsigned int point, std::vector<double> &lists) const;

    TargetSpace                   space;
    WeightNumbers                 weights;
    std::vector<double>           measures;
    RegionShares                  shares;
    dealii::AlignedVector<double> numbers;
    dealii::AlignedVector<float>  in_single; ///< the same in single precision; else empty
  };
} // namespace Exemplar

#endif
