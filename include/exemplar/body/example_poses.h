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
  /// sum E V over the cells [J]: the energy scale of a strain of 1.
  double
  unit_energy(const FESpace &fe_space, const Material &material);

  /// sum E_e V [J] with Young's moduli of the examples' elasticity: the scale of the weights'
  /// quadratic form.
  double
  unit_energy_of_examples(const FESpace &fe_space, const Material &material);

  /// How strains are computed from the poses.
  struct StrainRule
  {
    ActsOn acts_on;
    bool   is_single; ///< rounded to single precision
  };

  /// An example pose.
  struct ExamplePose
  {
    std::string            name;      ///< the file or the formula that gives it, for messages
    dealii::Vector<double> positions; ///< node positions by degree of freedom [m]
  };

  /// The example poses and their strains eta E_i at every quadrature point, Eqs. (4) and (5),
  /// computed once; eta is Examples/Importance. E_i is the part that examples act on, Eq. (31).
  /// Where examples have an elasticity of their own, D_i of Eq. (38) replaces eta E_i. Example 0 is
  /// the rest pose where it is included. Each example has one weight or, with Weights per region,
  /// one a region: weight r * size() + i is that of example i in region r. Empty in a scene without
  /// examples.
  class ExamplePoses
  {
  public:
    /// `named_poses` contains the poses of Examples/Poses, and `painted` the values of
    /// Examples/Weight maps in each cell; `cell_material` is that of the cells' energy without the
    /// part of `patches`, which are empty where there are none. Throws UserError for an invalid
    /// pose.
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

    /// The regions, which have separate weights; the weights of each region sum to one.
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

    /// Set the importance, greater than 0, and the material; see the constructor.
    void
    set_parameters(double importance, const Material &cell_material, const Patches &patches);

    /// Replace the material; see the constructor.
    void
    set_material(const Material &cell_material, const Patches &patches);

    /// Replace the nodes' positions [m] in example i, those of the vertices or of all nodes.
    /// Dependent data are updated by set_parameters(). Throws UserError for curved edges.
    void
    set_pose(unsigned int i, const std::vector<dealii::Point<3>> &places);

    /// Volume fraction of each region, weighted by shares; they sum to one.
    std::vector<double>
    volume_fractions() const;

    /// Volume of the region that each weight acts on [m^3].
    std::vector<double>
    volumes_of_weights() const;

    /// Name of example i.
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

    /// The arrays of the examples for the kernels.
    ExampleArrays
    arrays() const
    {
      return { n_strained(),   first_strained,
               size(),         n_weights(),
               strains.data(), regions.starts(),
               regions.list(), in_single.empty() ? nullptr : in_single.data() };
    }

    /// Call function(weight, example, share) for the weights that act at a point. The rest pose,
    /// where it is included, has no strain and is left out.
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

    /// Whether a weight changes the strain anywhere; not so for the rest pose.
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

    /// The index of a weight among the strained ones.
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

    /// The examples' Gram matrix in energy, and their dilatations of patches.
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

    /// Memory in bytes.
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
    dealii::AlignedVector<float>   in_single; ///< the same in single precision, if rule.is_single
    std::vector<double>            strain_norms;
    ExampleGram                    gram;
    const std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
