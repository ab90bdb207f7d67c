// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_poses_h
#define exemplar_example_poses_h

#include <exemplar/body/example_gram.h>
#include <exemplar/body/example_parameters.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/material.h>
#include <exemplar/body/patches.h>
#include <exemplar/body/region_shares.h>
#include <exemplar/kernels/symmetric.h>

#include <deal.II/base/aligned_vector.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// sum E V over the cells [J]: the scale of the energy of a strain of 1.
  double
  unit_energy(const FESpace &fe_space, const Material &material);

  /// The same with the moduli of the wish to be like the examples: the scale of the weights' form.
  double
  unit_energy_of_examples(const FESpace &fe_space, const Material &material);

  /// Which strains of the poses are taken.
  struct StrainRule
  {
    ActsOn acts_on;
    bool   is_single; ///< rounded to single precision
  };

  /// A pose that the body likes.
  struct ExamplePose
  {
    std::string            name;      ///< the file or the formula that gives it, for messages
    dealii::Vector<double> positions; ///< of the nodes, by degree of freedom [m]
  };

  /// The example poses and the strains that they ask for, eta E_i at every quadrature point, Eqs. (4)
  /// and (5), computed once; eta is Examples/Importance. E_i is the part that examples act on, Eq. (31).
  /// Where examples have an elasticity of their own, D_i of Eq. (38) stands for eta E_i.
  /// Example 0 is the rest pose where it is included. Each example has one weight or,
  /// with Weights per region, one a region: weight r * size() + i is that of example i in
  /// region r. Of a scene without examples it is empty.
  class ExamplePoses
  {
  public:
    /// Those of Examples/Poses are among `named_poses`, the values of Examples/Weight maps in each cell
    /// are `painted`; `cell_material` is that of the cells' own energy, beside which that of `patches`
    /// stands, null where there are none. Throws UserError for a pose that is not.
    ExamplePoses(const ExampleParameters                &parameters,
                 const LawsOfCells                      &laws,
                 const Mesh                             &mesh,
                 const FESpace                          &fe_space,
                 const Material                         &cell_material,
                 const Patches                          &patches,
                 const NamedPoses                       &named_poses = {},
                 const std::vector<std::vector<double>> &painted     = {});

    /// Number of examples.
    unsigned int
    size() const
    {
      return poses.size();
    }

    /// Those with weights of their own; each region's weights sum to one.
    const RegionShares &
    get_regions() const
    {
      return regions;
    }

    unsigned int
    n_weights() const
    {
      return regions.n_regions() * size();
    }

    /// From now on this importance, greater than 0, in a body of this material; see the constructor.
    void
    set_parameters(double importance, const Material &cell_material, const Patches &patches);

    /// From now on in a body of this material.
    void
    set_material(const Material &cell_material, const Patches &patches);

    /// From now on example i is at these places of the nodes [m], of the vertices alone or of all. What
    /// depends on it is made anew by set_parameters(). Throws UserError for curved edges.
    void
    set_pose(unsigned int i, const std::vector<dealii::Point<3>> &places);

    /// Volume of each region over that of the body, with shares counted; they sum to one.
    std::vector<double>
    volume_fractions() const;

    /// What each weight acts on [m^3].
    std::vector<double>
    volumes_of_weights() const;

    /// Of example i.
    const std::string &
    name(const unsigned int i) const
    {
      return poses[i].name;
    }

    /// Node positions of example i, by degree of freedom [m].
    const dealii::Vector<double> &
    pose(const unsigned int i) const
    {
      return poses[i].positions;
    }

    /// eta E_i at a quadrature point.
    Matrix3<double>
    strain(const unsigned int point, const unsigned int i) const
    {
      if (i < first_strained)
        return Matrix3<double>{};
      return load_stored(strains.data(), point, n_strained(), i - first_strained);
    }

    /// What the kernels see of the examples.
    ExampleArrays
    arrays() const
    {
      return { n_strained(),   first_strained,
               size(),         n_weights(),
               strains.data(), regions.starts(),
               regions.list(), in_single.empty() ? nullptr : in_single.data() };
    }

    /// Call function(weight, example, share) for the weights that matter at a point. The
    /// rest pose, where it is included, has no strain and is left out.
    template <typename Function>
    void
    for_each_weight(const unsigned int point, const Function &function) const
    {
      regions.for_each(point,
                       [&](const unsigned int region, const double share)
                       {
                         for (unsigned int i = first_strained; i < size(); ++i)
                           function(region * size() + i, i, share);
                       });
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
      return regions.n_regions() * n_strained();
    }

    /// The number of a strained weight among these.
    unsigned int
    strained_index(const unsigned int weight) const
    {
      return weight / size() * n_strained() + weight % size() - first_strained;
    }

    /// eta E(w) = eta sum_i w_i E_i at a point.
    Matrix3<double>
    strain(const unsigned int point, const std::vector<double> &weights) const
    {
      Matrix3<double> sum{};
      for_each_weight(point,
                      [&](const unsigned int weight, const unsigned int i, const double share)
                      { sum = combine(1., sum, share * weights[weight], strain(point, i)); });
      return sum;
    }

    /// (sum V |eta dE/dw|^2)^(1/2) over the cells [m^(3/2)] for a weight.
    double
    strain_norm(const unsigned int weight) const
    {
      return strain_norms[weight];
    }

    /// The importance, and a bound of the guard (16) such that it leaves every example as it is.
    const ExampleConstants &
    constants() const
    {
      return example_constants;
    }

    /// What pairs of them cost in energy, and what they ask of patches.
    const ExampleGram &
    get_gram() const
    {
      return gram;
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
    compute_strains(const Material &material);

    const FESpace                 &fe_space;
    const LawsOfCells              laws;
    ExampleConstants               example_constants;
    const RegionShares             regions;
    std::vector<ExamplePose>       poses;
    const unsigned int             first_strained;
    const StrainRule               rule;
    dealii::AlignedVector<double>  strains;   ///< eta E_i, as ExampleArrays has them
    dealii::AlignedVector<float>   in_single; ///< then, once more
    std::vector<double>            strain_norms;
    ExampleGram                    gram;
    const std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
