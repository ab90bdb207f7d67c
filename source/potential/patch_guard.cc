// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_guard.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
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
  } // namespace

  PatchGuard::PatchGuard(const Patches      &patches,
                         const FESpace      &fe_space,
                         const Material     &material,
                         const ExamplePoses &examples)
      : patches(patches), fe_space(fe_space), material(material),
        bounds(patches.size(), bound_of_guard(0.))
  {
    for (unsigned int pose = 0; pose < examples.size(); ++pose)
    {
      const std::vector<double> of_pose = mean_squares_of(patches, fe_space, examples.pose(pose));
      for (unsigned int patch = 0; patch < patches.size(); ++patch)
        bounds[patch] = std::max(bounds[patch], bound_of_guard(of_pose[patch]));
    }
  }

  bool
  PatchGuard::has_guard(const CellField &cells, const unsigned int patch) const
  {
    return traits_of(cells.get_batches().law(patches.points(patch).front())).has_guard_of_patches();
  }

  void
  PatchGuard::find(CellField                 &cells,
                   const Vector              &positions,
                   const std::vector<double> &means,
                   const std::vector<double> &mean_squares,
                   const double               share)
  {
    stretched.clear();
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (mean_squares[patch] > bounds[patch] && share * patches.lambda(patch) > 0.
          && has_guard(cells, patch))
      {
        const GuardTransition<double> beta(mean_squares[patch], bounds[patch]);
        stretched.push_back({ patch, share * patches.lambda(patch), means[patch], beta.value(),
                              beta.first(), beta.second() });
      }
    DilatationField &dilatation = cells.get_dilatation();
    dilatation.stretch.acts     = acts();
    if (!acts())
      return;
    write_pressures(dilatation, share);
    cells.update_stretch_energies(positions);
    find_sums(dilatation);
  }

  void
  PatchGuard::write_pressures(DilatationField &dilatation, const double share) const
  {
    StretchField &to = dilatation.stretch;
    to.reinit(fe_space.n_points());
    for (const Stretched &of_patch : stretched)
      for (const unsigned int point : patches.points(of_patch.patch))
      {
        const CellMaterial<double> C = material.elasticity(fe_space.cell_of(point)).scaled(share);
        const double               lambda       = of_patch.lambda;
        to.transitions[point]                   = of_patch.beta;
        to.stiffnesses[point]                   = of_patch.beta * lambda;
        to.elasticity[batch_index(point, 2, 0)] = C.lambda;
        to.elasticity[batch_index(point, 2, 1)] = C.mu;
        to.pressures[point]
            = lambda * (of_patch.mean + of_patch.beta * (dilatation.traces[point] - of_patch.mean));
      }
  }

  void
  PatchGuard::find_sums(DilatationField &dilatation)
  {
    for (Stretched &of_patch : stretched)
    {
      for (const unsigned int point : patches.points(of_patch.patch))
        of_patch.sum += fe_space.volume(point) * density(dilatation, of_patch, point);
      for (const unsigned int point : patches.points(of_patch.patch))
        dilatation.stretch.by_F[point]
            = 2. * of_patch.first * of_patch.sum / patches.volume(of_patch.patch);
    }
  }

  double
  PatchGuard::density(const DilatationField &dilatation,
                      const Stretched       &of_patch,
                      const unsigned int     point) const
  {
    const double excess = dilatation.traces[point] - of_patch.mean;
    return energy_of_guard(of_patch.lambda, excess * excess, dilatation.stretch.energies[point]);
  }

  void
  PatchGuard::add_densities(const CellField &cells, std::vector<double> &of_points) const
  {
    for (const Stretched &of_patch : stretched)
      for (const unsigned int point : patches.points(of_patch.patch))
        of_points[point] += of_patch.beta * density(cells.get_dilatation(), of_patch, point);
  }

  double
  PatchGuard::energy() const
  {
    double sum = 0.;
    for (const Stretched &of_patch : stretched)
      sum += of_patch.beta * of_patch.sum;
    return sum;
  }

  void
  PatchGuard::add_pressures(DilatationField &dilatation) const
  {
    for (const Stretched &of_patch : stretched)
      for (const unsigned int point : patches.points(of_patch.patch))
        dilatation.pressures[point]
            += dilatation.stretch.stiffnesses[point] * (dilatation.traces[point] - of_patch.mean);
  }

  void
  PatchGuard::find_products(const CellField    &cells,
                            const Vector       &positions,
                            const Tangent       tangent,
                            const PatchScatter &scatter,
                            PatchProducts      &products) const
  {
    if (!acts())
      return;
    const bool is_exact = tangent == Tangent::exact;
    for (PatchVectors *vectors : { &products.squares, &products.sums })
      vectors->assign(4 * scatter.n_nodes(), 0.);
    for (std::vector<double> *factors : { &products.of_squares, &products.of_products })
      factors->assign(patches.size(), 0.);
    std::vector<double> forces;
    for (const Stretched &of_patch : stretched)
    {
      const unsigned int patch = of_patch.patch;
      products.factors[patch] -= of_patch.beta * (of_patch.lambda * patches.volume(patch));
      products.of_squares[patch]
          = of_patch.sum * (is_exact ? of_patch.second : std::max(of_patch.second, 0.));
      products.of_products[patch] = is_exact ? of_patch.first : 0.;
      for (const unsigned int point : patches.points(patch))
      {
        const Matrix3<double> F = fe_space.deformation_gradient(point, positions);
        fe_space.nodal_forces(point, F, forces);
        scatter.add_at_cell(patch, point, 2. / patches.volume(patch), forces, products.squares);
        if (!is_exact)
          continue;
        const PatchCell<double> cell     = patch_cell(cells, point, F);
        Matrix3<double>         of_trace = cell.get_thin().gradient();
        for (int i = 0; i < 3; ++i)
          of_trace[i][i] += 1.;
        const double excess = cells.get_dilatation().traces[point] - of_patch.mean;
        fe_space.nodal_forces(
            point,
            cells.rotation(point)
                * combine(1., cell.guard_force(), of_patch.lambda * excess, of_trace),
            forces);
        scatter.add_at_cell(patch, point, 1., forces, products.sums);
      }
    }
  }

  PatchCell<double>
  patch_cell(const CellField &cells, const unsigned int point, const Matrix3<double> &F)
  {
    const StretchField    &stretch = cells.get_dilatation().stretch;
    StretchedPatch<double> patch{ 0., 0., 0., { 0., 0. } };
    if (stretch.acts)
      patch = { stretch.transitions[point],
                stretch.by_F[point],
                stretch.stiffnesses[point],
                { stretch.elasticity[batch_index(point, 2, 0)],
                  stretch.elasticity[batch_index(point, 2, 1)] } };
    const LawInput<double> in = cells.law_input(point, F);
    return { in.R, in.F, in.examples, patch };
  }

  bool
  has_special_patch(const CellField &cells, const unsigned int point)
  {
    const DilatationField &dilatation = cells.get_dilatation();
    return ((dilatation.flags[point / batch_size] & thin_cells) != 0
            || (dilatation.stretch.acts && dilatation.stretch.transitions[point] > 0.))
           && traits_of(cells.get_batches().law(point)).has_guard_of_patches();
  }
} // namespace Exemplar
