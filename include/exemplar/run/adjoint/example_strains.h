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
    ExampleStrains(const Problem &problem, const LawsOfCells &laws);

    /// Of example i at a point.
    const Matrix3<double> &
    strain(const unsigned int point, const unsigned int i) const
    {
      return strains[point * poses.size() + i];
    }

    /// S of an example at a point where the law has rotations.
    Matrix3<double>
    stretch(unsigned int point, unsigned int i) const;

    /// sum w_i E_i.
    Matrix3<double>
    wish(unsigned int point, const std::vector<double> &weights) const;

    /// The derivative by F_i of what has the derivative `by_strain` by the strain.
    Matrix3<double>
    pulled_back(unsigned int point, unsigned int i, const Matrix3<double> &by_strain) const;

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
    pose_of_bound(unsigned int patch) const;

  private:
    const FESpace               &fe_space;
    const Patches               &patches;
    const ExamplePoses          &poses;
    const LawsOfCells           &laws;
    std::vector<Matrix3<double>> strains; ///< by point, of all examples
  };

  /// Of a slope with this derivative by p_0 of Eq. (16), which follows from the example that it must leave as
  /// it is.
  void
  add_slope_of_guard_bound(const Problem        &problem,
                           const ExampleStrains &strains,
                           double                by_bound,
                           SlopeDerivatives     &sums);
} // namespace Exemplar

#endif
