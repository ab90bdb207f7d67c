// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_dependent_poses_h
#define exemplar_dependent_poses_h

#include <exemplar/body/example_targets.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Examples of a region with a combination of strains sum a_i E_i that nearly vanishes, so that the energy hardly
  /// determines their weights along a.
  struct DependentPoses
  {
    std::vector<unsigned int>
                        weights;     ///< of the examples with a part in the combination, ascending
    std::vector<double> combination; ///< a_i times the energy norm of E_i for these, of length one

    /// Norm of sum a_i E_i over the root of the sum of the squared norms of a_i E_i.
    double remainder;

    /// Whether weights are exchanged for that of the rest pose, which then increases where the a_i decrease.
    bool involves_rest;
  };

  /// The combinations of strains that are smaller than 3 % of the strains themselves, from the Gram matrix; those
  /// of a region are linearly independent and involve few examples each. With `has_rest` weights can be exchanged for
  /// that of the rest pose, or decrease as those of keys do; otherwise the a_i sum to zero.
  std::vector<DependentPoses>
  find_dependent_poses(const ExampleTargets &targets, bool has_rest);

  /// The penalty along these combinations, which prefers the rest pose: a form of all weights, over the unit energy of
  /// their region. `unit_energy` [J] is that of the body. Entries are powers of two or sums of them, so that small changes of
  /// poses and material do not change them. Where one weight of two that cancel is zero, the form and its derivative with
  /// respect to the other one are zero, unless the sum with the Gram matrix would then not be convex.
  dealii::FullMatrix<double>
  preference_of(const std::vector<DependentPoses> &all,
                const ExampleTargets              &targets,
                bool                               has_rest,
                double                             unit_energy);

  /// A warning on these poses, with their names and the effect on positions.
  std::string
  describe(const DependentPoses &poses, const ExampleTargets &targets, bool has_rest);
} // namespace Exemplar

#endif
