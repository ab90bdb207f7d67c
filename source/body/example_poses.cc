// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/body/pose_checks.h>
#include <exemplar/body/strain_parts.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <deal.II/base/memory_consumption.h>

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
      const unsigned int n_points = points_per_cell(fe_space.element());
      if (!painted.empty())
        return RegionShares(painted, n_points, mesh.exchange());
      if (!parameters.weights_per_region)
        return {};
      // beyond the body's size the share of a region is uniform
      const double length = std::min(parameters.region_blend_length, 1e3 * mesh.diameter());
      return RegionShares(mesh, length, n_points);
    }
  } // namespace

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
        for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
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
      const std::vector<dealii::Point<3>> nodes
          = fe_space.numbering().complete(places, "Examples, " + name);
      ExamplePose pose{ name, dealii::Vector<double>(fe_space.n_dofs()) };
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
      if (parameters.include_rest_pose)
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
      for (std::size_t i = parameters.include_rest_pose ? 1 : 0; i < poses.size(); ++i)
      {
        const auto &[name, positions] = poses[i];
        const std::string of_function = i < first_function
                                            ? ""
                                            : describe_displacements(functions[i - first_function],
                                                                     mesh, fe_space, positions);
        if (!of_function.empty())
          warnings.push_back("Examples/Pose functions" + of_function);
        else if (const std::string problem = describe_pose(mesh, fe_space, positions);
                 !problem.empty())
          warnings.push_back(fmt::format("Example {} ({}) {}", i, name, problem));
      }
      return warnings;
    }

    void
    round_to_single(dealii::AlignedVector<double> &numbers, dealii::AlignedVector<float> &in_single)
    {
      in_single.resize_fast(numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = in_single[i] = static_cast<float>(numbers[i]);
    }
  } // namespace

  ExamplePoses::ExamplePoses(const ExampleParameters                &parameters,
                             const LawsOfCells                      &laws,
                             const Mesh                             &mesh,
                             const FESpace                          &fe_space,
                             const Material                         &cell_material,
                             const Patches                          &patches,
                             const NamedPoses                       &named_poses,
                             const std::vector<std::vector<double>> &painted)
      : fe_space(fe_space),
        laws(laws), example_constants{ ExampleConstants().guard_bound,
                                       parameters.in_use() ? parameters.importance : 0. },
        regions(make_regions(parameters, mesh, fe_space, painted)),
        poses(make_poses(parameters, mesh, fe_space, named_poses)),
        first_strained(parameters.in_use() && parameters.include_rest_pose ? 1 : 0),
        rule{ parameters.acts_on, parameters.in_single_precision },
        warnings(review(parameters, mesh, fe_space, poses))
  {
    set_parameters(example_constants.importance, cell_material, patches);
  }

  void
  ExamplePoses::set_parameters(const double    importance,
                               const Material &cell_material,
                               const Patches  &patches)
  {
    if (poses.empty())
      return;
    example_constants.importance = importance;
    compute_strains(cell_material);
    gram.compute(*this, fe_space, laws, cell_material, patches);
  }

  void
  ExamplePoses::set_material(const Material &cell_material, const Patches &patches)
  {
    if (rule.acts_on != ActsOn::all
        || cell_material.has_elasticity_of_examples()) // strains depend on the material
      set_parameters(example_constants.importance, cell_material, patches);
    else if (!poses.empty())
      gram.compute(*this, fe_space, laws, cell_material, patches);
  }

  void
  ExamplePoses::set_pose(const unsigned int i, const std::vector<dealii::Point<3>> &places)
  {
    poses[i] = make_pose(poses[i].name, places, fe_space);
  }

  void
  ExamplePoses::compute_strains(const Material &material)
  {
    example_constants.guard_bound = ExampleConstants().guard_bound;
    strains.clear();
    strains.resize(batched_size(fe_space.n_points(), 6 * n_strained()), 0.);
    strain_norms.assign(n_weights(), 0.);
    double &p_0 = example_constants.guard_bound;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const CellLaw law = laws[fe_space.cell_of(point)];
      for (unsigned int i = first_strained; i < size(); ++i)
      {
        const Matrix3<double> F    = fe_space.deformation_gradient(point, poses[i].positions);
        const Matrix3<double> E    = model_strain(law, model_rotation(law, F), F);
        const unsigned int    cell = fe_space.cell_of(point);
        const Matrix3<double> part
            = ActingStrain<double>(rule.acts_on, material.whole_of_examples(cell),
                                   material.grain_axes(cell))
                  .of(E);
        const bool own = material.has_elasticity_of_examples();
        add_to_stored(strains.data(), point, n_strained(), i - first_strained,
                      own ? 1. : example_constants.importance * material.importance(cell),
                      own ? material.blend(cell).drawn_strain(part) : part);
        if (traits_of(law).has_guard)
          p_0 = min_or_nan(p_0, 0.5 * guard_product(E));
      }
    }
    if (rule.is_single)
      round_to_single(strains, in_single);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      for_each_weight(point,
                      [&](const unsigned int weight, const unsigned int i, const double share)
                      {
                        const Matrix3<double> E = strain(point, i);
                        strain_norms[weight]
                            += fe_space.volume(point) * share * share * contract(E, E);
                      });
    fe_space.exchange().sum(strain_norms);
    p_0 = min_of_all(fe_space.exchange(), p_0);
    for (double &norm : strain_norms)
      norm = std::sqrt(norm);
    if (!std::isfinite(max_entry(strain_norms)) || !std::isfinite(p_0))
      throw UserError("Examples: the strains of the poses are not finite numbers, or too large to "
                      "compute with. Are all poses in the unit of the mesh?");
  }

  std::vector<double>
  ExamplePoses::volume_fractions() const
  {
    if (regions.n_regions() == 1)
      return { 1. }; // exactly, without rounding of the sum
    const double        total = fe_space.total_volume();
    std::vector<double> fraction(regions.n_regions(), 0.);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      regions.for_each(point, [&](const unsigned int region, const double share)
                       { fraction[region] += share * fe_space.volume(point) / total; });
    fe_space.exchange().sum(fraction);
    return fraction;
  }

  std::vector<double>
  ExamplePoses::volumes_of_weights() const
  {
    const double              total      = fe_space.total_volume();
    const std::vector<double> of_regions = volume_fractions();
    std::vector<double>       volumes;
    for (unsigned int weight = 0; weight < n_weights(); ++weight)
      volumes.push_back(total * of_regions[weight / size()]);
    return volumes;
  }

  std::size_t
  ExamplePoses::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    std::size_t of_poses = 0;
    for (const ExamplePose &pose : poses)
      of_poses += pose.positions.memory_consumption();
    return of_poses + strains.memory_consumption() + in_single.memory_consumption()
           + memory_consumption(strain_norms) + gram.memory_consumption();
  }
} // namespace Exemplar
