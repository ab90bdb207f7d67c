// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/body/pose_checks.h>
#include <exemplar/body/regions.h>
#include <exemplar/body/shell_strains.h>
#include <exemplar/body/strain_parts.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// p of Eq. (16) of a cell in an example, for its stretch I + E.
    double
    guard_product(const Matrix3<double> &E)
    {
      Matrix3<double> B = combine(-1., E, 0., E);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(E) + 2.;
      return determinant(B);
    }

    RegionShares
    make_regions(const ExampleParameters                &parameters,
                 const Mesh                             &mesh,
                 const FESpace                          &fe_space,
                 const std::vector<std::vector<double>> &painted)
    {
      if (!parameters.in_use())
        return {};
      if (fe_space.is_shell() && parameters.weights_per_region
          && parameters.region_blend_length > 0.)
        throw UserError("Examples/Region blend length is not for shells. Set it to 0.");
      const unsigned int n_points = points_per_cell(fe_space.element());
      if (!painted.empty())
        return painted_regions(painted, n_points, mesh.exchange());
      if (!parameters.weights_per_region)
        return {};
      // beyond the body's size the share of a region is uniform
      const double length = std::min(parameters.region_blend_length, 1e3 * mesh.diameter());
      return regions_of_materials(mesh, length, n_points);
    }
  } // namespace

  ShellElasticity
  shell_elasticity(const Material &material, const unsigned int cell, const ShellKind kind)
  {
    const CellMaterial<double> &solid = material.elasticity(cell);
    return ShellElasticity::of_solid(solid.lambda, solid.mu, kind);
  }

  double
  unit_energy(const FESpace &fe_space, const Material &material)
  {
    double sum = 0.;
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      sum += material.youngs_modulus(cell) * fe_space.cell_volume(cell);
    return fe_space.exchange().sum(sum);
  }

  double
  unit_energy_of_examples(const FESpace &fe_space, const Material &material)
  {
    double sum = 0.;
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      sum += material.youngs_modulus_of_examples(cell) * fe_space.cell_volume(cell);
    return fe_space.exchange().sum(sum);
  }

  namespace
  {
    /// Images of the nodes under a pose function.
    std::vector<dealii::Point<3>>
    images(const std::string &function, const FESpace &fe_space)
    {
      const Expression              expression("Examples/Pose functions", function, "xyz", 3);
      std::vector<dealii::Point<3>> images;
      const auto                    find = [&]
      {
        // a formula of places on a shell says nothing of the tips of its normals
        for (unsigned int node = 0; node < fe_space.numbering().n_places(); ++node)
          images.emplace_back(expression.vector(fe_space.rest_position(node), 0.));
      };
      do_in_agreement(fe_space.exchange(), find); // it may throw on one process alone
      return images;
    }
  } // namespace

  namespace
  {
    ExamplePose
    make_pose(const std::string                   &name,
              const std::vector<dealii::Point<3>> &places,
              const FESpace                       &fe_space)
    {
      const std::vector<dealii::Point<3>> nodes = fe_space.complete(places, "Examples, " + name);
      ExamplePose                         pose{ name, Vector(fe_space.n_dofs()),
                        fe_space.numbering().has_slopes() && places.size() < nodes.size() };
      for (unsigned int node = 0; node < nodes.size(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          pose.positions[3 * node + c] = nodes[node][c];
      return pose;
    }

    /// All example poses: the rest pose, files among `poses`, and functions.
    std::vector<ExamplePose>
    make_poses(const ExampleParameters &parameters,
               const Mesh              &mesh,
               const FESpace           &fe_space,
               const NamedPoses        &poses)
    {
      std::vector<ExamplePose> examples;
      if (!parameters.in_use())
        return examples;
      if (parameters.has_rest_pose())
        examples.push_back(make_pose("rest pose", mesh.get_nodes(), fe_space));
      for (const std::string &name : parameters.poses)
        examples.push_back(
            make_pose(name, mesh.find_pose(poses, name, "Examples/Poses"), fe_space));
      for (const std::string &function : split_trimmed(parameters.pose_functions, '|'))
        examples.push_back(
            make_pose("pose function '" + function + "'", images(function, fe_space), fe_space));
      return examples;
    }

    /// Warnings about the poses, apart from the rest pose.
    std::vector<std::string>
    review(const ExampleParameters        &parameters,
           const Mesh                     &mesh,
           const FESpace                  &fe_space,
           const std::vector<ExamplePose> &poses)
    {
      const auto functions      = split_trimmed(parameters.pose_functions, '|');
      const auto first_function = poses.size() - functions.size();

      std::vector<std::string> warnings;
      for (std::size_t i = parameters.has_rest_pose() ? 1 : 0; i < poses.size(); ++i)
      {
        const std::string &name        = poses[i].name;
        const Vector      &positions   = poses[i].positions;
        const std::string  of_function = i < first_function
                                             ? ""
                                             : describe_displacements(functions[i - first_function],
                                                                      mesh, fe_space, positions);
        if (!of_function.empty())
          warnings.push_back("Examples/Pose functions" + of_function);
        else if (const std::string problem = describe_pose(mesh, fe_space, positions);
                 !problem.empty())
          warnings.push_back(
              fmt::format("Example {} ({}) {}", parameters.first_number() + i, name, problem));
      }
      return warnings;
    }

    std::vector<std::string>
    names_of(const std::vector<ExamplePose> &poses)
    {
      std::vector<std::string> names;
      for (const ExamplePose &pose : poses)
        names.push_back(pose.name);
      return names;
    }

    /// Six numbers xx, yy, zz, yz, xz, xy; their products are those of the nine of the matrices, row by row.
    const TargetSpace strain_space{ n_symmetric, { 0, 5, 4, 5, 1, 3, 4, 3, 2 } };

    /// Of shells: membrane strains xx, yy, xy and curvatures, see ShellStrains.
    const TargetSpace shell_space{ n_shell_strains, shell_strain_order() };
  } // namespace

  ExamplePoses::ExamplePoses(const ExampleParameters        &parameters,
                             const LawsOfCells              &laws,
                             const Mesh                     &mesh,
                             const FESpace                  &fe_space,
                             const Patches                  &patches,
                             EnclosedVolumes                 enclosed,
                             const RegionShares             &shares,
                             const std::vector<double>      &volumes_of_points,
                             const std::vector<ExamplePose> &poses)
      : ExampleTargets(names_of(poses),
                       parameters.in_use() && parameters.has_rest_pose() ? 1 : 0,
                       shares,
                       volumes_of_points,
                       fe_space.exchange(),
                       parameters.first_number()),
        fe_space(fe_space), laws(laws), rule{ parameters.acts_on, parameters.in_single_precision },
        bending_importance(parameters.bending_importance),
        strains(fe_space.is_shell() ? shell_space : strain_space, *this, volumes_of_points, shares),
        volumes(std::move(enclosed)),
        dilatations({ 1, { 0 } },
                    WeightNumbers(n_weights()),
                    std::vector<double>(patches.size() + volumes.size(), 1.)),
        warnings(review(parameters, mesh, fe_space, poses))
  {
    for (const ExamplePose &pose : poses)
    {
      positions.push_back(pose.positions);
      finds_slopes_of.push_back(pose.finds_slopes);
    }
  }

  ExamplePoses::ExamplePoses(const ExampleParameters                &parameters,
                             const LawsOfCells                      &laws,
                             const Mesh                             &mesh,
                             const FESpace                          &fe_space,
                             const Material                         &cell_material,
                             const Patches                          &patches,
                             const NamedPoses                       &named_poses,
                             const std::vector<std::vector<double>> &painted)
      : ExamplePoses{ parameters,
                      laws,
                      mesh,
                      fe_space,
                      patches,
                      fe_space.is_shell() && cell_material.volume_stiffness() > 0.
                          ? EnclosedVolumes(fe_space.shell())
                          : EnclosedVolumes(),
                      make_regions(parameters, mesh, fe_space, painted),
                      parameters.in_use() ? fe_space.get_volumes() : std::vector<double>(),
                      make_poses(parameters, mesh, fe_space, named_poses) }
  {
    set_parameters(parameters.importance, cell_material, patches);
    if (parameters.weights == WeightRule::additive && size() > 0 && !fe_space.is_shell())
      review_sums(mesh, cell_material);
  }

  void
  ExamplePoses::set_parameters(const double    importance,
                               const Material &cell_material,
                               const Patches  &patches)
  {
    if (size() == 0)
      return;
    set_importance(importance);
    compute_strains(cell_material);
    compute_energies(cell_material, patches);
  }

  void
  ExamplePoses::set_material(const Material &cell_material, const Patches &patches)
  {
    if (rule.acts_on != ActsOn::all || cell_material.has_elasticity_of_examples()
        || fe_space.numbering().has_slopes()) // strains depend on the material
      set_parameters(importance(), cell_material, patches);
    else if (size() > 0)
      compute_energies(cell_material, patches);
  }

  void
  ExamplePoses::set_pose(const unsigned int i, const std::vector<dealii::Point<3>> &places)
  {
    const ExamplePose pose = make_pose(name(i), places, fe_space);
    positions[i]           = pose.positions;
    finds_slopes_of[i]     = pose.finds_slopes;
  }

  ExamplePoses::StrainOfPose
  ExamplePoses::strain_of_pose(const unsigned int point,
                               const unsigned int i,
                               const Material    &material) const
  {
    const unsigned int    cell = fe_space.cell_of(point);
    const CellLaw         law  = laws[cell];
    const Matrix3<double> F    = fe_space.deformation_gradient(point, pose(i));
    const Matrix3<double> E    = model_strain(law, model_rotation(law, F), F);
    return { E, ActingStrain<double>(rule.acts_on, material.whole_of_examples(cell),
                                     material.grain_axes(cell))
                    .of(E) };
  }

  void
  ExamplePoses::add_strains_of_shell(const Material &material)
  {
    for (unsigned int i = first_strained(); i < size(); ++i)
    {
      if (finds_slopes_of[i])
        positions[i] = fe_space.with_tips_of_least_bending(
            pose(i), [&](const unsigned int cell)
            { return shell_elasticity(material, cell, fe_space.shell().kind()); });
      const std::vector<ShellStrain> all = fe_space.shell_strains(pose(i));
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          strains.number(cell, i, k) = importance() * material.importance(cell)
                                       * (k < n_shell_strains / 2 ? 1. : bending_importance)
                                       * all[cell][k];
    }
  }

  void
  ExamplePoses::compute_strains(const Material &material)
  {
    guard_bound = ExampleConstants().guard_bound;
    strains.clear();
    if (fe_space.is_shell())
      add_strains_of_shell(material);
    const bool own = material.has_elasticity_of_examples();
    for (unsigned int point = 0; !fe_space.is_shell() && point < fe_space.n_points(); ++point)
    {
      const unsigned int cell = fe_space.cell_of(point);
      const CellLaw      law  = laws[cell];
      for (unsigned int i = first_strained(); i < size(); ++i)
      {
        const auto [E, part] = strain_of_pose(point, i, material);
        add_to_stored(strains.data(), point, n_strained(), i - first_strained(),
                      own ? 1. : importance() * material.importance(cell),
                      own ? material.blend(cell).drawn_strain(part) : part);
        if (traits_of(law).has_guard)
          guard_bound = min_or_nan(guard_bound, 0.5 * guard_product(E));
      }
    }
    if (rule.is_single)
      strains.round_to_single();
    measure(strains);
    guard_bound = min_of_all(fe_space.exchange(), guard_bound);
    if (!std::isfinite(max_entry(norms())) || !std::isfinite(guard_bound))
      throw UserError("Examples: the strains of the poses are not finite numbers, or too large to "
                      "compute with. Are all poses in the unit of the mesh?");
  }

  std::size_t
  ExamplePoses::memory_consumption() const
  {
    std::size_t of_poses = 0;
    for (const Vector &pose : positions)
      of_poses += pose.memory_consumption();
    return of_poses + strains.memory_consumption() + dilatations.memory_consumption()
           + ExampleTargets::memory_consumption();
  }
} // namespace Exemplar
