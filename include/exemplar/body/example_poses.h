// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_poses_h
#define exemplar_example_poses_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/body/region_shares.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/prm/expression.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/lac/full_matrix.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// sum E V over the cells [J]: the scale of the energy of a strain of 1.
  double
  unit_energy(const FESpace &fe_space, const Material &material);

  /// The example poses and their strains E_i in every cell, Eq. (4), computed once.
  /// Example 0 is the rest pose where it is included. Each example has one weight or,
  /// with Weights per region, one a region: weight r * size() + i is that of example i in
  /// region r.
  class ExamplePoses
  {
  public:
    /// Those of Examples/Poses are among `poses`. Throws UserError for one that is not, for
    /// prescribed weights that do not sum to one in every step, and for free
    /// weights without penalty if the examples are affinely dependent.
    ExamplePoses(const ExampleParameters &parameters,
                 StrainMeasure            measure,
                 const Mesh              &mesh,
                 const FESpace           &fe_space,
                 const Material          &material,
                 const TimeAxis          &axis,
                 const NamedPoses        &poses = {});

    /// Number of examples.
    unsigned int
    size() const
    {
      return positions.size();
    }

    /// Number of regions with weights of their own; each region's weights sum to one.
    unsigned int
    n_regions() const
    {
      return regions ? regions->n_regions() : 1;
    }

    unsigned int
    n_weights() const
    {
      return n_regions() * size();
    }

    /// Column of statistics.csv: `prefix`_i, or `prefix`_R_i with the material id R.
    std::string
    weight_name(const std::string &prefix, unsigned int weight) const;

    /// `prefix`, or `prefix`_R.
    std::string
    region_name(const std::string &prefix, unsigned int region) const;

    double
    importance() const
    {
      return eta;
    }

    bool
    weights_are_prescribed() const
    {
      return !prescribed.empty();
    }

    /// Prescribed weights at time t.
    std::vector<double>
    prescribed_weights(double time) const;

    /// Node positions of example i, by degree of freedom [m].
    const dealii::Vector<double> &
    pose(const unsigned int i) const
    {
      return positions[i];
    }

    /// E_i in a cell.
    Matrix3<double>
    strain(const unsigned int cell, const unsigned int i) const
    {
      if (i < first_strained)
        return Matrix3<double>{};
      double E[6];
      for (unsigned int k = 0; k < 6; ++k)
        E[k] = strains[batch_index(cell, 6 * n_strained(), 6 * (i - first_strained) + k)];
      return { { { E[0], E[5], E[4] }, { E[5], E[1], E[3] }, { E[4], E[3], E[2] } } };
    }

    /// What the kernels see of the examples.
    ExampleArrays
    arrays() const
    {
      return { n_strained(),
               first_strained,
               size(),
               n_weights(),
               eta,
               strains.data(),
               regions ? regions->starts().data() : nullptr,
               regions ? regions->list().data() : nullptr };
    }

    /// Call function(weight, example, share) for the weights that matter in a cell. The
    /// rest pose, where it is included, has no strain and is left out.
    template <typename Function>
    void
    for_each_weight(const unsigned int cell, const Function &function) const
    {
      if (!regions)
        for (unsigned int i = first_strained; i < size(); ++i)
          function(i, i, 1.);
      else
        for (std::size_t s = regions->first(cell); s < regions->last(cell); ++s)
          for (unsigned int i = first_strained; i < size(); ++i)
            function(regions->list()[s].region * size() + i, i, regions->list()[s].value);
    }

    /// Whether a weight changes the strain anywhere: that of the rest pose does not.
    bool
    is_strained(const unsigned int weight) const
    {
      return weight % size() >= first_strained;
    }

    unsigned int
    n_strained_weights() const
    {
      return n_regions() * n_strained();
    }

    /// The number of a strained weight among these.
    unsigned int
    strained_index(const unsigned int weight) const
    {
      return weight / size() * n_strained() + weight % size() - first_strained;
    }

    /// E(w) = sum_i w_i E_i in a cell.
    Matrix3<double>
    strain(const unsigned int cell, const std::vector<double> &weights) const
    {
      Matrix3<double> sum{};
      for_each_weight(cell, [&](const unsigned int weight, const unsigned int i, const double share)
                      { sum = combine(1., sum, share * weights[weight], strain(cell, i)); });
      return sum;
    }

    /// (sum V |dE/dw|^2)^(1/2) over the cells [m^(3/2)] for a weight.
    double
    strain_norm(const unsigned int weight) const
    {
      return strain_norms[weight];
    }

    /// Whether weights to find must also not be negative.
    bool
    weights_are_bounded() const
    {
      return bounded;
    }

    /// The second derivative by the weights of what depends on them alone: the ridge
    /// and, with the blended energy, eta (1 - eta) sum V E_i : C : E_j [J].
    const dealii::FullMatrix<double> &
    penalty_matrix() const
    {
      return penalty;
    }

    /// p_0 of Eq. (16): such that the guard leaves every example as it is.
    double
    guard_bound() const
    {
      return p_0;
    }

    /// H_ij = eta^2 sum V E_i : C : E_j and the penalty matrix, Eq. (9) [J].
    const dealii::FullMatrix<double> &
    weight_matrix() const
    {
      return H;
    }

    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    unsigned int
    n_strained() const
    {
      return size() - first_strained;
    }

    void
    add_pose(const std::string &name, const std::vector<dealii::Point<3>> &nodes);

    void
    add_pose_functions(const std::string &functions, const Mesh &mesh);

    void
    compute_strains();

    void
    compute_gram_matrix(const Material &material);

    void
    compute_weight_matrix(const Material &material, const ExampleParameters &parameters);

    void
    read_prescribed_weights(const std::string &text);

    void
    check_prescribed_weights(const TimeAxis &axis) const;

    void
    check_independence(const Material &material);

    const FESpace                      &fe_space;
    const double                        eta;
    const StrainMeasure                 measure;
    const std::optional<RegionShares>   regions; ///< none: weights are global
    std::vector<std::string>            names;
    std::vector<dealii::Vector<double>> positions;
    const unsigned int                  first_strained;
    dealii::AlignedVector<double>       strains; ///< as ExampleArrays has them
    std::vector<double>                 strain_norms;
    dealii::FullMatrix<double>          gram; ///< sum V E_i : C : E_j
    dealii::FullMatrix<double>          penalty;
    dealii::FullMatrix<double>          H;
    const bool                          bounded;
    double                              p_0 = default_guard_bound;
    std::vector<Expression>             prescribed; ///< one, or one a region
    std::vector<std::string>            warnings;
  };
} // namespace Exemplar

#endif
