// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/cell_model.h>

#include "matrices.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    using Corotational = CorotationalCell<double>;
    using Green        = GreenCell<double>;
    using Linear       = LinearCell<double>;

    const CellMaterial<double> material     = { 1.3, 0.7 };
    const ExampleConstants     examples     = { 0.8, 0.6 };
    const double               own_constant = 0.2; ///< each that a law has beside the material
    double                     remembered   = 0.;  ///< scale of what laws remember

    /// Number k of the constants of a law. A general C is I and a little of everything, so that it is
    /// positive definite; fibres come last, with their direction.
    template <typename Constants>
    double
    number_of(const std::size_t k)
    {
      if (k < CellMaterial<double>::n_numbers)
        return material.number(k);
      if constexpr (Constants::n_numbers == Anisotropic<double>::n_numbers)
        for (const std::size_t diagonal : { 3, 9, 14, 18, 21, 23 })
          if (k == diagonal)
            return 1.5;
      if constexpr (std::is_same_v<Constants, Anisotropic<double>>)
        return own_constant * std::cos(0.3 * k);
      const double fibres[] = { 1.7, 0.48, 0.6, -0.64 };
      return Constants::is_isotropic || k + 4 < Constants::n_numbers
                 ? own_constant
                 : fibres[k + 4 - Constants::n_numbers];
    }

    template <typename Cell>
    Matrix3<double>
    rotation_of(const Matrix3<double> &F)
    {
      return Cell::traits.has_rotations ? closest_rotation(F) : identity_matrix<double>();
    }

    template <typename Cell>
    Cell
    cell_at(const Matrix3<double> &F)
    {
      const auto constants = Cell::Constants::from_numbers(number_of<typename Cell::Constants>);
      Cell       cell(constants, rotation_of<Cell>(F), F, examples);
      if constexpr (Cell::traits.n_history > 0)
        cell.remember([](const std::size_t k) { return remembered * std::sin(1. + k); }, 0.5);
      return cell;
    }

    template <typename Cell>
    double
    energy(const Matrix3<double> &F, const Matrix3<double> &D)
    {
      const Cell cell = cell_at<Cell>(F);
      return cell.energy(D) + (cell.is_stretched() ? cell.stretch().energy() : 0.);
    }

    /// P.
    template <typename Cell>
    Matrix3<double>
    force(const Matrix3<double> &F, const Matrix3<double> &D)
    {
      Cell cell = cell_at<Cell>(F);
      cell.set_target(D);
      const Matrix3<double> P = cell.force();
      return rotation_of<Cell>(F)
             * (cell.is_stretched() ? combine(1., P, 1., cell.stretch().force()) : P);
    }

    template <typename Cell>
    Matrix3<double>
    response(const Matrix3<double> &F, const Matrix3<double> &D, const Matrix3<double> &dF)
    {
      const Matrix3<double> R    = rotation_of<Cell>(F);
      Cell                  cell = cell_at<Cell>(F);
      cell.set_target(D);
      return R * cell.response(transpose_times(R, dF));
    }

    Matrix3<double>
    moved(const Matrix3<double> &F, const double h, const Matrix3<double> &dF)
    {
      return combine(1., F, h, dF);
    }

    /// Fourth-order central difference of a function of h at 0.
    template <typename Function>
    double
    derivative(const Function &f, const double h)
    {
      return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
    }

    std::vector<std::pair<std::string, Matrix3<double>>>
    states()
    {
      std::mt19937          generator(5);
      const Matrix3<double> I        = identity_matrix<double>();
      const auto            diagonal = [](double a, double b, double c) {
        return Matrix3<double>{ { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
      };
      const Matrix3<double> Q      = rotation_about({ { 1., 2., -1. } }, 0.8);
      const auto            turned = [&](const Matrix3<double> &D) {
        return Q * D * rotation_about({ { 0., 1., 3. } }, 2.);
      };
      std::vector<std::pair<std::string, Matrix3<double>>> all
          = { { "rest", I },
              { "turned by 179.9 degrees",
                rotation_about({ { 3., 1., 1. } }, 179.9 * M_PI / 180.) },
              { "flat", turned(diagonal(1.3, 0.8, 0.)) },
              { "nearly flat", turned(diagonal(1.3, 0.8, 1e-7)) },
              { "inverted", turned(diagonal(1.5, 1.2, -0.4)) },
              { "inverted, guarded", turned(diagonal(1.1, 0.7, -0.5)) },
              { "inverted, guarded more", turned(diagonal(1.2, 0.5, -0.4)) },
              { "inverted, hardly guarded", turned(diagonal(1.3, 0.58, -0.2)) },
              { "compressed", turned(diagonal(0.4, 0.3, 0.2)) },
              { "line", turned(diagonal(1.2, 0.3, 0.1)) },
              { "pulled, where its guard begins", turned(diagonal(4., 0.15, 0.1)) },
              { "pulled", turned(diagonal(6., 0.2, 0.1)) },
              { "pulled, inverted", turned(diagonal(6., 0.4, -0.3)) },
              { "pulled to a line", turned(diagonal(9., 0.1, 0.)) } };
      for (int sample = 0; sample < 6; ++sample)
        all.emplace_back("random", combine(1., I, 0.4, random_matrix(generator)));
      return all;
    }

    /// Target strains: none, and one of an example.
    std::vector<Matrix3<double>>
    targets()
    {
      std::mt19937          generator(6);
      const Matrix3<double> E = symmetric_part(random_matrix(generator));
      return { Matrix3<double>{}, combine(0.3, E, 0., E) };
    }

    template <typename Cell>
    void
    expect_force_is_gradient()
    {
      std::mt19937 generator(7);
      for (const auto &state : states())
      {
        const auto            &name = state.first; // no structured binding: Clang 14 captures none
        const Matrix3<double> &F    = state.second;
        for (const Matrix3<double> &D : targets())
        {
          const Matrix3<double> P = force<Cell>(F, D);
          const double scale = std::sqrt(contract(P, P)) + material.mu * std::sqrt(contract(F, F));
          std::vector<Matrix3<double>> directions = { combine(
              1. / (std::sqrt(contract(P, P)) + 1e-300), P, 0., P) }; // along the gradient, too
          for (int sample = 0; sample < 4; ++sample)
            directions.push_back(random_matrix(generator));
          for (const Matrix3<double> &dF : directions)
          {
            const double difference = derivative(
                [&](const double h) { return energy<Cell>(moved(F, h, dF), D); }, 1e-4);
            EXPECT_NEAR(contract(P, dF), difference,
                        1e-7 * scale * (1. + std::sqrt(contract(dF, dF))))
                << name;
          }
        }
      }
    }

    template <typename Cell>
    void
    expect_tangent_is_derivative_of_force()
    {
      std::mt19937 generator(8);
      for (const auto &state : states())
      {
        const auto            &name = state.first; // no structured binding: Clang 14 captures none
        const Matrix3<double> &F    = state.second;
        for (const Matrix3<double> &D : targets())
        {
          for (int sample = 0; sample < 4; ++sample)
          {
            const Matrix3<double> dF = random_matrix(generator), dP = response<Cell>(F, D, dF);
            const double          scale = std::sqrt(contract(dP, dP)) + 1.;
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j)
                EXPECT_NEAR(dP[i][j],
                            derivative([&](const double h)
                                       { return force<Cell>(moved(F, h, dF), D)[i][j]; },
                                       1e-4),
                            1e-7 * scale)
                    << name;
          }
        }
      }
    }

    template <typename Cell>
    void
    expect_derivatives_by_target()
    {
      std::mt19937 generator(10);
      for (const auto &state : states())
      {
        const auto            &name = state.first;
        const Matrix3<double> &F    = state.second;
        const Matrix3<double>  D    = targets()[1];
        const Matrix3<double>  E    = symmetric_part(random_matrix(generator));
        Cell                   cell = cell_at<Cell>(F);
        cell.set_target(D);
        EXPECT_NEAR(
            -contract(cell.weight_stress(D), E),
            derivative([&](const double h) { return energy<Cell>(F, moved(D, h, E)); }, 1e-3), 1e-9)
            << name;
        if constexpr (!Cell::traits.exact_is_rotated)
        {
          const Matrix3<double> column = rotation_of<Cell>(F) * cell.example_response(E);
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              EXPECT_NEAR(-column[i][j],
                          derivative([&](const double h)
                                     { return force<Cell>(F, moved(D, h, E))[i][j]; },
                                     1e-3),
                          1e-9)
                  << name;
        }
      }
    }

    template <typename Cell>
    void
    expect_tangent_is_symmetric()
    {
      std::mt19937 generator(9);
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &D : targets())
        {
          const Matrix3<double> a = random_matrix(generator), b = random_matrix(generator);
          const double          ab = contract(a, response<Cell>(F, D, b)),
                       ba          = contract(b, response<Cell>(F, D, a));
          EXPECT_NEAR(ab, ba, 1e-11 * (std::abs(ab) + 10.)) << name;
        }
    }

    template <typename Cell>
    void
    expect_derivatives()
    {
      expect_force_is_gradient<Cell>();
      expect_derivatives_by_target<Cell>();
      if constexpr (!Cell::traits.exact_is_rotated)
      {
        expect_tangent_is_derivative_of_force<Cell>();
        expect_tangent_is_symmetric<Cell>();
      }
    }

    // The law that holds a rotation fixed has no energy whose gradient its force is.
    TEST(AllLaws, ForceTangentAndColumnsAreDerivatives)
    {
      for (const CellLaw law : all_laws())
        for (const double scale : { 0., 0.05 })
        {
          SCOPED_TRACE(traits_of(law).name + (" " + std::to_string(scale)));
          remembered = scale;
          with_cell_model<double>(law,
                                  [](auto model)
                                  {
                                    using Cell = typename decltype(model)::type;
                                    if constexpr (!std::is_same_v<Cell, FrozenCell<double>>)
                                      expect_derivatives<Cell>();
                                  });
        }
      remembered = 0.;
    }

    TEST(Green, ConvexTangentIsNeverNegativeTogetherWithTheWeights)
    {
      // the quadratic of (dF, dw): dF:convex(dF) - 2 dF:F(C:E) dw + E:C:E dw^2
      std::mt19937 generator(11);
      double       least_exact = 0.;
      for (const auto &[name, F] : states())
        for (int sample = 0; sample < 50; ++sample)
        {
          Green cell = cell_at<Green>(F);
          cell.set_target(targets()[1]);
          const Matrix3<double> dF = random_matrix(generator);
          const Matrix3<double> E  = symmetric_part(random_matrix(generator));
          least_exact              = std::min(least_exact, contract(dF, cell.response(dF)));
          cell.make_convex();
          EXPECT_GE(contract(dF, cell.response(dF)) - 2. * contract(dF, cell.example_response(E))
                        + contract(E, stress(material, E)),
                    -1e-12)
              << name;
        }
      EXPECT_LT(least_exact, -0.1); // else it proves nothing
    }

    template <typename Plastic>
    void
    expect_convex_where_it_flows()
    {
      // the quadratic of (dF, dw): dF:convex(dF) - 2 eta dF:C:E dw + eta E:C:E dw^2
      const auto   C = Plastic::Constants::from_numbers(number_of<typename Plastic::Constants>);
      std::mt19937 generator(12);
      const double eta      = examples.importance;
      double       softened = 0.;
      for (const auto &[name, F] : states())
        for (int sample = 0; sample < 50; ++sample)
        {
          Plastic cell = cell_at<Plastic>(F);
          cell.set_target(targets()[1]);
          cell.make_convex();
          const Matrix3<double> M       = random_matrix(generator);
          const Matrix3<double> E       = symmetric_part(random_matrix(generator));
          const double          convex  = contract(M, cell.response(M));
          const double          elastic = contract(M, stress(C, symmetric_part(M)));
          EXPECT_GE(convex - 2. * eta * contract(M, cell.example_response(E))
                        + eta * contract(E, stress(C, E)),
                    -1e-12)
              << name;
          EXPECT_LE(convex, elastic + 1e-12) << name;
          EXPECT_GE(convex, (1. - 0.9 * (1. - eta)) * elastic - 1e-12) << name;
          EXPECT_NEAR(contract(E, cell.response(M)), contract(M, cell.response(E)), 1e-12) << name;
          softened = std::max(softened, (elastic - convex) / elastic);
        }
      EXPECT_GT(softened, 0.1); // else it proves nothing
    }

    TEST(Plastic, ConvexTangentIsNeverNegativeTogetherWithTheWeightsAndSofterWhereItFlows)
    {
      expect_convex_where_it_flows<PlasticCell<double>>();
      expect_convex_where_it_flows<FibrousPlasticCell<double>>();
    }

    TEST(Green, EnergyOfUniformScaleAndOfRotation)
    {
      const double          s = 1.4, e = 0.5 * (s * s - 1.);
      const Matrix3<double> I = identity_matrix<double>();
      EXPECT_NEAR(energy<Green>(combine(s, I, 0., I), Matrix3<double>{}),
                  (3. * material.mu + 4.5 * material.lambda) * e * e, 1e-14);
      EXPECT_NEAR(energy<Green>(rotation_about({ { 1., 2., 3. } }, 2.), Matrix3<double>{}), 0.,
                  1e-15);
    }

    TEST(Linear, TakesARotationForAStrain)
    {
      // by 90 degrees about z: e = diag(-1, -1, 0)
      EXPECT_NEAR(energy<Linear>(rotation_about({ { 0., 0., 1. } }, M_PI / 2.), Matrix3<double>{}),
                  0.5 * (4. * material.lambda + 4. * material.mu), 1e-14);
    }

    /// P F^T is symmetric: angular momentum. The frozen force R T fails here.
    template <typename Cell>
    void
    expect_no_torque()
    {
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &D : targets())
        {
          const Matrix3<double> P = force<Cell>(F, D);
          Matrix3<double>       torque;
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              torque[i][j] = P[i][0] * F[j][0] + P[i][1] * F[j][1] + P[i][2] * F[j][2];
          EXPECT_LT(max_difference(torque, symmetric_part(torque)), 1e-12) << name;
        }
    }

    TEST(ConsistentForce, ExertsNoTorqueOnItsCell)
    {
      expect_no_torque<Corotational>();
      expect_no_torque<FibrousCell<double>>();
      expect_no_torque<AnisotropicCell<double>>();
      for (const double scale : { 0., 0.05 })
      {
        remembered = scale;
        expect_no_torque<FibrousPlasticCell<double>>();
      }
      remembered = 0.;
    }

    // Fibres see all of the strain, whatever of it the body between them keeps.
    TEST(FibrousPlastic, IsASumOfACellThatYieldsAndOfFibres)
    {
      const FibrousPlasticConstants<double> constants
          = { { { 1.3, 0.7 }, 0.1, 0.2, 0.3, 0., 0.9 }, 2., { { 0.6, 0.8, 0. } } };
      const Matrix3<double> F = { { { 1.4, 0.2, 0. }, { 0., 0.9, 0.1 }, { 0., 0., 0.9 } } };
      const Matrix3<double> R = closest_rotation(F), D = targets()[1];

      FibrousPlasticCell<double> both(constants, R, F, examples);
      PlasticCell<double>        plastic(constants, R, F, examples);
      FibrousCell<double>        fibres({ 0., 0., constants.alpha, constants.a }, R, F, examples);
      for (PlasticCell<double> *const cell :
           { static_cast<PlasticCell<double> *>(&both), &plastic })
        cell->remember([](const std::size_t k) { return 0.02 * k; }, 1.);
      for (std::size_t k = 0; k < PlasticCell<double>::traits.n_history; ++k)
        EXPECT_EQ(both.new_history(k), plastic.new_history(k));
      EXPECT_GT(plastic.new_history(PlasticCell<double>::traits.plastic_strain), 0.2);
      both.set_target(D);
      plastic.set_target(D);
      fibres.set_target(D);
      EXPECT_LT(max_difference(both.force(), combine(1., plastic.force(), 1., fibres.force())),
                1e-14);
      EXPECT_GT(norm(fibres.force()), 0.1);
      const double stretch = dot(constants.a, combine(1., both.strain(), -1., D) * constants.a);
      EXPECT_NEAR(both.energy(D) - plastic.energy(D), stretch * stretch, 1e-14);
    }

    // Without examples, too: the fibres' stress and S have other axes.
    TEST(Grain, TheFrozenForceWouldExertATorque)
    {
      const Matrix3<double> F = { { { 1.2, 0.3, 0. }, { 0., 0.9, 0.1 }, { 0.2, 0., 1.1 } } };
      FibrousCell<double>   cell({ 1.3, 0.7, 2., { { 0.6, 0.8, 0. } } }, closest_rotation(F), F,
                                 ExampleConstants());
      cell.set_target(Matrix3<double>{});
      const Matrix3<double> RTP = cell.force();
      EXPECT_GT(max_difference(RTP, symmetric_part(RTP)), 0.01);
    }

    template <typename Constants>
    void
    expect_convex_tangent(const Constants &C)
    {
      std::mt19937 generator(13);
      for (int sample = 0; sample < 50; ++sample)
      {
        const Matrix3<double> E = symmetric_part(random_matrix(generator));
        EXPECT_GT(contract(E, stress(C, E)), 0.);
      }
    }

    TEST(Grain, WithoutFibresItIsTheIsotropicMaterial)
    {
      std::mt19937          generator(14);
      const Matrix3<double> E = symmetric_part(random_matrix(generator));
      const Fibrous<double> none{ 1.3, 0.7, 0., { { 1., 0., 0. } } };
      EXPECT_EQ(max_difference(stress(none, E), stress(material, E)), 0.);
      const Fibrous<double> fibres{ 1.3, 0.7, 2., { { 0.6, 0., 0.8 } } };
      const double          stretch = dot(fibres.a, E * fibres.a);
      EXPECT_NEAR(contract(E, stress(fibres, E)),
                  contract(E, stress(material, E)) + 2. * stretch * stretch, 1e-14);
      expect_convex_tangent(fibres);
    }

    TEST(ConsistentForce, WithoutExampleItIsTheFrozenForce)
    {
      for (const auto &[name, F] : states())
      {
        if (cell_at<Corotational>(F).is_stretched())
          continue; // the frozen force has no guards
        const Matrix3<double> R = closest_rotation(F);
        EXPECT_LT(max_difference(force<Corotational>(F, Matrix3<double>{}),
                                 R * stress(material, corotated_strain(R, F))),
                  1e-12)
            << name;
      }
    }

    /// Around s_2 + s_3 = 0 the rotation turns through all directions.
    template <typename Cell>
    void
    expect_continuity_where_the_rotation_is_ambiguous(const Matrix3<double> &D)
    {
      for (const double angle : { 0., 0.5, 1., 2., 4. })
        for (const double r : { 1e-3, 1e-6, 1e-12, 0. })
        {
          const Matrix3<double> F = { { { 1.2, 0., 0. },
                                        { 0., 0.6 + r * std::cos(angle), r * std::sin(angle) },
                                        { 0., r * std::sin(angle), -0.6 } } };
          const Matrix3<double> P = force<Cell>(F, D);
          EXPECT_LT(std::sqrt(contract(P, P)), 20.);
          if (r < 1e-5)
          {
            const Matrix3<double> at = { { { 1.2, 0., 0. }, { 0., 0.6, 0. }, { 0., 0., -0.6 } } };
            EXPECT_NEAR(energy<Cell>(F, D), energy<Cell>(at, D), 1e-4);
          }
        }
    }

    TEST(ConsistentForce, StaysBoundedAndContinuousWhereTheRotationIsAmbiguous)
    {
      expect_continuity_where_the_rotation_is_ambiguous<Corotational>(targets()[1]);
      for (const Matrix3<double> &D : targets())
      {
        expect_continuity_where_the_rotation_is_ambiguous<FibrousCell<double>>(D);
        expect_continuity_where_the_rotation_is_ambiguous<AnisotropicCell<double>>(D);
        remembered = 0.05;
        expect_continuity_where_the_rotation_is_ambiguous<FibrousPlasticCell<double>>(D);
        remembered = 0.;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
