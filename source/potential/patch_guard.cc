// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_guard.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    // |F|^2 = 3 at rest; for every Poisson's ratio the guard of a cell begins beyond 6.76, which is
    // where beta reaches 1 for the least bound
    constexpr double least_bound = 5., relative_range = 0.3;

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

    std::vector<double>
    scaled(const double factor, std::vector<double> values)
    {
      for (double &value : values)
        value *= factor;
      return values;
    }
  } // namespace

  PatchGuard::PatchGuard(const Patches      &patches,
                         const FESpace      &fe_space,
                         const Material     &material,
                         const ExamplePoses *examples)
      : patches(patches), fe_space(fe_space), material(material),
        bounds(patches.size(), least_bound)
  {
    for (unsigned int pose = 0; examples != nullptr && pose < examples->size(); ++pose)
    {
      const std::vector<double> of_pose = mean_squares_of(patches, fe_space, examples->pose(pose));
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
    CorotationalCell<double>    state
        = { C.without_dilatation(), cells.rotation(point), F, cells.get_guard_bound() };
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
    if (!traits_of(cells.strain_measure()).has_guard || cells.get_guard_bound() == no_guard)
      return;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      if (!(patches.lambda(patch) > 0. && mean_squares[patch] > bounds[patch]))
        continue;
      const auto [beta, first, second] = transition(mean_squares[patch], bounds[patch]);
      Stretched of_patch               = { beta, first, second };
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
    const auto at = points.find(point);
    if (at == points.end())
      return 0.;
    const unsigned int patch = patches.of_point(point);
    return patches.lambda(patch) * stretched.at(patch).beta * at->second.excess;
  }

  bool
  PatchGuard::may_act(const unsigned int point) const
  {
    return points.count(point) > 0;
  }

  double
  PatchGuard::by_gradient(const unsigned int patch, const Stretched &of_patch) const
  {
    return 2. * of_patch.first * of_patch.sum / patches.volume(patch);
  }

  void
  PatchGuard::add_forces(const CellField &cells, Vector &gradient) const
  {
    for (const auto &[point, at] : points)
    {
      const unsigned int     patch      = patches.of_point(point);
      const Stretched       &of_patch   = stretched.at(patch);
      const CorotationalCell guarded    = with_guard(at.state, *at.C);
      const Matrix3<double>  P_of_guard = guarded.is_stretched()
                                              ? cells.rotation(point) * guarded.stretch().force()
                                              : Matrix3<double>{};
      const Matrix3<double>  P
          = combine(of_patch.beta, P_of_guard, by_gradient(patch, of_patch), at.F);
      const auto nodes = fe_space.nodes(fe_space.cell_of(point));
      for (unsigned int a = 0; a < nodes.size(); ++a)
      {
        const Vector3<double> force = P * fe_space.gradients(point)[a];
        for (unsigned int c = 0; c < 3; ++c)
          gradient[3 * nodes[a] + c] += fe_space.volume(point) * force[c];
      }
    }
  }

  void
  PatchGuard::add_forces(const PatchScatter    &scatter,
                         const unsigned int     patch,
                         const unsigned int     point,
                         const Matrix3<double> &P,
                         std::vector<double>   &forces) const
  {
    const std::vector<unsigned int> &all   = scatter.nodes(patch);
    const auto                       nodes = fe_space.nodes(fe_space.cell_of(point));
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      const auto place = std::lower_bound(all.begin(), all.end(), nodes[a]) - all.begin();
      const Vector3<double> force = P * fe_space.gradients(point)[a];
      for (unsigned int c = 0; c < 3; ++c)
        forces[3 * place + c] += fe_space.volume(point) * force[c];
    }
  }

  void
  PatchGuard::for_each_product(const unsigned int         patch,
                               const CellField           &cells,
                               const PatchScatter        &scatter,
                               const Tangent              tangent,
                               const std::vector<double> &b,
                               const ProductAdder        &add) const
  {
    const auto found = stretched.find(patch);
    if (found == stretched.end())
      return;
    const Stretched    &of_patch = found->second;
    const double        lambda = patches.lambda(patch), volume = patches.volume(patch);
    const bool          is_exact = tangent == Tangent::exact;
    std::vector<double> by_x_of_m(b.size(), 0.), by_x_of_sum(b.size(), 0.);
    for (const unsigned int point : patches.points(patch))
    {
      const Point           &at = points.at(point);
      const Matrix3<double> &R  = cells.rotation(point);
      std::vector<double>    u(b.size(), 0.);
      add_forces(scatter, patch, point, R, u);
      add(u, scaled(0.5 * lambda * of_patch.beta / fe_space.volume(point), u));
      add_forces(scatter, patch, point, combine(2. / volume, at.F, 0., at.F), by_x_of_m);
      add_forces(scatter, patch, point, combine(lambda * at.excess, R, 0., R), by_x_of_sum);

      const CorotationalCell guarded   = with_guard(at.state, *at.C);
      const bool             has_guard = is_exact && guarded.is_stretched();
      if (has_guard)
        add_forces(scatter, patch, point, R * guarded.stretch().force(), by_x_of_sum);
      if (has_guard || of_patch.first > 0.)
        add_point_products(
            scatter, patch, point,
            [&](const Matrix3<double> &dF)
            {
              const Matrix3<double> M = transpose_times(R, dF);
              Matrix3<double>       of_guard{};
              if (has_guard)
                of_guard = R * combine(1., guarded.response(M), -1., at.state.response(M));
              return combine(of_patch.beta, of_guard, by_gradient(patch, of_patch), dF);
            },
            add);
    }
    add(b, scaled(-0.5 * lambda * of_patch.beta * volume, b));
    std::vector<double> v
        = scaled(0.5 * of_patch.sum * (is_exact ? of_patch.second : std::max(of_patch.second, 0.)),
                 by_x_of_m);
    if (is_exact)
      for (std::size_t i = 0; i < v.size(); ++i)
        v[i] += of_patch.first * by_x_of_sum[i];
    add(by_x_of_m, v);
  }

  template <typename Response>
  void
  PatchGuard::add_point_products(const PatchScatter &scatter,
                                 const unsigned int  patch,
                                 const unsigned int  point,
                                 const Response     &response,
                                 const ProductAdder &add) const
  {
    const std::vector<unsigned int> &all   = scatter.nodes(patch);
    const auto                       nodes = fe_space.nodes(fe_space.cell_of(point));
    for (unsigned int a = 0; a < nodes.size(); ++a)
      for (unsigned int c = 0; c < 3; ++c)
      {
        Matrix3<double> dF{};
        for (int l = 0; l < 3; ++l)
          dF[c][l] = fe_space.gradients(point)[a][l];
        std::vector<double> unit(3 * all.size(), 0.), column(3 * all.size(), 0.);
        const auto place    = std::lower_bound(all.begin(), all.end(), nodes[a]) - all.begin();
        unit[3 * place + c] = 0.5;
        add_forces(scatter, patch, point, response(dF), column);
        add(unit, column);
      }
  }
} // namespace Exemplar
