// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_guard_h
#define exemplar_patch_guard_h

#include <exemplar/body/example_poses.h>
#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_scatter.h>
#include <exemplar/potential/thin_cells.h>

#include <deal.II/lac/full_matrix.h>

#include <map>
#include <vector>

namespace Exemplar
{
  /// What strongly stretched patches need beside Eq. (25). Where a patch pulls at its cells with
  /// more than 2 mu, each of them could lower the energy by collapsing while the others keep the
  /// mean. So the points get their own dilatation back, and its guard (24), Eq. (26):
  ///
  ///   beta(m_p) sum V W,   W = lambda_p/2 (tr(e) - theta_p)^2 + G,
  ///
  /// with the mean m_p of |F|^2 over the patch. Beta is 0 up to a bound well above what m_p is in
  /// the example poses, so that these stay free of force. Hardly any step needs it; then there is
  /// nothing in it.
  class PatchGuard
  {
  public:
    /// All must outlive it.
    PatchGuard(const Patches      &patches,
               const FESpace      &fe_space,
               const Material     &material,
               const ExamplePoses &examples);

    /// Anew for these positions, the points' tr(e), and theta_p and m_p of the patches.
    void
    find(const CellField           &cells,
         const Vector              &positions,
         const double              *traces,
         const std::vector<double> &means,
         const std::vector<double> &mean_squares);

    /// beta W at a point [J/m^3].
    double
    density(unsigned int point) const;

    /// sum over the patches [J].
    double
    energy() const;

    /// Add to the pressures of the points [Pa].
    void
    add_pressures(double *pressures) const;

    /// Add the forces that are those of no pressure, by degree of freedom [N].
    void
    add_forces(const CellField &cells, Vector &gradient) const;

    /// Whether it adds to the energy of a patch.
    bool
    acts_in(unsigned int patch) const
    {
      return stretched.count(patch) > 0;
    }

    /// Add what it adds to the tangent of a patch, beside that which turning R does with the
    /// pressures, to `matrix` over the nodes of the patch, three rows each. `b` is dtheta_p/dx.
    /// A convex tangent lacks what may make it indefinite. Where there are `products`, they get what
    /// couples all nodes of the patch, and `matrix` only what couples those of one cell. Requires
    /// acts_in().
    void
    add_tangent(unsigned int                patch,
                const CellField            &cells,
                const PatchScatter         &scatter,
                const ThinCells            &thin,
                Tangent                     tangent,
                const std::vector<double>  &b,
                dealii::FullMatrix<double> &matrix,
                OuterProducts              *products) const;

  private:
    /// theta_p, beta of a patch with its derivatives by m_p, and sum V W [J].
    struct Stretched
    {
      double mean;
      double beta, first, second;
      double sum = 0.;
    };

    /// A quadrature point of a patch in which the guard acts, and what the guard needs of it.
    struct Point
    {
      double                      excess; ///< tr(e) - theta_p
      Matrix3<double>             F;
      const CellMaterial<double> *C;     ///< whose guard G is
      CorotationalCell<double>    state; ///< without examples, its target set
      double                      W;     ///< [J/m^3]
    };

    Point
    point_at(const CellField &cells,
             const Vector    &positions,
             unsigned int     point,
             double           lambda,
             double           excess) const;

    /// What it adds to the pressure of a point: beta lambda_p (tr(e) - theta_p) [Pa].
    double
    pressure(unsigned int point) const;

    /// The factor of F in the derivative of beta by the F of a point, times sum V W / V_c [Pa].
    double
    by_gradient(unsigned int patch, const Stretched &of_patch) const;

    /// R^T dG/dF at a point, where its guard acts.
    static Matrix3<double>
    guard_force(const CorotationalCell<double> &guarded);

    /// The part of the tangent that couples the nodes of one cell.
    void
    add_point_tangent(unsigned int                point,
                      const Matrix3<double>      &R,
                      const Matrix3<double>      &by_F_of_trace,
                      Tangent                     tangent,
                      const unsigned int         *places,
                      dealii::FullMatrix<double> &matrix) const;

    /// What the convex tangent R K R^T lacks at a strongly stretched point, see stretch_modes.h.
    void
    add_stretch_modes(unsigned int                point,
                      const Matrix3<double>      &R,
                      const unsigned int         *places,
                      dealii::FullMatrix<double> &matrix) const;

    /// The part that couples all nodes of the patch: the second derivatives of beta, and those by it
    /// and by sum V W, from the derivatives of m_p and sum V W by the positions. Calls
    /// add_product(factor, u, v) for factor (u v^T + v u^T) / 2.
    template <typename AddProduct>
    void
    add_patch_tangent(const Stretched           &of_patch,
                      Tangent                    tangent,
                      const std::vector<double> &by_x_of_square,
                      const std::vector<double> &by_x_of_sum,
                      const AddProduct          &add_product) const;

    const Patches                    &patches;
    const FESpace                    &fe_space;
    const Material                   &material;
    std::vector<double>               bounds;    ///< of m_p, up to which beta = 0
    std::map<unsigned int, Stretched> stretched; ///< by patch, where beta > 0
    std::map<unsigned int, Point>     points;    ///< of these
  };
} // namespace Exemplar

#endif
