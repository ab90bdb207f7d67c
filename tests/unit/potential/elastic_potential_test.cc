// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/inertia_term.h>

#include "body.h"
#include "matrices.h"
#include "stencil.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace Exemplar::Testing
{
  namespace
  {
    ExampleParameters
    two_examples()
    {
      ExampleParameters parameters;
      parameters.pose_functions = twist(60.) + " | 1.1*x; 0.9*y; z";
      parameters.importance     = 0.7;
      return parameters;
    }

    ModelParameters
    frozen_model()
    {
      ModelParameters model;
      model.gradient = GradientKind::frozen;
      return model;
    }

    double
    entry(const SymmetricPattern &pattern, const std::vector<double> &values, int i, int j)
    {
      if (i < j)
        std::swap(i, j);
      const int position = pattern.position(i, j);
      return position < pattern.column_start[j + 1] && pattern.row[position] == i ? values[position]
                                                                                  : 0.;
    }

    /// Entry of the coupling G on a free degree of freedom.
    double
    coupling(const ExamplePoses        &examples,
             const std::vector<double> &columns,
             const unsigned int         weight,
             const unsigned int         i)
    {
      const std::size_t n = columns.size() / examples.n_strained_weights();
      return examples.is_strained(weight) ? columns[examples.strained_index(weight) * n + i] : 0.;
    }

    /// Whether the guard (16) acts in all badly inverted cells.
    bool
    has_guard(const LawsOfCells &laws)
    {
      return std::all_of(laws.present().begin(), laws.present().end(),
                         [](const CellLaw law) { return traits_of(law).has_guard; });
    }

    /// On both elements, with dilatations of cells and of patches.
    class ElasticPotentialTest : public testing::TestWithParam<Discretisation>
    {
    };

    INSTANTIATE_TEST_SUITE_P(,
                             ElasticPotentialTest,
                             testing::Values(Discretisation{ Element::P1, false },
                                             Discretisation{ Element::P2, false },
                                             Discretisation{ Element::P1, true },
                                             Discretisation{ Element::P2, true }));

    std::vector<CellLaw>
    strains_of(const Discretisation &discretisation)
    {
      std::vector<CellLaw> strains;
      for (const CellLaw law : all_laws())
        if (traits_of(law).is_strain()
            && (traits_of(law).trace_gradient_is_R || !discretisation.has_patches))
          strains.push_back(law);
      return strains;
    }

    /// A bar of the element that is tested.
    class ParametricBody : public Body
    {
    public:
      ParametricBody()
          : Body(box_mesh(4., 4, 1), MaterialParameters(), ElasticPotentialTest::GetParam().element)
      {
        if (ElasticPotentialTest::GetParam().has_patches)
          make_patches();
      }
    };

    TEST_P(ElasticPotentialTest, RoundingGrowsWithTheWayFromTheOrigin)
    {
      const ParametricBody body;
      const auto           examples = body.examples(two_examples());
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const BodyPotential  elastic(body, frozen_model(), examples, free_dofs);
      const double         own = elastic.rounding_force(0.);
      EXPECT_GT(own, 0.);
      EXPECT_EQ(elastic.rounding_force(4.), own); // as far as it reaches at rest
      EXPECT_DOUBLE_EQ(elastic.rounding_force(40.), 10. * own);
    }

    // The frozen energy is quadratic in (x, w), so central differences are exact.
    TEST_P(ElasticPotentialTest, GradientsAreThoseOfTheFrozenEnergy)
    {
      const ParametricBody body;
      const auto           examples = body.examples(two_examples());
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential        elastic(body, frozen_model(), examples, free_dofs);
      std::mt19937         generator(1);
      auto                 positions = body.random_positions(generator, 0.1);
      elastic.update_rotations(body.random_positions(generator, 0.3));
      std::vector<double> weights = { 0.2, 0.5, 0.3 };

      ElasticEvaluation at, above, below;
      elastic.evaluate(positions, weights, at);
      const auto energy     = [](const ElasticEvaluation &e) { return e.energy; };
      const auto difference = [&](double &variable)
      {
        const double h = 1e-3, value = variable;
        variable = value + h;
        elastic.evaluate(positions, weights, above);
        variable = value - h;
        elastic.evaluate(positions, weights, below);
        variable = value;
        return (energy(above) - energy(below)) / (2. * h);
      };
      const double scale = at.gradient.linfty_norm();
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        EXPECT_NEAR(at.gradient[dof], difference(positions[dof]), 1e-8 * scale);
      for (unsigned int i = 0; i < weights.size(); ++i)
        EXPECT_NEAR(at.weight_gradient[i], difference(weights[i]), 1e-8 * at.weight_scale);
    }

    TEST_P(ElasticPotentialTest, MatrixAndColumnsAreTheDerivativesOfTheGradient)
    {
      const ParametricBody body;
      const auto           examples = body.examples(two_examples());
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), { 0, 4, 8, 30 }, Exchange::serial());
      const Mass           mass(body.fe_space, body.material, MassMatrix::consistent);
      TimeIntegrator       integrator{ TimeParameters() };
      InertiaTerm          inertia(mass, integrator);
      BodyPotential        elastic(body, frozen_model(), examples, free_dofs);
      std::mt19937         generator(2);
      auto                 positions = body.random_positions(generator, 0.1);
      elastic.update_rotations(positions);
      std::vector<double> weights = { 0.2, 0.5, 0.3 };

      State state;
      state.positions  = positions;
      state.velocities = positions;
      integrator.begin_step(state, 0.1);
      inertia.begin_step(state, 0.1);
      inertia.attach(elastic.matrix_pattern, free_dofs);
      std::vector<double> matrix(elastic.matrix_pattern.n_values()), columns;
      inertia.add_tangent({ positions, weights }, Tangent::exact, matrix, columns);
      elastic.assemble_tangent(Tangent::convex, positions, weights, matrix, columns);

      const auto gradient = [&]
      {
        ElasticEvaluation evaluation;
        elastic.evaluate(positions, weights, evaluation);
        ElasticSums sums(evaluation);
        inertia.add({ positions, weights }, sums);
        return sums->gradient;
      };
      const auto without = gradient();
      for (unsigned int j = 0; j < free_dofs.size(); ++j)
      {
        double      &variable = positions[free_dofs.list()[j]];
        const double value    = variable;
        variable += 1.;
        const auto with = gradient();
        variable        = value;
        for (unsigned int i = 0; i < free_dofs.size(); ++i)
          EXPECT_NEAR(entry(elastic.matrix_pattern, matrix, i, j),
                      with[free_dofs.list()[i]] - without[free_dofs.list()[i]], 1e-5);
      }
      for (unsigned int k = 0; k < weights.size(); ++k)
      {
        weights[k] += 1.;
        const auto with = gradient();
        weights[k] -= 1.;
        for (unsigned int i = 0; i < free_dofs.size(); ++i)
          EXPECT_NEAR(-coupling(*examples.poses, columns, k, i),
                      with[free_dofs.list()[i]] - without[free_dofs.list()[i]], 1e-6);
      }
    }

    struct TangentCase
    {
      Discretisation discretisation;
      LawsOfCells    laws;
      bool           per_region;
      double         damping;
      bool           is_guarded = false;
    };

    /// Disturbed, and by the guard (16) in all cells if asked for.
    Vector
    positions_of(const TangentCase &test_case, const Body &body, std::mt19937 &generator)
    {
      if (!test_case.is_guarded)
        return body.random_positions(generator, 0.05);
      Vector positions = body.random_positions(generator, 0.01);
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] *= std::array<double, 3>{ { 1.1, 0.7, -0.5 } }[dof % 3];
      return positions;
    }

    /// What laws remember of a body that has yielded a little, everywhere in another way.
    void
    let_remember(CellField &field)
    {
      std::vector<double> history = field.get_batches().history();
      for (std::size_t k = 0; k < history.size(); ++k)
        history[k] = 0.01 * (1. + std::sin(1. + k));
      field.get_batches().set_history(history);
    }

    double
    max_magnitude(const std::vector<double> &values)
    {
      double maximum = 0.;
      for (const double value : values)
        maximum = std::max(maximum, std::abs(value));
      return maximum;
    }

    /// Gradient, exact tangent and columns by central differences of energy and gradient.
    void
    expect_derivatives(const TangentCase &test_case)
    {
      Body body(bar_of_two_regions(2., box_mesh(4., 4, 1)), test_case.discretisation.element,
                material_of_law(test_case.laws[0]));
      if (test_case.discretisation.has_patches)
        body.make_patches();
      ExampleParameters parameters   = two_examples();
      parameters.weights_per_region  = test_case.per_region;
      parameters.region_blend_length = 2.;
      const auto     examples        = body.examples(parameters, test_case.laws);
      const FreeDofs free_dofs(body.fe_space.n_dofs(), { 0, 4, 8, 30 }, Exchange::serial());
      BodyPotential  elastic(body, test_case.laws, examples, free_dofs);
      std::mt19937   generator(4);
      auto           positions = positions_of(test_case, body, generator);
      const auto     past = body.random_positions(generator, 0.05), before = past;
      elastic.get_field().get_batches().set_step_size(
          std::numeric_limits<double>::infinity()); // cells may flow
      let_remember(elastic.get_field());
      elastic.begin_step(test_case.damping, { { 1.5, &past }, { -0.5, &before } });
      std::vector<double> weights  = test_case.per_region
                                         ? std::vector<double>{ 0.2, 0.5, 0.3, 0.6, 0.1, 0.3 }
                                         : std::vector<double>{ 0.2, 0.5, 0.3 };
      const auto          evaluate = [&]
      {
        ElasticEvaluation evaluation;
        elastic.update_rotations(positions);
        elastic.evaluate(positions, weights, evaluation);
        return evaluation;
      };
      const auto energy = [](const ElasticEvaluation &e) { return e.energy + e.energy_damping; };
      const ElasticEvaluation at = evaluate();
      EXPECT_EQ(at.guarded_cells,
                test_case.is_guarded && has_guard(test_case.laws) ? body.fe_space.n_cells() : 0);
      std::vector<double> matrix(elastic.matrix_pattern.n_values()), columns;
      elastic.assemble_tangent(Tangent::exact, positions, weights, matrix, columns);
      const double scale = at.gradient.linfty_norm(), of_matrix = max_magnitude(matrix),
                   of_columns = max_magnitude(columns);
      for (unsigned int j = 0; j < free_dofs.size(); ++j)
      {
        const unsigned int dof    = free_dofs.list()[j];
        const auto         around = stencil_of(positions[dof], evaluate);
        EXPECT_NEAR(at.gradient[dof], around.derivative(energy), 1e-7 * scale);
        const Vector column = around.derivative_of_gradient();
        for (unsigned int i = 0; i < free_dofs.size(); ++i)
          EXPECT_NEAR(entry(elastic.matrix_pattern, matrix, i, j), column[free_dofs.list()[i]],
                      1e-7 * of_matrix);
        for (unsigned int k = 0; k < weights.size(); ++k)
          EXPECT_NEAR(
              -coupling(*examples.poses, columns, k, j),
              around.derivative([k](const ElasticEvaluation &e) { return e.weight_gradient[k]; }),
              1e-7 * of_columns);
      }
      // the weights' gradient by its linear form and by differences
      elastic.update_rotations(positions);
      const auto c = elastic.weight_linear_term(positions);
      for (unsigned int k = 0; k < weights.size(); ++k)
      {
        double expected = -c[k];
        for (unsigned int m = 0; m < weights.size(); ++m)
          expected += examples.weights->weight_form().H(k, m) * weights[m];
        EXPECT_NEAR(at.weight_gradient[k], expected, 1e-10 * at.weight_scale);
        const double value = weights[k];
        weights[k]         = value + 1e-3;
        const double above = energy(evaluate());
        weights[k]         = value - 1e-3;
        const double below = energy(evaluate());
        weights[k]         = value;
        EXPECT_NEAR(at.weight_gradient[k], (above - below) / 2e-3, 1e-8 * at.weight_scale);
      }
    }

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesInEveryModel)
    {
      for (const CellLaw strain : strains_of(GetParam()))
        expect_derivatives({ GetParam(), strain, false, 0. });
    }

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesWithDamping)
    {
      for (const CellLaw strain : strains_of(GetParam()))
        expect_derivatives({ GetParam(), strain, false, 0.7 });
    }

    constexpr CellLaw laws_with_grain[]
        = { CellLaw::fibrous, CellLaw::anisotropic, CellLaw::fibrous_plastic };

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesWithGrainAndYield)
    {
      for (const CellLaw law :
           { CellLaw::fibrous, CellLaw::anisotropic, CellLaw::plastic, CellLaw::fibrous_plastic })
        for (const double damping : { 0., 0.7 })
          expect_derivatives({ GetParam(), law, false, damping });
    }

    // The guard (16) changes with the stretch, and has a part in all of a law's second derivatives.
    TEST_P(ElasticPotentialTest, TangentsAreDerivativesInGuardedCells)
    {
      for (const CellLaw law : all_laws())
        if (traits_of(law).has_guard)
          expect_derivatives({ GetParam(), law, false, 0.7, true });
    }

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesWithANeoHookeanBackground)
    {
      for (const double damping : { 0., 0.7 })
        expect_derivatives({ GetParam(), CellLaw::neo_hookean, false, damping });
    }

    TEST_P(ElasticPotentialTest, AFreeBodyOfOtherLawsFeelsNoTorque)
    {
      std::vector<CellLaw> laws(std::begin(laws_with_grain), std::end(laws_with_grain));
      laws.push_back(CellLaw::neo_hookean);
      for (const CellLaw law : laws)
      {
        Body body(bar_of_two_regions(2., box_mesh(4., 4, 1)), GetParam().element,
                  material_of_law(law));
        if (GetParam().has_patches)
          body.make_patches();
        const auto     examples = body.examples(two_examples(), law);
        const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
        BodyPotential  elastic(body, LawsOfCells(law), examples, free_dofs);
        elastic.get_field().get_batches().set_step_size(std::numeric_limits<double>::infinity());
        std::mt19937 generator(9);
        const Vector positions = body.random_positions(generator, 0.1);
        const Vector force     = elastic.evaluate_at(positions, { 0.2, 0.5, 0.3 }).gradient;
        double       torque[3] = {}, scale = 0.;
        for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
          for (unsigned int i = 0; i < 3; ++i)
          {
            const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
            torque[i] += positions[3 * node + j] * force[3 * node + k]
                         - positions[3 * node + k] * force[3 * node + j];
            scale += std::abs(positions[3 * node + j] * force[3 * node + k]);
          }
        for (const double component : torque)
          EXPECT_NEAR(component, 0., 1e-12 * scale);
      }
    }

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesWithWeightsPerRegion)
    {
      expect_derivatives({ GetParam(), CellLaw::corotational, true, 0. });
      expect_derivatives({ GetParam(), strains_of(GetParam()).back(), true, 0.7 });
    }

    /// Neighbours of all laws, so that every batch of the loops has some of each.
    LawsOfCells
    alternating_laws(const Discretisation &discretisation, const unsigned int n_cells)
    {
      const std::vector<CellLaw> strains = strains_of(discretisation);
      std::vector<CellLaw>       laws;
      for (unsigned int cell = 0; cell < n_cells; ++cell)
        laws.push_back(strains[cell % strains.size()]);
      return LawsOfCells(laws);
    }

    TEST_P(ElasticPotentialTest, TangentsAreDerivativesWithSeveralLaws)
    {
      const LawsOfCells laws = alternating_laws(GetParam(), 24);
      expect_derivatives({ GetParam(), laws, false, 0. });
      expect_derivatives({ GetParam(), laws, true, 0.7 });
    }

    TEST_P(ElasticPotentialTest, EachCellHasTheResultsOfItsLaw)
    {
      const ParametricBody body;
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const LawsOfCells    laws = alternating_laws(GetParam(), body.fe_space.n_cells());
      std::mt19937         generator(9);
      const auto           positions = body.random_positions(generator, 0.2);
      const auto           evaluate  = [&](const LawsOfCells &some_laws, double &energy)
      {
        BodyPotential     elastic(body, some_laws, {}, free_dofs);
        ElasticEvaluation evaluation;
        elastic.evaluate(positions, {}, evaluation, RotationUse::update);
        energy = evaluation.energy_elastic;
        return elastic.cell_results(positions, {});
      };
      double            energy = 0., of_one = 0., sum = 0.;
      const CellResults mixed = evaluate(laws, energy);
      for (const CellLaw law : laws.present())
      {
        const CellResults alone = evaluate(law, of_one);
        for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
          if (laws[cell] == law)
          {
            EXPECT_DOUBLE_EQ(mixed.det_F[cell], alone.det_F[cell]);
            // of patches the means are those of several laws
            const double density = mixed.strain_energy_density[cell];
            if (!GetParam().has_patches)
            {
              EXPECT_NEAR(density, alone.strain_energy_density[cell], 1e-12 * density);
            }
            sum += body.fe_space.cell_volume(cell) * density;
          }
      }
      EXPECT_NEAR(sum, energy, 1e-12 * energy);
    }

    /// A body drawn along x and thinned across.
    Vector
    drawn(const Body &body, const double length, const double thickness)
    {
      std::mt19937 generator(8);
      Vector       positions = body.random_positions(generator, 0.02);
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] *= dof % 3 == 0 ? length : thickness;
      return positions;
    }

    // Where Eq. (26) passes from patches to cells, and where the guard of Eq. (24) acts.
    TEST_P(ElasticPotentialTest, TangentsAreDerivativesInStretchedCells)
    {
      const ParametricBody body;
      const Examples       none;
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), { 0, 4, 8, 30 }, Exchange::serial());
      BodyPotential        elastic(body, ModelParameters(), none, free_dofs);
      // long cells, a patch that pulls, both, and beyond
      for (Vector positions : { drawn(body, 2.3, 0.43), drawn(body, 1.08, 1.08),
                                drawn(body, 2.3, 0.47), drawn(body, 5., 0.15) })
      {
        const auto evaluate = [&]
        {
          ElasticEvaluation evaluation;
          elastic.update_rotations(positions);
          elastic.evaluate(positions, {}, evaluation);
          return evaluation;
        };
        const ElasticEvaluation at = evaluate();
        std::vector<double>     matrix(elastic.matrix_pattern.n_values()), columns;
        elastic.assemble_tangent(Tangent::exact, positions, {}, matrix, columns);
        double scale = 0.;
        for (const double value : matrix)
          scale = std::max(scale, std::abs(value));
        for (unsigned int j = 0; j < free_dofs.size(); ++j)
        {
          const unsigned int dof    = free_dofs.list()[j];
          const auto         around = stencil_of(positions[dof], evaluate);
          EXPECT_NEAR(at.gradient[dof],
                      around.derivative([](const ElasticEvaluation &e) { return e.energy; }),
                      1e-7 * at.gradient.linfty_norm());
          const Vector column = around.derivative_of_gradient();
          for (unsigned int i = 0; i < free_dofs.size(); ++i)
            EXPECT_NEAR(entry(elastic.matrix_pattern, matrix, i, j), column[free_dofs.list()[i]],
                        1e-7 * scale);
        }
      }
    }

    // Eq. (26) with beta = 1.
    TEST_P(ElasticPotentialTest, StronglyStretchedPatchesHaveTheEnergyOfCells)
    {
      const Discretisation discretisation = GetParam();
      const ParametricBody body;
      const Body     of_cells(box_mesh(4., 4, 1), MaterialParameters(), discretisation.element);
      const Examples none;
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), none, free_dofs),
          cellwise(of_cells, ModelParameters(), none, free_dofs);
      const Vector      positions = drawn(body, 5., 0.3); // no cell is thin
      ElasticEvaluation evaluation, expected;
      elastic.update_rotations(positions);
      elastic.evaluate(positions, {}, evaluation);
      cellwise.update_rotations(positions);
      cellwise.evaluate(positions, {}, expected);
      EXPECT_NEAR(evaluation.energy, expected.energy, 1e-12 * expected.energy);
      EXPECT_NEAR(evaluation.energy_elastic, expected.energy_elastic, 1e-12 * expected.energy);
      evaluation.gradient -= expected.gradient;
      EXPECT_LT(evaluation.gradient.linfty_norm(), 1e-11 * expected.gradient.linfty_norm());
    }

    // The bound of Eq. (26) knows the poses.
    TEST_P(ElasticPotentialTest, AStretchedExampleIsFreeOfForceAtFullImportance)
    {
      const ParametricBody body;
      ExampleParameters    parameters;
      parameters.pose_functions    = "x*(1.2+0.1*x); 1.6*y; 1.5*z";
      parameters.importance        = 1.;
      parameters.include_rest_pose = false;
      parameters.weight_penalty    = "0";
      const auto     examples      = body.examples(parameters);
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), examples, free_dofs);
      const Vector  &pose = examples.poses->pose(0);
      elastic.update_rotations(pose);
      ElasticEvaluation evaluation;
      elastic.evaluate(pose, { 1. }, evaluation);
      EXPECT_LT(evaluation.gradient.linfty_norm(), 1e-12 * evaluation.force_scale.linfty_norm());
      EXPECT_LT(evaluation.energy, 1e-12 * evaluation.energy_elastic);
    }

    TEST_P(ElasticPotentialTest, ResponseBesideHeldNodesIsTheDerivativeByThem)
    {
      for (const CellLaw strain : strains_of(GetParam()))
      {
        const ParametricBody body;
        const auto           examples = body.examples(two_examples(), strain);
        const FreeDofs       free_dofs(body.fe_space.n_dofs(), { 0, 4, 8, 30 }, Exchange::serial());
        ModelParameters      model;
        model.strain = strain;
        BodyPotential             elastic(body, model, examples, free_dofs);
        std::mt19937              generator(5);
        auto                      positions = body.random_positions(generator, 0.05);
        const std::vector<double> weights   = { 0.2, 0.5, 0.3 };
        dealii::Vector<double>    displacement(positions.size());
        for (const unsigned int dof : { 0, 4, 8, 30 })
          displacement[dof] = 0.1 + 0.01 * dof;
        const auto evaluate_at = [&](const double h)
        {
          ElasticEvaluation      evaluation;
          dealii::Vector<double> moved = positions;
          moved.add(h, displacement);
          elastic.update_rotations(moved);
          elastic.evaluate(moved, weights, evaluation);
          return evaluation;
        };
        const Stencil           around(evaluate_at);
        const ElasticEvaluation at     = evaluate_at(0.);
        ElasticEvaluation       change = at;
        elastic.add_response(Tangent::exact, displacement, positions, weights, change);
        const Vector difference = around.derivative_of_gradient();
        const double scale      = difference.linfty_norm();
        for (unsigned int dof = 0; dof < positions.size(); ++dof)
          EXPECT_NEAR(change.gradient[dof] - at.gradient[dof], difference[dof], 1e-7 * scale);
        for (unsigned int k = 0; k < weights.size(); ++k)
          EXPECT_NEAR(
              change.weight_gradient[k] - at.weight_gradient[k],
              around.derivative([k](const ElasticEvaluation &e) { return e.weight_gradient[k]; }),
              1e-7 * scale);
      }
    }

    TEST_P(ElasticPotentialTest, ForcesOfABodySumToZero)
    {
      const ParametricBody body;
      const auto           examples = body.examples(two_examples());
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential        elastic(body, frozen_model(), examples, free_dofs);
      std::mt19937         generator(3);
      const auto           positions = body.random_positions(generator, 0.2);
      elastic.update_rotations(positions);
      ElasticEvaluation evaluation;
      elastic.evaluate(positions, { 0.2, 0.5, 0.3 }, evaluation);
      for (unsigned int c = 0; c < 3; ++c)
      {
        double sum = 0.;
        for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
          sum += evaluation.gradient[3 * node + c];
        EXPECT_NEAR(sum, 0., 1e-12 * evaluation.force_scale.l1_norm());
      }
    }

    // In cells that are stretched far the guard of Eq. (24) is part of both.
    TEST_P(ElasticPotentialTest, TheDensitiesOfCellsSumToTheElasticEnergy)
    {
      const ParametricBody body;
      const Examples       none;
      const FreeDofs       free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential        elastic(body, ModelParameters(), none, free_dofs);
      std::mt19937         generator(6);
      auto                 positions = body.random_positions(generator, 0.1);
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] *= dof % 3 == 0 ? 10. : 0.1;
      elastic.update_rotations(positions);
      ElasticEvaluation evaluation;
      elastic.evaluate(positions, {}, evaluation);
      const CellResults results = elastic.cell_results(positions, {});
      double            sum     = 0.;
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        sum += body.fe_space.cell_volume(cell) * results.strain_energy_density[cell];
      EXPECT_NEAR(sum / evaluation.energy_elastic, 1., 1e-12);
    }

    TEST_P(ElasticPotentialTest, ARigidMotionOfAnExampleIsFreeOfForceAtFullImportance)
    {
      const ParametricBody body;
      ExampleParameters    parameters = two_examples();
      parameters.importance           = 1.;
      parameters.weight_penalty       = "0";
      const auto            examples  = body.examples(parameters);
      const FreeDofs        free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential         elastic(body, frozen_model(), examples, free_dofs);
      const Matrix3<double> Q         = rotation_about({ { 1., 1., 0. } }, 2.);
      auto                  positions = examples->pose(1);
      for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
      {
        const Vector3<double> x
            = { { positions[3 * node], positions[3 * node + 1], positions[3 * node + 2] } };
        const Vector3<double> turned = Q * x;
        for (int c = 0; c < 3; ++c)
          positions[3 * node + c] = turned[c] + 5.;
      }
      elastic.update_rotations(positions);
      ElasticEvaluation evaluation;
      elastic.evaluate(positions, { 0., 1., 0. }, evaluation);
      EXPECT_LT(evaluation.gradient.linfty_norm(), 1e-12 * evaluation.force_scale.linfty_norm());
      for (const double derivative : evaluation.weight_gradient)
        EXPECT_NEAR(derivative, 0., 1e-12 * evaluation.weight_scale);
    }

    Vector
    stretched(const Body &body, const double along_x, const double along_z)
    {
      Vector positions = body.fe_space.rest_positions();
      for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
      {
        positions[3 * node] *= along_x;
        positions[3 * node + 2] *= along_z;
      }
      return positions;
    }

    // Without a Poisson's ratio the stress of a bar pulled by e is E e, of which a cell has A E e / 3 at the node across a
    // face of the area A = 3 V |grad phi|.
    TEST(ForceScale, IsTheSumOfWhatCellsHaveAtANode)
    {
      constexpr double   e = 0.1;
      MaterialParameters material;
      material.everywhere.poissons_ratio = 0.;
      const Body              body(box_mesh(4., 4, 1), material);
      const FreeDofs          free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const auto              examples = body.examples(ExampleParameters());
      BodyPotential           elastic(body, ModelParameters(), examples, free_dofs);
      const ElasticEvaluation evaluation = elastic.evaluate_at(stretched(body, 1. + e, 1.));
      std::vector<double>     expected(body.fe_space.n_nodes());
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        for (unsigned int a = 0; a < 4; ++a)
        {
          const Vector3<double> &g = body.fe_space.gradients(cell)[a];
          expected[body.fe_space.nodes(cell)[a]] += body.fe_space.volume(cell)
                                                    * material.everywhere.youngs_modulus * e
                                                    * std::sqrt(dot(g, g));
        }
      for (unsigned int node = 0; node < expected.size(); ++node)
        EXPECT_NEAR(evaluation.force_scale[node], expected[node], 1e-9 * expected[node]);
    }

    // The guard of Eq. (16) acts in cells that are badly inverted, not in all that are.
    TEST(Guard, CountsOtherCellsThanInversion)
    {
      const Body     body;
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const auto     examples = body.examples(two_examples());
      BodyPotential  elastic(body, ModelParameters(), examples, free_dofs);
      const auto     at = [&](const double along_z) {
        return elastic.evaluate_at(stretched(body, 1., along_z), { 0., 0.5, 0.5 });
      };
      const unsigned int n = body.fe_space.n_cells();
      EXPECT_EQ(at(-0.01).inverted_cells, n);
      EXPECT_EQ(at(-0.01).guarded_cells, 0u);
      EXPECT_EQ(at(-1.).inverted_cells, n);
      EXPECT_EQ(at(-1.).guarded_cells, n);
    }

    // A bar whose stretch grows along x is least stretched at its end. Only x changes, so that det F is the change of x along x.
    TEST(MinDetF, IsThatOfTheLeastStretchedCell)
    {
      const Body     body;
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      const auto     examples = body.examples(ExampleParameters());
      BodyPotential  elastic(body, ModelParameters(), examples, free_dofs);
      Vector         positions = body.fe_space.rest_positions();
      for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
        positions[3 * node] *= 1. + 0.1 * positions[3 * node];
      double least = 2.;
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
      {
        double stretch = 0.;
        for (unsigned int a = 0; a < 4; ++a)
          stretch
              += positions[3 * body.fe_space.nodes(cell)[a]] * body.fe_space.gradients(cell)[a][0];
        least = std::min(least, stretch);
      }
      EXPECT_LT(least, 1.3); // the greatest is 1.7
      EXPECT_NEAR(elastic.evaluate_at(positions).min_det_F, least, 1e-12);
    }
  } // namespace
} // namespace Exemplar::Testing
