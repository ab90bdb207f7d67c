// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/prm_tools.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    const EnumTable<ExampleEnergy> energies
        = { { ExampleEnergy::scaled, "scaled" }, { ExampleEnergy::blended, "blended" } };
    const EnumTable<WeightRule> weight_kinds = { { WeightRule::simplex, "simplex" },
                                                 { WeightRule::free, "free" },
                                                 { WeightRule::prescribed, "prescribed" } };

    /// p of Eq. (16) of a cell in an example: of its stretch I + E.
    double
    guard_product(const Matrix3<double> &E)
    {
      Matrix3<double> B = combine(-1., E, 0., E);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(E) + 2.;
      return determinant(B);
    }
  } // namespace

  void
  ExampleParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Examples");
    declare_input_files(prm, "Poses", poses,
                        "Example poses: .msh files with the nodes and tetrahedra of the mesh, such "
                        "as the final.msh of another scene.");
    prm.add_parameter("Pose functions", pose_functions,
                      "Analytic example poses after those of Poses: x'; y'; z' as functions of the "
                      "rest position x, y, z [m]; poses separated by |.");
    prm.add_parameter("Include rest pose", include_rest_pose,
                      "Whether the rest pose is example 0. Without it a single example is a "
                      "permanent pre-strain.");
    prm.add_parameter(
        "Importance", importance,
        "eta [-]: 0 is plain elasticity (no pose file is opened), 1 lets the examples "
        "alone be free of stress.",
        dealii::Patterns::Double(0., 1.));
    prm.add_parameter(
        "Weight penalty", weight_penalty,
        "sigma [J] of the ridge sigma/2 sum w_i^2 on weights that are not prescribed: paper "
        "(1e-5 sum E V over the cells), auto (1e-9 sum E V with simplex weights, which "
        "decides ties and moves nothing; the paper's with free ones, which would "
        "run away) or a number not less than 0.");
    declare_enum(
        prm, "Energy", energy, energies,
        "scaled: V/2 (strain - eta E(w)) : C : (strain - eta E(w)), as the paper; blended: (1 - "
        "eta) of the elastic energy and eta of the distance to E(w).");
    declare_enum(
        prm, "Weights", weights, weight_kinds,
        "simplex: minimise the energy over weights that sum to one and are not negative; free: "
        "that sum to one, as the paper; prescribed: as given.");
    prm.add_parameter("Prescribed weights", prescribed_weights,
                      "One function of t for each example, the rest pose first where it is "
                      "included, separated by ;. They sum to one. With Weights per region either "
                      "the same for all, or one such list a region, in ascending order of material "
                      "ids, separated by |.");
    prm.add_parameter("Weights per region", weights_per_region,
                      "Whether the cells of each material id have weights of their own "
                      "(statistics: weight_R_i for example i in region R).");
    prm.add_parameter(
        "Region blend length", region_blend_length,
        "Distance [m] over which the weights of neighbouring regions pass into each "
        "other; 0: at once, at the border. Below the size of a cell: over about a cell.",
        dealii::Patterns::Double(0.));
    prm.leave_subsection();
  }

  std::optional<double>
  ExampleParameters::given_penalty() const
  {
    std::istringstream in(weight_penalty);
    double             value = -1.;
    if (in >> value && (in >> std::ws).eof() && value >= 0. && std::isfinite(value))
      return value;
    return {};
  }

  bool
  ExampleParameters::in_use() const
  {
    return importance > 0. && !(poses.empty() && pose_functions.empty());
  }

  void
  ExampleParameters::check() const
  {
    if (weight_penalty != "auto" && weight_penalty != "paper" && !given_penalty())
      throw UserError("Examples/Weight penalty = '" + weight_penalty
                      + "' is not allowed. Allowed: auto, paper or a number not less than 0 [J].");
    if (weights == WeightRule::prescribed && in_use() && prescribed_weights.empty())
      throw UserError("Examples/Weights = prescribed, but Examples/Prescribed weights is empty. "
                      "Give one function of t for each example, for instance '1-t; t'.");
    if (region_blend_length > 0. && !weights_per_region)
      throw UserError("Examples/Region blend length is given, but Examples/Weights per region is "
                      "false. Set it to true, or remove the length.");
    if (weights != WeightRule::prescribed && !prescribed_weights.empty())
      throw UserError("Examples/Prescribed weights is given, but Examples/Weights is not "
                      "'prescribed'. Set it, or remove the weights.");
  }

  namespace
  {
    std::optional<RegionShares>
    make_regions(const ExampleParameters &parameters, const Mesh &mesh, const FESpace &fe_space)
    {
      if (!parameters.weights_per_region)
        return {};
      // beyond the body's size all regions have the same share everywhere
      const double length = std::min(parameters.region_blend_length, 1e3 * mesh.diameter());
      return RegionShares(fe_space, mesh.get_material_ids(), length);
    }
  } // namespace

  double
  unit_energy(const FESpace &fe_space, const Material &material)
  {
    double sum = 0.;
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      sum += material.youngs_modulus(cell) * fe_space.tetrahedron(cell).volume;
    return sum;
  }

  ExamplePoses::ExamplePoses(const ExampleParameters &parameters,
                             const StrainMeasure      measure,
                             const Mesh              &mesh,
                             const FESpace           &fe_space,
                             const Material          &material)
      : fe_space(fe_space), eta(parameters.importance), measure(measure),
        regions(make_regions(parameters, mesh, fe_space)),
        first_strained(parameters.include_rest_pose ? 1 : 0)
  {
    if (parameters.include_rest_pose)
      add_pose("rest pose", mesh.get_nodes());
    for (const std::string &file : parameters.poses)
      add_pose(file, mesh.read_pose(file));
    add_pose_functions(parameters.pose_functions, mesh);
    compute_strains();
    compute_gram_matrix(material);
  }

  std::optional<unsigned int>
  ExamplePoses::material_id(const unsigned int region) const
  {
    if (!regions)
      return {};
    return regions->material_id(region);
  }

  void
  ExamplePoses::add_pose(const std::string &name, const std::vector<dealii::Point<3>> &nodes)
  {
    names.push_back(name);
    positions.emplace_back(fe_space.n_dofs());
    for (unsigned int node = 0; node < nodes.size(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        positions.back()[3 * node + c] = nodes[node][c];
  }

  void
  ExamplePoses::add_pose_functions(const std::string &functions, const Mesh &mesh)
  {
    for (const std::string &function : split_trimmed(functions, '|'))
    {
      const Expression              expression("Examples/Pose functions", function, "xyz", 3);
      std::vector<dealii::Point<3>> nodes;
      for (const dealii::Point<3> &x : mesh.get_nodes())
        nodes.emplace_back(expression.vector(x, 0.));
      add_pose("pose function '" + function + "'", nodes);
    }
  }

  void
  ExamplePoses::compute_strains()
  {
    strains.resize(batched_size(fe_space.n_cells(), 6 * n_strained()), 0.);
    strain_norms.assign(n_weights(), 0.);
    std::vector<unsigned int> n_inverted(size(), 0);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      for (unsigned int i = first_strained; i < size(); ++i)
      {
        const Matrix3<double> F = fe_space.deformation_gradient(cell, positions[i]);
        const Matrix3<double> E = model_strain(measure, model_rotation(measure, F), F);
        add_to_stored(strains.data(), cell, n_strained(), i - first_strained, 1., E);
        n_inverted[i] += (determinant(F) <= 0.);
        if (traits_of(measure).has_guard)
          p_0 = std::min(p_0, 0.5 * guard_product(E));
      }
      for_each_weight(cell,
                      [&](const unsigned int weight, const unsigned int i, const double share)
                      {
                        const Matrix3<double> E = strain(cell, i);
                        strain_norms[weight]
                            += fe_space.tetrahedron(cell).volume * share * share * contract(E, E);
                      });
    }
    for (double &norm : strain_norms)
      norm = std::sqrt(norm);
    for (unsigned int i = 0; i < size(); ++i)
      if (n_inverted[i] > 0)
        warnings.push_back("Example " + std::to_string(i) + " (" + names[i] + ") has "
                           + std::to_string(n_inverted[i])
                           + " inverted cells; their strain is ambiguous.");
  }

  void
  ExamplePoses::compute_gram_matrix(const Material &material)
  {
    gram.reinit(n_weights(), n_weights());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for_each_weight(
          cell,
          [&](const unsigned int v, const unsigned int i, const double share_v)
          {
            const Matrix3<double> T = stress(material.elasticity(cell), strain(cell, i));
            for_each_weight(cell,
                            [&](const unsigned int w, const unsigned int j, const double share_w)
                            {
                              gram(v, w) += fe_space.tetrahedron(cell).volume * share_v * share_w
                                            * contract(T, strain(cell, j));
                            });
          });
  }

  std::vector<double>
  ExamplePoses::volume_fractions() const
  {
    if (n_regions() == 1)
      return { 1. }; // without the sum's rounding
    const double        total = fe_space.total_volume();
    std::vector<double> fraction(n_regions(), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (std::size_t s = regions->first(cell); s < regions->last(cell); ++s)
        fraction[regions->list()[s].region]
            += regions->list()[s].value * fe_space.tetrahedron(cell).volume / total;
    return fraction;
  }

  std::size_t
  ExamplePoses::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return memory_consumption(positions) + strains.memory_consumption()
           + memory_consumption(strain_norms) + gram.memory_consumption();
  }
} // namespace Exemplar
