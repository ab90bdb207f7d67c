// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_shell_scene_h
#define exemplar_tests_shell_scene_h

#include <exemplar/mesh/mesh.h>
#include <exemplar/potential/shell_body.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shells.h"

namespace Exemplar::Testing
{
  /// A shell with the strains of some states as examples beside its rest shape, of which the weights are to be
  /// found or, if there are none, nothing is.
  class ShellScene
  {
  public:
    static constexpr double E = 2., nu = 0.3, eta = 0.9;

    explicit ShellScene(ShellMesh                        of_shell,
                        const std::vector<Vector>       &poses            = {},
                        const HeldTips                  &held             = {},
                        const std::vector<unsigned int> &more_held        = {},
                        const double                     poissons         = nu,
                        const double                     volume_stiffness = 0.)
        : mesh(std::move(of_shell)), solid(box()), fe_space(solid),
          material(make_material(mesh, poissons, volume_stiffness)),
          examples(names(poses.size()), poses.empty() ? 0 : 1, {}, volumes(), Exchange::serial()),
          targets({ 6, shell_strain_order() }, examples, volumes()),
          enclosed(volume_stiffness > 0. ? EnclosedVolumes(mesh) : EnclosedVolumes()),
          targets_of_volumes({ 1, { 0 } },
                             WeightNumbers(examples.n_weights()),
                             std::vector<double>(enclosed.size(), 1.)),
          free_dofs(3 * mesh.n_nodes(), held_dofs(held, more_held), Exchange::serial()),
          held_tips(held.empty() ? HeldTips(mesh.edges().size(), 0) : held)
    {
      examples.set_importance(eta);
      ShellStrains strains(mesh);
      for (unsigned int i = 0; i < poses.size(); ++i)
      {
        const std::vector<ShellStrain> of_pose = strains.strains(poses[i]);
        for (unsigned int piece = 0; piece < enclosed.size(); ++piece)
          targets_of_volumes.number(piece, i + 1, 0) = eta * enclosed.change(piece, poses[i]);
        for (unsigned int t = 0; t < of_pose.size(); ++t)
          for (unsigned int k = 0; k < 6; ++k)
            targets.number(t, i + 1, k) = eta * of_pose[t][k];
      }
      const auto &solid_elasticity = material.elasticity(0);
      const auto  C
          = ShellElasticity::of_solid(solid_elasticity.lambda, solid_elasticity.mu, mesh.kind());
      const auto dual = [C](unsigned int, const double *a, double *T)
      {
        const ShellStrain stress = C.stress({ { a[0], a[1], a[2], a[3], a[4], a[5] } });
        std::copy(stress.begin(), stress.end(), T);
      };
      if (!poses.empty())
      {
        examples.measure(targets);
        const auto of_volume = [&](const unsigned int piece, const double *a, double *T)
        { *T = volume_stiffness * enclosed.rest(piece) * *a; };
        examples.compute({ { targets, { dual }, {} }, { targets_of_volumes, { of_volume }, {} } });
      }
      ExampleParameters parameters;
      parameters.weights        = WeightRule::free;
      parameters.weight_penalty = "0.001";
      weights.emplace(parameters, examples, 1., TimeAxis::of_increments(TimeParameters()));
      set_threads(1);
    }

    void
    set_threads(const unsigned int n)
    {
      body    = std::make_unique<ShellBody>(ShellParts{ mesh, fe_space, material, examples, targets,
                                                     enclosed, targets_of_volumes, *weights,
                                                     free_dofs, n, &held_tips });
      pattern = body->make_pattern({}, false);
      body->attach(pattern);
    }

    ElasticEvaluation
    evaluate(const Vector &x, const std::vector<double> &w)
    {
      ElasticEvaluation result;
      body->evaluate(x, w, result);
      return result;
    }

    struct Assembled
    {
      std::vector<double> values, columns;
      OuterProducts       products;
      UnknownShear        shear;
    };

    Assembled
    assemble(const Tangent kind, const Vector &x, const std::vector<double> &w)
    {
      Assembled result;
      result.values.assign(pattern.n_values(), 0.);
      body->assemble_tangent(kind, x, w, result.values, result.columns, &result.products);
      body->find_shear(x, result.shear);
      return result;
    }

    dealii::FullMatrix<double>
    full(const Assembled &of) const
    {
      dealii::FullMatrix<double> A(pattern.n(), pattern.n());
      for (unsigned int j = 0; j < pattern.n(); ++j)
        for (int entry = pattern.column_start[j]; entry < pattern.column_start[j + 1]; ++entry)
          A(j, pattern.row[entry]) = A(pattern.row[entry], j) = of.values[entry];
      for (int side = 0; side < 2; ++side) // by degrees of freedom
      {
        for (unsigned int i = 0; i < A.m(); ++i)
          of.shear.forces_from_sheared(&A(i, 0));
        dealii::FullMatrix<double> transposed(A.n(), A.m());
        transposed.copy_transposed(A);
        A = transposed;
      }
      for (std::size_t k = 0; k < of.products.size(); ++k)
      {
        std::vector<double> u(pattern.n(), 0.);
        for (std::size_t i = of.products.begin(k); i < of.products.ends[k]; ++i)
          for (unsigned int c = 0; c < 3; ++c)
            if (const int row = free_dofs.free_index(3 * of.products.blocks[i] + c);
                row != FreeDofs::held)
              u[row] = of.products.values[3 * i + c];
        for (unsigned int i = 0; i < u.size(); ++i)
          for (unsigned int j = 0; j < u.size(); ++j)
            A(i, j) += of.products.factors[k] * u[i] * u[j];
      }
      return A;
    }

    /// Solve K u = f for fields by degree of freedom, zero where held.
    Vector
    solve(const Assembled &matrix, const Vector &f) const
    {
      const auto solver = make_sheared_operator(make_cholesky_operator(), pattern.n());
      solver->reinit(pattern);
      solver->values() = matrix.values;
      *solver->shear() = matrix.shear;
      solver->factorize(f);
      std::vector<double> column;
      free_dofs.gather(f, column);
      solver->solve(column);
      Vector u(f.size());
      free_dofs.add(1., column, u);
      return u;
    }

    ShellMesh                     mesh;
    Mesh                          solid; // of which the shell uses no more than how processes talk
    FESpace                       fe_space;
    Material                      material;
    ExampleTargets                examples;
    TargetBlock                   targets;
    EnclosedVolumes               enclosed;
    TargetBlock                   targets_of_volumes;
    FreeDofs                      free_dofs;
    HeldTips                      held_tips;
    std::optional<ExampleWeights> weights;
    std::unique_ptr<ShellBody>    body;
    SymmetricPattern              pattern;

  private:
    static MeshParameters
    box()
    {
      MeshParameters parameters;
      parameters.generator = MeshGenerator::box;
      parameters.box_cells = { { 1, 1, 1 } };
      return parameters;
    }

    static Material
    make_material(const ShellMesh &mesh, const double poissons, const double volume_stiffness)
    {
      MaterialParameters parameters;
      parameters.everywhere.youngs_modulus = E;
      parameters.everywhere.poissons_ratio = poissons;
      parameters.volume_stiffness          = volume_stiffness;
      return { parameters, std::vector<unsigned int>(mesh.triangles().size(), 0) };
    }

    static std::vector<std::string>
    names(const std::size_t n_poses)
    {
      std::vector<std::string> result;
      for (std::size_t i = 0; n_poses > 0 && i <= n_poses; ++i)
        result.push_back("example " + std::to_string(i));
      return result;
    }

    std::vector<double>
    volumes() const
    {
      std::vector<double> result;
      for (const ShellTriangle &triangle : mesh.triangles())
        result.push_back(triangle.volume());
      return result;
    }

    std::vector<unsigned int>
    held_dofs(const HeldTips &held, std::vector<unsigned int> all) const
    {
      for (unsigned int edge = 0; edge < mesh.n_slopes(); ++edge)
        for (unsigned int c = held.empty() || held[edge] == 0 ? 1 : 0; c < 3; ++c)
          all.push_back(3 * mesh.slope_node(edge) + c);
      std::sort(all.begin(), all.end());
      return all;
    }
  };
} // namespace Exemplar::Testing

#endif
