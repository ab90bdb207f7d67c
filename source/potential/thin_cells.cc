// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/thin_cells.h>

namespace Exemplar
{
  namespace
  {
    constexpr double y_0 = NearKink<double>::y_0;

    /// Whether y < y_0 may be, from tr S and |F|^2 alone: with I_2 = (tr^2 S - |F|^2) / 2 the product
    /// p = tr S I_2 - det F is at least 8/9 tr S I_2 if that is positive, as the inequality of the
    /// means bounds det F.
    bool
    may_be_thin(const double trace_of_S, const double square)
    {
      return 4. / 9. * trace_of_S * (trace_of_S * trace_of_S - square) < y_0 * square;
    }
  } // namespace

  ThinCells::Point
  ThinCells::point_at(const Matrix3<double> &R, const Matrix3<double> &F)
  {
    Point at{ { CellMaterial<double>{}, R, F, ExampleConstants() }, 0., y_0, {}, {} };
    at.state.set_target(Matrix3<double>{});
    const Matrix3<double> &S = at.state.stretch_factor();
    const double           u = contract(S, S);
    at.norm                  = std::sqrt(u);
    at.y                     = u > 0. ? at.state.product_of_sums() / u : y_0;
    if (at.y < y_0)
    {
      at.r            = NearKink<double>(at.y);
      at.y_derivative = y_derivative_of(S, at.y, u);
    }
    return at;
  }

  double
  ThinCells::trace_supplement(const Matrix3<double> &S)
  {
    if (!may_be_thin(trace(S), contract(S, S)))
      return 0.;
    Matrix3<double> identity{};
    for (int i = 0; i < 3; ++i)
      identity[i][i] = 1.;
    const Point at = point_at(identity, S);
    return at.y < y_0 ? at.r.value : 0.;
  }

  void
  ThinCells::find(const CellField &cells,
                  const Vector    &positions,
                  double          *traces,
                  const double    *squares)
  {
    points.clear();
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      if (!may_be_thin(traces[point] + 3., squares[point])
          || !traits_of(cells.get_batches().law(point)).has_stretch_guard)
        continue;
      const Point at
          = point_at(cells.rotation(point), fe_space.deformation_gradient(point, positions));
      if (!(at.y < y_0))
        continue;
      traces[point] += at.r.value;
      points.emplace(point, at);
    }
  }

  Matrix3<double>
  ThinCells::trace_gradient(const unsigned int point) const
  {
    const auto found = points.find(point);
    if (found == points.end())
      return {};
    const Point &at = found->second;
    return combine(at.r.first, at.y_derivative, 0., at.y_derivative);
  }

  void
  ThinCells::add_forces(const CellField &cells, const double *pressures, Vector &gradient) const
  {
    std::vector<double> forces;
    for (const auto &[point, at] : points)
    {
      const Matrix3<double> P
          = cells.rotation(point)
            * combine(pressures[point] * at.r.first, at.y_derivative, 0., at.y_derivative);
      fe_space.nodal_forces(point, P, forces);
      const auto nodes = fe_space.nodes(fe_space.cell_of(point));
      for (std::size_t i = 0; i < forces.size(); ++i)
        gradient[3 * nodes[i / 3] + i % 3] += forces[i];
    }
  }

  void
  ThinCells::add_tangent(const unsigned int          point,
                         const Matrix3<double>      &R,
                         const double                pressure,
                         const unsigned int         *places,
                         dealii::FullMatrix<double> &matrix) const
  {
    const Point           &at        = points.at(point);
    const Matrix3<double> &S         = at.state.stretch_factor();
    const auto             gradients = fe_space.gradients(point);
    std::vector<double>    forces;
    for (unsigned int j = 0; j < 3 * gradients.size(); ++j)
    {
      Matrix3<double> dF{};
      for (int l = 0; l < 3; ++l)
        dF[j % 3][l] = gradients[j / 3][l];
      const Matrix3<double> M     = transpose_times(R, dF);
      const Matrix3<double> Omega = at.state.turn(M);
      const Matrix3<double> dS    = symmetric_part(combine(1., M, -1., Omega * S));
      const double          dy    = contract(at.y_derivative, dS);
      const Matrix3<double> of_y
          = combine(at.r.first, y_second_derivative(S, at.y, at.norm, at.y_derivative, dS),
                    at.r.second * dy, at.y_derivative);
      const Matrix3<double> dP
          = R * combine(pressure, of_y, pressure * at.r.first, Omega * at.y_derivative);
      fe_space.nodal_forces(point, dP, forces);
      for (unsigned int i = 0; i < forces.size(); ++i)
        matrix(3 * places[i / 3] + i % 3, 3 * places[j / 3] + j % 3) += forces[i];
    }
  }
} // namespace Exemplar
