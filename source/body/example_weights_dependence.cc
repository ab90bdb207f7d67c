// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/conditioning.h>
#include <exemplar/algebra/dense.h>
#include <exemplar/base/errors.h>
#include <exemplar/body/example_weights.h>

#include <fmt/core.h>

#include <cmath>
#include <sstream>

// Affinely dependent examples, whose weights are not unique.

namespace Exemplar
{
  namespace
  {
    /// Conditioning of the Gram matrix, as a clause after "which".
    std::string
    condition_of(const dealii::FullMatrix<double> &gram, const double min_pivot)
    {
      if (!(min_pivot > 0.))
        return "is singular";
      std::ostringstream text;
      text << "has the condition number " << condition_number(gram);
      return text.str();
    }
  } // namespace

  void
  ExampleWeights::check_independence(const double unit_energy, const bool has_ridge)
  {
    const unsigned int               k = n_per_region();
    const dealii::FullMatrix<double> differences
        = form_of_differences(poses.get_gram().matrix(), k);
    const auto second = [k](const unsigned int d) { return d + d / (k - 1) + 1; };
    // strains of 1e-10 are rounding errors of a rest pose
    const double   of_rounding = std::pow(1e-10 * poses.constants().importance, 2) * unit_energy;
    const MinPivot least       = min_pivot(differences, of_rounding);
    if (differences.m() == 0 || least.ratio > 1e-8)
      return;
    const unsigned int example = second(least.row) % k;
    const auto         region  = poses.get_regions().material_id(second(least.row) / k);
    const std::string  where   = region ? fmt::format(" in region {}", *region) : "";
    const std::string which = fmt::format("Example {} ({}){}", example, poses.name(example), where);
    if (least.ratio < 1e-12 && !has_ridge)
      throw UserError(which
                      + " is an affine combination of the examples before it, so their weights "
                        "are not determined. Remove it from Examples/Poses or Examples/Pose "
                        "functions, or set Examples/Weight penalty to auto.");
    std::ostringstream text;
    text << which << " is " << (least.ratio < 1e-12 ? "" : "nearly ")
         << "an affine combination of the examples before it (their Gram matrix "
         << condition_of(differences, least.ratio) << "). "
         << (has_ridge
                 ? "The weight penalty decides between them; remove the example if it is there "
                   "by mistake."
                 : "Their weights are sensitive; remove the example, or set Examples/Weight "
                   "penalty to auto.");
    warnings.push_back(text.str());
  }
} // namespace Exemplar
