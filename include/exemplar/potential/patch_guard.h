// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_guard_h
#define exemplar_patch_guard_h

#include <exemplar/body/example_poses.h>
#include <exemplar/kernels/patch_cell.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_energy.h>
#include <exemplar/potential/patch_scatter.h>

#include <vector>

namespace Exemplar
{
  /// What strongly stretched patches need beside Eq. (25). Where a patch pulls at its cells with
  /// more than 2 mu, each of them could lower the energy by collapsing while the others keep the
  /// mean. So the points get their own dilatation back, and its guard (24), Eq. (26):
  ///
  ///   beta(m_p) sum V Xi,   Xi = lambda_p/2 (tr(e) - theta_p)^2 + Gamma,
  ///
  /// with the mean m_p of |F|^2 over the patch. Beta is 0 up to a bound well above what m_p is in
  /// the example poses, so that these stay free of force. Hardly any step needs it; then there is
  /// nothing in it. The loops add the forces and what of the tangent couples the nodes of one cell,
  /// from a StretchField.
  class PatchGuard
  {
  public:
    /// All must outlive it.
    PatchGuard(const Patches      &patches,
               const FESpace      &fe_space,
               const Material     &material,
               const ExamplePoses &examples);

    /// Anew for these positions, and theta_p and m_p of the patches, from the dilatations of the
    /// cells, whose stretch field is written, for this share of the elasticity.
    void
    find(CellField                 &cells,
         const Vector              &positions,
         const std::vector<double> &means,
         const std::vector<double> &mean_squares,
         double                     share);

    /// Whether it adds to the energy of some patch.
    bool
    acts() const
    {
      return !stretched.empty();
    }

    /// Add beta Xi of the points [J/m^3].
    void
    add_densities(const CellField &cells, std::vector<double> &of_points) const;

    /// sum over the patches [J].
    double
    energy() const;

    /// Add to the pressures of the points [Pa].
    void
    add_pressures(DilatationField &dilatation) const;

    /// What couples all nodes of its patches at these positions. A convex tangent lacks what may make it
    /// indefinite.
    void
    find_products(const CellField    &cells,
                  const Vector       &positions,
                  Tangent             tangent,
                  const PatchScatter &scatter,
                  PatchProducts      &products) const;

  private:
    /// Its lambda_p [Pa], theta_p, beta of a patch with its derivatives by m_p, and sum V Xi [J].
    struct Stretched
    {
      unsigned int patch;
      double       lambda;
      double       mean;
      double       beta, first, second;
      double       sum = 0.;
    };

    bool
    has_guard(const CellField &cells, unsigned int patch) const;

    /// The cells' part of the stretch field.
    void
    write_pressures(DilatationField &dilatation, double share) const;

    /// sum V Xi, of the energies Gamma.
    void
    find_sums(DilatationField &dilatation);

    /// Xi at a point [J/m^3].
    double
    density(const DilatationField &dilatation, const Stretched &of_patch, unsigned int point) const;

    const Patches         &patches;
    const FESpace         &fe_space;
    const Material        &material;
    std::vector<double>    bounds;    ///< of m_p, up to which beta = 0
    std::vector<Stretched> stretched; ///< where beta > 0, by patch
  };

  /// A point at which patches do more than to press.
  PatchCell<double>
  patch_cell(const CellField &cells, unsigned int point, const Matrix3<double> &F);

  /// Whether a patch does more at a point than to press: where the cell is thin or the guard (26) acts.
  bool
  has_special_patch(const CellField &cells, unsigned int point);
} // namespace Exemplar

#endif
