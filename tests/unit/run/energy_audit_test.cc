// SPDX-License-Identifier: GPL-3.0-or-later
#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    EnergyStep
    at_step(const unsigned int step,
            const double       stored,
            const double       work,
            const double       doubt = 0.)
    {
      EnergyStep at;
      at.step   = step;
      at.stored = at.size = stored;
      at.work             = work;
      at.doubt            = doubt;
      return at;
    }

    EnergyStep
    moving(const unsigned int step, const double stored, const double kinetic, const double work)
    {
      EnergyStep at = at_step(step, stored, work);
      at.kinetic    = kinetic;
      at.size += kinetic;
      return at;
    }

    TEST(EnergyAudit, DeadLoadsPayForTwiceTheEnergyOfALinearBody)
    {
      EnergyBalance balance(false);
      balance.begin(at_step(0, 0., 0.));
      EXPECT_FALSE(balance.add(at_step(1, 3., 6.)));
      EXPECT_FALSE(balance.add(at_step(2, 3., 0.)));
    }

    TEST(EnergyAudit, EnergyWithoutWorkIsAFailure)
    {
      EnergyBalance balance(false);
      balance.begin(at_step(0, 10., 0.));
      EXPECT_FALSE(balance.add(at_step(1, 10.009, 0.)));
      const auto excess = balance.add(at_step(2, 10.012, 0.));
      ASSERT_TRUE(excess);
      EXPECT_EQ(excess->since, 0u);
      EXPECT_DOUBLE_EQ(excess->grown, 10.012 - 10.);
      EXPECT_EQ(excess->work, 0.);
      EXPECT_FALSE(balance.add(at_step(2, 10.01, 0.))); // a failure has changed nothing
    }

    TEST(EnergyAudit, LostEnergyPaysForNothing)
    {
      EnergyBalance balance(false);
      balance.begin(at_step(0, 10., 0.));
      EXPECT_FALSE(balance.add(at_step(1, 4., 0.)));
      EXPECT_FALSE(balance.add(at_step(2, 3., -0.5)));
      const auto excess = balance.add(at_step(3, 6., 0.25));
      ASSERT_TRUE(excess);
      EXPECT_EQ(excess->since, 2u);
      EXPECT_DOUBLE_EQ(excess->grown, 3.);
      EXPECT_DOUBLE_EQ(excess->work, 0.25);
    }

    TEST(EnergyAudit, WorkThatIsNotKnownIsAllowed)
    {
      EnergyBalance balance(false);
      balance.begin(at_step(0, 0., 0.));
      EXPECT_FALSE(balance.add(at_step(1, 3., 2., 0.9995)));
      EXPECT_TRUE(balance.add(at_step(2, 4., 0., 0.99)));
      EXPECT_FALSE(balance.add(at_step(2, 4., 0., 0.9995)));
    }

    TEST(EnergyAudit, AStepOfDynamicsMayUseItsKineticEnergy)
    {
      EnergyBalance balance(true);
      balance.begin(moving(0, 1., 9., 0.));
      EXPECT_FALSE(balance.add(moving(1, 10., 0., 0.)));
      EXPECT_FALSE(balance.gain());
      EXPECT_FALSE(balance.add(moving(2, 10.005, 0.02, 0.))); // 0.25 %
      EXPECT_FALSE(balance.gain());
      EXPECT_FALSE(balance.add(moving(3, 10., 0.06, 0.))); // 0.6 %
      ASSERT_TRUE(balance.gain());
      EXPECT_EQ(balance.gain()->since, 1u);
      EXPECT_EQ(balance.gain()->until, 3u);
      EXPECT_NEAR(balance.gain()->energy, 0.06, 1e-12);
      const auto excess = balance.add(moving(4, 10.1, 0., 0.02));
      ASSERT_TRUE(excess);
      EXPECT_DOUBLE_EQ(excess->grown, 10.1);
      EXPECT_DOUBLE_EQ(excess->work, 10.08);
    }

    /// A slow press with a force that rises to 1 and falls again at the rate of 1, by steps of 0.4 around its greatest value at 1:
    /// the work of the third step is 0.36, and that of both rules 0.32.
    TEST(EnergyAudit, AForceMayBeGreatestWithinAStep)
    {
      const auto energy
          = [](const double u) { return u < 1. ? u * u / 2. : 1. - (2. - u) * (2. - u) / 2.; };
      const auto    force = [](const double u) { return u < 1. ? u : 2. - u; };
      EnergyBalance balance(true);
      balance.begin(moving(0, 0., 0., 0.));
      for (unsigned int step = 1; step < 5; ++step)
      {
        const double u = 0.4 * step, before = 0.4 * (step - 1);
        EnergyStep   at = moving(step, energy(u), 0., 0.2 * (force(u) + force(before)));
        at.doubt        = 0.2 * std::abs(force(u) - force(before));
        if (step == 3)
        {
          EXPECT_NEAR(energy(u) - energy(before), 0.36, 1e-12);
          EXPECT_NEAR(at.work + at.doubt, 0.32, 1e-12);
        }
        EXPECT_FALSE(balance.add(at)) << step;
      }
      EXPECT_FALSE(balance.gain());
    }

    /// An energy [J] from a time on that nothing pays for.
    class Gift : public PotentialTerm
    {
    public:
      Gift(const double energy, const double from) : energy(energy), from(from) {}

      std::string
      name() const override
      {
        return "gift";
      }

      std::optional<EnergyFlow>
      energy_flow(const State & /*start*/, const State & /*end*/) const override
      {
        return EnergyFlow();
      }

      void
      set_time(const double new_time) override
      {
        time = new_time;
      }

      void
      add(const TermPoint & /*at*/, ElasticSums &sums) override
      {
        sums->energy += time > from ? energy : 0.;
      }

      std::size_t
      memory_consumption() const override
      {
        return sizeof(*this);
      }

    private:
      const double energy, from;
      double       time = 0.;
    };

    std::string
    dragged(const std::string &kind)
    {
      return "set Scene = " + kind + "\n" + bar + drag
             + "subsection Time\n set Increments = 8\n set Step = 0.05\n set End = 0.4\nend\n"
               "subsection Solver\n set Method = newton\nend\n";
    }

    /// The failure of a run that gets a gift at half of the time, and the last step that it made.
    std::pair<std::string, unsigned int>
    failure_with_gift(const double energy, const std::string &kind)
    {
      Scene scene(dragged(kind));
      scene.problem.add_term(
          [=] { return std::make_unique<Gift>(energy, kind == "static" ? .5 : .2); });
      SolveReport report;
      for (unsigned int step = 0; step < 8 && (step == 0 || is_success(report.status)); ++step)
        report = scene.problem.advance();
      return { report.failure, scene.problem.state.step };
    }

    TEST(EnergyAudit, AStepThatIsGivenEnergyFails)
    {
      for (const std::string kind : { "static", "dynamic" })
      {
        EXPECT_EQ(failure_with_gift(1., kind), std::make_pair(std::string(), 8u)) << kind;
        const auto [failure, last_step] = failure_with_gift(1e6, kind);
        expect_contains(failure, "the stored energy ");
        expect_contains(failure, kind == "static" ? "1e+06 J" : "Take smaller steps");
        EXPECT_EQ(last_step, 4u) << kind;
      }
    }

    TEST(EnergyAudit, BeginsAgainAfterChanges)
    {
      Scene scene(dragged("static"));
      ASSERT_NE(scene.problem.get_audit(), nullptr);
      scene.problem.advance();
      EXPECT_EQ(scene.problem.get_audit()->notes(), "");
      scene.problem.set_gravity({ { 0., 0., -5. } });
      scene.problem.set_gravity({ { 0., 0., -9. } });
      EXPECT_TRUE(is_success(scene.problem.advance().status));
      expect_contains(scene.problem.get_audit()->notes(), "once, first after step 1: gravity");
    }

    TEST(EnergyAudit, NeedsEnergies)
    {
      EXPECT_EQ(Scene(dragged("static"), { "Solver/Method=one pass" }).problem.get_audit(),
                nullptr);
      EXPECT_EQ(Scene(dragged("static"), { "Model/Gradient=frozen", "Solver/Method=fixed point" })
                    .problem.get_audit(),
                nullptr);
      EXPECT_EQ(Scene(dragged("dynamic"), { "Time/Scheme=bdf2" }).problem.get_audit(), nullptr);
      EXPECT_NE(Scene(dragged("dynamic")).problem.get_audit(), nullptr);
    }
  } // namespace
} // namespace Exemplar::Testing
