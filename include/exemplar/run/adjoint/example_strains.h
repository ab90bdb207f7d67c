// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_strains_h
#define exemplar_example_strains_h

#include <exemplar/run/adjoint/slope_derivatives.h>

#include <optional>

namespace Exemplar
{
  /// The derivative by F of what has the derivative `by_strain` by the strain of F.
  Matrix3<double>
  pulled_back(CellLaw law, const Matrix3<double> &F, const Matrix3<double> &by_strain);

  /// (s_1+s_2)(s_2+s_3)(s_3+s_1) of a stretch S.
  double
  product_of_sums(const Matrix3<double> &S);

  /// The strains of example poses as they are, before a part of them acts, and what the bounds of guards have
  /// from them.
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

    /// Of example i at a point.
    Matrix3<double>
    strain(const unsigned int point, const unsigned int i) const
    {
      return unpack(strains[point * poses.size() + i]);
    }

    /// S of an example at a point where the law has rotations.
    Matrix3<double>
    stretch(unsigned int point, unsigned int i) const;

    /// sum w_i E_i.
    Matrix3<double>
    wish(unsigned int point, const std::vector<double> &weights) const;

    /// An example at a point.
    struct Place
    {
      unsigned int point, pose;
    };

    /// Where the example is of which p_0 of Eq. (16) is half the product p; nothing if none is.
    std::optional<Place>
    place_of_guard_bound() const;

    /// The example that says where the guard (26) of a patch begins; nothing if none does.
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

  /// Take the derivatives by strains to the poses that have them, and to the rest positions.
  void
  carry_strains_to_poses(const Problem &problem, SlopeDerivatives &sums);

  /// Of a slope with this derivative by p_0 of Eq. (16), which follows from the example that it must leave as
  /// it is.
  void
  add_slope_of_guard_bound(const Problem        &problem,
                           const ExampleStrains &strains,
                           double                by_bound,
                           SlopeDerivatives     &sums);
} // namespace Exemplar

#endif
