// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_poses_h
#define exemplar_example_poses_h

#include <exemplar/body/enclosed_volumes.h>
#include <exemplar/body/example_parameters.h>
#include <exemplar/body/example_targets.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/material.h>
#include <exemplar/body/patches.h>
#include <exemplar/kernels/symmetric.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// The plane elasticity of a shell's triangle.
  ShellElasticity
  shell_elasticity(const Material &material, unsigned int cell, ShellKind kind);

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
    std::string name;          ///< the file or the formula that gives it, for messages
    Vector      positions;     ///< node positions by degree of freedom [m]
    bool finds_slopes = false; ///< of a shell, those of least bending energy for its material
  };

  /// The example poses of a body of cells and what they ask for there: the strains eta E_i at every quadrature
  /// point, Eqs. (4) and (5), computed once; eta is Examples/Importance. E_i is the part that examples act on,
  /// Eq. (31). Where examples have an elasticity of their own, D_i of Eq. (38) replaces eta E_i. Example 0 is
  /// the rest pose where it is included. Patches are a second block, of one number each. Each example has one
  /// weight or, with Weights per region, one a region.
  class ExamplePoses : public ExampleTargets
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

    /// Node positions of example i, by degree of freedom [m].
    const Vector &
    pose(const unsigned int i) const
    {
      return positions[i];
    }

    /// Whether the slopes of example i, of a shell, are those of least bending energy: they follow the material.
    bool
    finds_slopes(const unsigned int i) const
    {
      return finds_slopes_of[i];
    }

    /// The strains at the quadrature points: six numbers, as ExampleArrays has them.
    const TargetBlock &
    get_strains() const
    {
      return strains;
    }

    /// eta E_i at a quadrature point.
    Matrix3<double>
    strain(const unsigned int point, const unsigned int i) const
    {
      if (i < first_strained())
        return Matrix3<double>{};
      return load_stored(strains.data(), point, n_strained(), i - first_strained());
    }

    /// eta E(w) = eta sum_i w_i E_i at a point.
    Matrix3<double>
    strain(const unsigned int point, const std::vector<double> &weights) const
    {
      SymmetricEntries<double> sum{};
      strains.add_blend(point, weights, sum.value);
      return unpack(sum);
    }

    /// What the pieces of a shell enclose, if that resists.
    const EnclosedVolumes &
    get_volumes() const
    {
      return volumes;
    }

    /// Of these, for each weight the change of volume that it asks for.
    const TargetBlock &
    get_dilatations() const
    {
      return dilatations;
    }

    /// eta dtheta_p/dw of a patch by a weight, Eq. (25): the mean of eta tr E over the volume of
    /// the patch.
    double
    patch_dilatation(const unsigned int patch, const unsigned int weight) const
    {
      return dilatations.number(patch, weight, 0);
    }

    /// eta theta_p(E(w)) of a patch; 0 without examples.
    double
    patch_dilatation(const unsigned int patch, const std::vector<double> &weights) const
    {
      double sum = 0.;
      dilatations.add_blend(patch, weights, &sum);
      return sum;
    }

    /// The importance, and a bound of the guard (16) such that it leaves every example as it is.
    ExampleConstants
    constants() const
    {
      return { guard_bound, importance() };
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
    ExamplePoses(const ExampleParameters        &parameters,
                 const LawsOfCells              &laws,
                 const Mesh                     &mesh,
                 const FESpace                  &fe_space,
                 const Patches                  &patches,
                 EnclosedVolumes                 volumes,
                 const RegionShares             &shares,
                 const std::vector<double>      &volumes_of_points,
                 const std::vector<ExamplePose> &poses);

    /// E_i at a point, and the part of it that examples act on.
    struct StrainOfPose
    {
      Matrix3<double> whole, acting;
    };

    StrainOfPose
    strain_of_pose(unsigned int point, unsigned int i, const Material &material) const;

    void
    compute_strains(const Material &material);

    void
    add_strains_of_shell(const Material &material);

    TargetEnergy
    energy_of_shell(const Material &material) const;

    void
    compute_changes_of_volumes(const Material &material);

    TargetEnergy
    energy_of_volumes(const Material &material) const;

    /// Warns of cells in which keys together ask for no thickness. Collective.
    void
    review_sums(const Mesh &mesh, const Material &material);

    void
    compute_dilatations(const Patches &patches);

    TargetEnergy
    energy_of_cells(const Material &cell_material, const Patches &patches) const;

    TargetEnergy
    energy_of_patches(const Material &cell_material, const Patches &patches) const;

    /// The dilatations of patches and the forms of the weights.
    void
    compute_energies(const Material &cell_material, const Patches &patches);

    const FESpace           &fe_space;
    const LawsOfCells        laws;
    double                   guard_bound = ExampleConstants().guard_bound;
    std::vector<Vector>      positions; ///< of the nodes in each example
    std::vector<bool>        finds_slopes_of;
    const StrainRule         rule;
    const double             bending_importance;
    TargetBlock              strains;
    const EnclosedVolumes    volumes;     ///< of a shell; without pieces where these do not resist
    TargetBlock              dilatations; ///< of patches, or these, with a list for each weight
    std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
