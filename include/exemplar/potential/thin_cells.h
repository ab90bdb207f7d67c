// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_thin_cells_h
#define exemplar_thin_cells_h

#include <exemplar/body/fe_space.h>
#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/potential/cell_field.h>

#include <deal.II/lac/full_matrix.h>

#include <map>
#include <vector>

namespace Exemplar
{
  /// Points where the two least stretches nearly cancel, y < y_0 of Eq. (24). There tr S has a kink
  /// like |s_2 + s_3|, and a patch that pulls with more than 2 mu would make it a minimum at which no
  /// gradient vanishes. So the dilatation of a patch takes tr S + r(y), Eq. (25), whose kink r
  /// cancels. Hardly any step has such points.
  class ThinCells
  {
  public:
    /// It must outlive this.
    explicit ThinCells(const FESpace &fe_space) : fe_space(fe_space) {}

    /// r(y) of a point with that S; 0 where y >= y_0.
    static double
    trace_supplement(const Matrix3<double> &S);

    /// Anew for these positions, from tr(e) and |F|^2 of the points; add r to the tr(e) of those that
    /// are thin. Requires the rotations of these positions.
    void
    find(const CellField &cells, const Vector &positions, double *traces, const double *squares);

    bool
    has(const unsigned int point) const
    {
      return points.count(point) > 0;
    }

    bool
    empty() const
    {
      return points.empty();
    }

    /// R^T dr/dF at a point; 0 where it is not thin.
    Matrix3<double>
    trace_gradient(unsigned int point) const;

    /// Add the forces V pressure dr/dF of the points [N], by degree of freedom.
    void
    add_forces(const CellField &cells, const double *pressures, Vector &gradient) const;

    /// Add pressure d2r/dF2 of a thin point to a matrix over the nodes of its patch, three rows each,
    /// among which `places` has those of the point's cell.
    void
    add_tangent(unsigned int                point,
                const Matrix3<double>      &R,
                double                      pressure,
                const unsigned int         *places,
                dealii::FullMatrix<double> &matrix) const;

  private:
    /// A quadrature point at which the trace is continued, and what its derivatives need.
    struct Point
    {
      CorotationalCell<double> state; ///< of no material: its S and its turn
      double                   norm;  ///< |F|
      double                   y;
      NearKink<double>         r;
      Matrix3<double>          y_derivative;
    };

    static Point
    point_at(const Matrix3<double> &R, const Matrix3<double> &F);

    const FESpace                &fe_space;
    std::map<unsigned int, Point> points;
  };
} // namespace Exemplar

#endif
