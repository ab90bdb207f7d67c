// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/stretch_modes.h>
#include <exemplar/potential/patch_guard.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    // |F|^2 = 3 at rest; for every Poisson's ratio the guard of a cell begins beyond 6.76, which is
    // where beta reaches 1 for the least bound
    constexpr double min_bound = 5., relative_range = 0.3;

    /// beta(m) = z^3 (10 - 15 z + 6 z^2) and its first two derivatives.
    std::array<double, 3>
    transition(const double m, const double bound)
    {
      const double range = relative_range * bound;
      const double z     = std::clamp((m - bound) / range, 0., 1.);
      return { { z * z * z * (10. - 15. * z + 6. * z * z),
                 30. * z * z * (1. - z) * (1. - z) / range,
                 60. * z * (1. - z) * (1. - 2. * z) / (range * range) } };
    }

    /// m_p of each patch where the nodes are at `positions`.
    std::vector<double>
    mean_squares_of(const Patches &patches, const FESpace &fe_space, const Vector &positions)
    {
      std::vector<double> means(patches.size(), 0.);
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const unsigned int    patch = patches.of_point(point);
        const Matrix3<double> F     = fe_space.deformation_gradient(point, positions);
        means[patch] += fe_space.volume(point) / patches.volume(patch) * contract(F, F);
      }
      return means;
    }

    CorotationalCell<double>
    with_guard(CorotationalCell<double> state, const CellMaterial<double> &C)
    {
      state.set_guard_elasticity(C);
      return state;
    }

    /// Add factor (u v^T + v u^T) / 2.
    void
    add_product(const double                factor,
                const std::vector<double>  &u,
                const std::vector<double>  &v,
                dealii::FullMatrix<double> &matrix)
    {
      if (factor == 0.)
        return;
      for (std::size_t i = 0; i < u.size(); ++i)
        for (std::size_t j = 0; j < u.size(); ++j)
          matrix(i, j) += 0.5 * factor * (u[i] * v[j] + v[i] * u[j]);
    }

    /// The same as outer products of single vectors.
    void
    add_product(const double                     factor,
                const std::vector<double>       &u,
                const std::vector<double>       &v,
                const std::vector<unsigned int> &nodes,
                OuterProducts                   &products)
    {
      if (factor == 0.)
        return;
      if (u == v)
      {
        products.add(factor, nodes, u);
        return;
      }
      std::vector<double> sum(u.size()), difference(u.size());
      for (std::size_t i = 0; i < u.size(); ++i)
      {
        sum[i]        = u[i] + v[i];
        difference[i] = u[i] - v[i];
      }
      products.add(0.25 * factor, nodes, sum);
      products.add(-0.25 * factor, nodes, difference);
    }

    /// Add vectors over the nodes of a cell to one over the nodes of its patch.
    void
    add_at(const unsigned int        *places,
           const std::vector<double> &of_cell,
           const double               factor,
           std::vector<double>       &of_patch)
    {
      for (std::size_t i = 0; i < of_cell.size(); ++i)
        of_patch[3 * places[i / 3] + i % 3] += factor * of_cell[i];
    }
  } // namespace

  PatchGuard::PatchGuard(const Patches      &patches,
                         const FESpace      &fe_space,
                         const Material     &material,
                         const ExamplePoses &examples)
      : patches(patches), fe_space(fe_space), material(material), bounds(patches.size(), min_bound)
  {
    for (unsigned int pose = 0; pose < examples.size(); ++pose)
    {
      const std::vector<double> of_pose = mean_squares_of(patches, fe_space, examples.pose(pose));
      for (unsigned int patch = 0; patch < patches.size(); ++patch)
        bounds[patch] = std::max(bounds[patch], 1.2 * of_pose[patch]);
    }
  }

  PatchGuard::Point
  PatchGuard::point_at(const CellField   &cells,
                       const Vector      &positions,
                       const unsigned int point,
                       const double       lambda,
                       const double       excess) const
  {
    const CellMaterial<double> &C = material.elasticity(fe_space.cell_of(point));
    const Matrix3<double>       F = fe_space.deformation_gradient(point, positions);
    auto                        state
        = cells.get_batches().cell<CorotationalCell<double>>(point, cells.rotation(point), F);
    state.set_target(Matrix3<double>{});
    const CorotationalCell guarded = with_guard(state, C);
    const double           G       = guarded.is_stretched() ? guarded.stretch().energy() : 0.;
    return { excess, F, &C, state, 0.5 * lambda * excess * excess + G };
  }

  void
  PatchGuard::find(const CellField           &cells,
                   const Vector              &positions,
                   const double              *traces,
                   const std::vector<double> &means,
                   const std::vector<double> &mean_squares)
  {
    stretched.clear();
    points.clear();
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      if (!(patches.lambda(patch) > 0. && mean_squares[patch] > bounds[patch])
          || !traits_of(cells.get_batches().law(patches.points(patch).front())).has_stretch_guard)
        continue;
      const auto [beta, first, second] = transition(mean_squares[patch], bounds[patch]);
      Stretched of_patch               = { means[patch], beta, first, second };
      for (const unsigned int point : patches.points(patch))
      {
        const auto at
            = points.emplace(point, point_at(cells, positions, point, patches.lambda(patch),
                                             traces[point] - means[patch]));
        of_patch.sum += fe_space.volume(point) * at.first->second.W;
      }
      stretched.emplace(patch, of_patch);
    }
  }

  double
  PatchGuard::density(const unsigned int point) const
  {
    const auto at = points.find(point);
    return at == points.end() ? 0. : stretched.at(patches.of_point(point)).beta * at->second.W;
  }

  double
  PatchGuard::energy() const
  {
    double sum = 0.;
    for (const auto &[patch, of_patch] : stretched)
      sum += of_patch.beta * of_patch.sum;
    return sum;
  }

  void
  PatchGuard::add_pressures(double *pressures) const
  {
    for (const auto &[point, at] : points)
      pressures[point] += pressure(point);
  }

  double
  PatchGuard::pressure(const unsigned int point) const
  {
    const unsigned int patch = patches.of_point(point);
    return patches.lambda(patch) * stretched.at(patch).beta * points.at(point).excess;
  }

  double
  PatchGuard::by_gradient(const unsigned int patch, const Stretched &of_patch) const
  {
    return 2. * of_patch.first * of_patch.sum / patches.volume(patch);
  }

  Matrix3<double>
  PatchGuard::guard_force(const CorotationalCell<double> &guarded)
  {
    return guarded.is_stretched() ? guarded.stretch().force() : Matrix3<double>{};
  }

  void
  PatchGuard::add_forces(const CellField &cells, Vector &gradient) const
  {
    std::vector<double> forces;
    for (const auto &[point, at] : points)
    {
      const unsigned int    patch    = patches.of_point(point);
      const Stretched      &of_patch = stretched.at(patch);
      const Matrix3<double> P_of_guard
          = cells.rotation(point) * guard_force(with_guard(at.state, *at.C));
      fe_space.nodal_forces(
          point, combine(of_patch.beta, P_of_guard, by_gradient(patch, of_patch), at.F), forces);
      const auto nodes = fe_space.nodes(fe_space.cell_of(point));
      for (std::size_t i = 0; i < forces.size(); ++i)
        gradient[3 * nodes[i / 3] + i % 3] += forces[i];
    }
  }

  void
  PatchGuard::add_tangent(const unsigned int          patch,
                          const CellField            &cells,
                          const PatchScatter         &scatter,
                          const ThinCells            &thin,
                          const Tangent               tangent,
                          const std::vector<double>  &b,
                          dealii::FullMatrix<double> &matrix,
                          OuterProducts              *products) const
  {
    const Stretched    &of_patch = stretched.at(patch);
    const double        lambda = patches.lambda(patch), volume = patches.volume(patch);
    std::vector<double> by_x_of_square(b.size(), 0.), by_x_of_sum(b.size(), 0.), forces;
    const unsigned int *places = scatter.places(patch);
    for (const unsigned int point : patches.points(patch))
    {
      const Point           &at       = points.at(point);
      const Matrix3<double> &R        = cells.rotation(point);
      Matrix3<double>        of_trace = thin.trace_gradient(point);
      for (int i = 0; i < 3; ++i)
        of_trace[i][i] += 1.;
      add_point_tangent(point, R, R * of_trace, tangent, places, matrix);
      if (tangent == Tangent::convex)
        add_stretch_modes(point, R, places, matrix);
      fe_space.nodal_forces(point, at.F, forces);
      add_at(places, forces, 2. / volume, by_x_of_square);
      const Matrix3<double> of_W
          = combine(1., guard_force(with_guard(at.state, *at.C)), lambda * at.excess, of_trace);
      fe_space.nodal_forces(point, R * of_W, forces);
      add_at(places, forces, 1., by_x_of_sum);
      places += forces.size() / 3;
    }
    const auto add
        = [&](const double factor, const std::vector<double> &u, const std::vector<double> &v)
    {
      if (products == nullptr)
        add_product(factor, u, v, matrix);
      else
        add_product(factor, u, v, scatter.nodes(patch), *products);
    };
    add(-lambda * of_patch.beta * volume, b, b);
    add_patch_tangent(of_patch, tangent, by_x_of_square, by_x_of_sum, add);
  }

  void
  PatchGuard::add_point_tangent(const unsigned int          point,
                                const Matrix3<double>      &R,
                                const Matrix3<double>      &by_F_of_trace,
                                const Tangent               tangent,
                                const unsigned int         *places,
                                dealii::FullMatrix<double> &matrix) const
  {
    const Point           &at        = points.at(point);
    const unsigned int     patch     = patches.of_point(point);
    const Stretched       &of_patch  = stretched.at(patch);
    const CorotationalCell guarded   = with_guard(at.state, *at.C);
    const bool             has_guard = tangent == Tangent::exact && guarded.is_stretched();
    const double           of_F      = by_gradient(patch, of_patch);
    const double        of_trace  = patches.lambda(patch) * of_patch.beta / fe_space.volume(point);
    const auto          gradients = fe_space.gradients(point);
    std::vector<double> u, column;
    fe_space.nodal_forces(point, by_F_of_trace, u);
    for (unsigned int j = 0; j < u.size(); ++j)
    {
      Matrix3<double> dF{};
      for (int l = 0; l < 3; ++l)
        dF[j % 3][l] = gradients[j / 3][l];
      Matrix3<double> of_guard{};
      if (has_guard)
      {
        const Matrix3<double> M = transpose_times(R, dF);
        of_guard                = R * combine(1., guarded.response(M), -1., at.state.response(M));
      }
      fe_space.nodal_forces(point, combine(of_patch.beta, of_guard, of_F, dF), column);
      for (unsigned int i = 0; i < u.size(); ++i)
        matrix(3 * places[i / 3] + i % 3, 3 * places[j / 3] + j % 3)
            += of_trace * u[i] * u[j] + column[i];
    }
  }

  void
  PatchGuard::add_stretch_modes(const unsigned int          point,
                                const Matrix3<double>      &R,
                                const unsigned int         *places,
                                dealii::FullMatrix<double> &matrix) const
  {
    const Point &at = points.at(point);
    if (!is_strongly_stretched(kink_slope(*at.C, sqrt(contract(at.F, at.F)))))
      return;
    const unsigned int       patch = patches.of_point(point);
    CorotationalCell<double> state = with_guard(at.state, *at.C);
    state.add_pressure(patches.lambda(patch) * stretched.at(patch).mean + pressure(point));
    const StretchModes  modes = stretch_modes(state, R, at.F);
    std::vector<double> u;
    for (std::size_t m = 0; m < modes.stiffness.size(); ++m)
    {
      fe_space.nodal_forces(point, R * modes.direction[m], u);
      for (std::size_t i = 0; i < u.size(); ++i)
        for (std::size_t j = 0; j < u.size(); ++j)
          matrix(3 * places[i / 3] + i % 3, 3 * places[j / 3] + j % 3)
              += modes.stiffness[m] / fe_space.volume(point) * u[i] * u[j];
    }
  }

  template <typename AddProduct>
  void
  PatchGuard::add_patch_tangent(const Stretched           &of_patch,
                                const Tangent              tangent,
                                const std::vector<double> &by_x_of_square,
                                const std::vector<double> &by_x_of_sum,
                                const AddProduct          &add_product) const
  {
    const bool   is_exact = tangent == Tangent::exact;
    const double second   = is_exact ? of_patch.second : std::max(of_patch.second, 0.);
    add_product(of_patch.sum * second, by_x_of_square, by_x_of_square);
    if (is_exact)
      add_product(2. * of_patch.first, by_x_of_square, by_x_of_sum);
  }
} // namespace Exemplar
