// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_strains_h
#define exemplar_example_strains_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <optional>

namespace Exemplar
{
  /// Chain rule: the derivative by F of a function with the derivative `by_strain` by the strain of
  /// F.
  Matrix3<double>
  pulled_back(CellLaw law, const Matrix3<double> &F, const Matrix3<double> &by_strain);

  /// The full strains of the example poses, before Examples/Acts on selects a part of them, and the
  /// poses that set the bounds of guards.
  class ExampleStrains
  {
  public:
    /// The problem must outlive it.
    explicit ExampleStrains(const Problem &problem);

    const LawsOfCells &
    get_laws() const
    {
      return laws;
    }

    /// Strain of example i at a point.
    Matrix3<double>
    strain(const unsigned int point, const unsigned int i) const
    {
      return unpack(strains[point * poses.size() + i]);
    }

    /// Stretch S of an example at a point where the law has rotations.
    Matrix3<double>
    stretch(unsigned int point, unsigned int i) const;

    /// sum w_i E_i, the blend of the examples' strains.
    Matrix3<double>
    wish(unsigned int point, const std::vector<double> &weights) const;

    /// An example at a point.
    struct Place
    {
      unsigned int point, pose;
    };

    /// The example and point whose product p gives p_0 = p/2 of Eq. (16); nothing if no example
    /// lowers p_0.
    std::optional<Place>
    place_of_guard_bound() const;

    /// The example whose |F|^2 sets the bound of the guard (26) of a patch; nothing if none does.
    std::optional<unsigned int>
    pose_of_bound(const unsigned int patch) const
    {
      return bound_poses[patch];
    }

  private:
    std::optional<unsigned int>
    find_pose_of_bound(unsigned int patch) const;

    const FESpace                           &fe_space;
    const Patches                           &patches;
    const ExamplePoses                      &poses;
    const LawsOfCells                        laws;
    std::vector<SymmetricEntries<double>>    strains;     ///< by point, of all examples
    std::vector<std::optional<unsigned int>> bound_poses; ///< of each patch
  };

  /// Chain rule: add the derivatives by strains to those by the poses and by shape gradients.
  void
  carry_strains_to_poses(const Problem &problem, SlopeDerivatives &sums);

  /// Add a slope's derivatives through p_0 of Eq. (16), which the example with the least product p
  /// sets; `by_bound` is its derivative by p_0.
  void
  add_slope_of_guard_bound(const Problem        &problem,
                           const ExampleStrains &strains,
                           double                by_bound,
                           SlopeDerivatives     &sums);
} // namespace Exemplar

#endif
