// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/closest_features.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    SpaceVector3
    vector(const double x, const double y, const double z)
    {
      SpaceVector3 result;
      result[0] = x;
      result[1] = y;
      result[2] = z;
      return result;
    }

    /// Random places; flat ones are nearly in a plane, on a line or in a point.
    class Places
    {
    public:
      SpaceVector3
      operator()()
      {
        const double flat = std::pow(10., -uniform(generator) * 4.);
        return vector(normal(generator), normal(generator), flat * normal(generator));
      }

    private:
      std::mt19937                           generator{ 5 };
      std::normal_distribution<double>       normal;
      std::uniform_real_distribution<double> uniform{ 0., 1. };
    };

    /// The least of a convex function on [0, 1] by thirds.
    template <typename Function>
    double
    least(const Function &f)
    {
      double low = 0., high = 1.;
      for (unsigned int i = 0; i < 100; ++i)
      {
        const double a = low + (high - low) / 3., b = high - (high - low) / 3.;
        (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
      }
      return f(0.5 * (low + high));
    }

    void
    expect_sums(const Nearest &at)
    {
      EXPECT_NEAR(at.a[0] + at.a[1] + at.a[2], 1., 1e-12);
      EXPECT_NEAR(at.b[0] + at.b[1] + at.b[2], 1., 1e-12);
      for (const double share : { at.a[0], at.a[1], at.a[2], at.b[0], at.b[1] })
        EXPECT_GE(share, -1e-15);
    }
  } // namespace

  TEST(ClosestFeatures, TriangleAndPointAreThoseOfASearch)
  {
    Places place;
    for (unsigned int n = 0; n < 200; ++n)
    {
      const std::array<SpaceVector3, 3> x{ { place(), place(), place() } };
      const SpaceVector3                p        = place();
      const Nearest                     at       = nearest(x, p);
      const double                      expected = least(
          [&](const double s)
          {
            return least([&](const double t)
                         { return (x[0] + s * (x[1] - x[0] + t * (x[2] - x[1])) - p).norm(); });
          });
      EXPECT_NEAR(at.way.norm(), expected, 1e-7) << n;
      expect_sums(at);
      EXPECT_NEAR((at.a[0] * x[0] + at.a[1] * x[1] + at.a[2] * x[2] - p - at.way).norm(), 0.,
                  1e-12);
    }
  }

  TEST(ClosestFeatures, EdgesAreThoseOfASearch)
  {
    Places place;
    for (unsigned int n = 0; n < 200; ++n)
    {
      std::array<SpaceVector3, 2> x{ { place(), place() } }, q{ { place(), place() } };
      if (n % 5 == 0) // parallel
        q[1] = q[0] + (n % 2 == 0 ? 0.7 : -2.) * (x[1] - x[0]);
      const Nearest at       = nearest(x, q);
      const double  expected = least(
          [&](const double s)
          {
            return least([&](const double t)
                         { return (x[0] + s * (x[1] - x[0]) - q[0] - t * (q[1] - q[0])).norm(); });
          });
      EXPECT_NEAR(at.way.norm(), expected, 1e-7) << n;
      expect_sums(at);
    }
  }

  namespace
  {
    __extension__ typedef __float128 Quad; // 34 digits

    /// The least distance of x0 + s e + t f from the origin, s and t within [0, 1] and, in a triangle, s + t <= 1: the best of
    /// the inner point and of those on the rims, in 34 digits.
    double
    least_distance(const SpaceVector3 &x0,
                   const SpaceVector3 &e,
                   const SpaceVector3 &f,
                   const bool          is_triangle)
    {
      const auto dot = [](const SpaceVector3 &a, const SpaceVector3 &b)
      {
        Quad sum = 0;
        for (unsigned int c = 0; c < 3; ++c)
          sum += Quad(a[c]) * Quad(b[c]);
        return sum;
      };
      const Quad ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), xe = dot(x0, e), xf = dot(x0, f);
      Quad       least = dot(x0, x0);
      const auto offer = [&](const Quad s, const Quad t)
      {
        if (!(s >= 0 && t >= 0 && s <= 1 && t <= 1 && (!is_triangle || s + t <= 1)))
          return;
        Quad square = 0;
        for (unsigned int c = 0; c < 3; ++c)
        {
          const Quad x = Quad(x0[c]) + s * Quad(e[c]) + t * Quad(f[c]);
          square += x * x;
        }
        if (square < least)
          least = square;
      };
      for (const Quad end : { Quad(0), Quad(1) })
      {
        offer(end, 0);
        offer(end, 1);
        if (ff > 0)
          offer(end, -(xf + end * ef) / ff);
        if (ee > 0)
          offer(-(xe + end * ef) / ee, end);
      }
      offer(0, 1);
      if (const Quad across = ee - 2 * ef + ff; is_triangle && across > 0)
      {
        const Quad t = (ee + xe - ef - xf) / across; // along the side from e to f
        offer(1 - t, t);
      }
      if (const Quad determinant = ee * ff - ef * ef; determinant > 0)
        offer((ef * xf - ff * xe) / determinant, (ef * xe - ee * xf) / determinant);
      return std::sqrt(static_cast<double>(least));
    }
  } // namespace

  TEST(ClosestFeatures, DistancesHaveTwelveDigits)
  {
    Places place;
    for (unsigned int n = 0; n < 20000; ++n)
    {
      // sides that are almost parallel, in steps of ten to 1e-11
      const double                      thin = std::pow(10., -static_cast<double>(n % 12));
      const SpaceVector3                a = place(), b = place(), p = place(), q = place();
      const std::array<SpaceVector3, 3> triangle{ { a, b, a + 0.4 * (b - a) + thin * q } };
      EXPECT_NEAR(nearest(triangle, p).way.norm(),
                  least_distance(a - p, b - a, triangle[2] - a, true), 1e-12)
          << n;
      const std::array<SpaceVector3, 2> edge{ { a, b } }, other{ { p, p + (b - a) + thin * q } };
      EXPECT_NEAR(nearest(edge, other).way.norm(),
                  least_distance(a - p, b - a, p - other[1], false), 1e-12)
          << n;
    }
  }

  TEST(ClosestFeatures, FlatTrianglesAreTheirEdges)
  {
    const SpaceVector3 o;
    const Nearest      at
        = nearest({ { o, vector(1., 0., 0.), vector(3., 0., 0.) } }, vector(2., 1., 0.));
    EXPECT_DOUBLE_EQ(at.way.norm(), 1.);
    EXPECT_DOUBLE_EQ(nearest({ { o, o, o } }, vector(0., 0., 2.)).way.norm(), 2.);
  }

  TEST(ClosestFeatures, EdgesPassThroughTrianglesOrDoNot)
  {
    const std::array<SpaceVector3, 3> x{ { vector(0., 0., 0.), vector(1., 0., 0.),
                                           vector(0., 1., 0.) } };
    EXPECT_TRUE(passes_through({ { vector(.2, .2, -1.), vector(.3, .3, 1.) } }, x));
    EXPECT_TRUE(passes_through({ { vector(.2, .2, 1.), vector(.3, .3, -1.) } }, x));
    EXPECT_FALSE(passes_through({ { vector(.2, .2, .1), vector(.3, .3, 1.) } }, x));
    EXPECT_FALSE(passes_through({ { vector(.8, .8, -1.), vector(.8, .8, 1.) } }, x));
    EXPECT_TRUE(passes_through({ { vector(.5, .5, -1.), vector(.5, .5, 1.) } }, x)) << "a rim";
  }

  TEST(ClosestFeatures, NoEdgePassesThroughATriangleOfItsPlaneHoweverThatIsTurned)
  {
    Places place;
    for (unsigned int round = 0; round < 2000; ++round)
    {
      const SpaceVector3 o = place(), e = place(), f = place();
      const auto         at = [&](const double s, const double t) { return o + s * e + t * f; };
      const std::array<SpaceVector3, 3> x{ { at(0., 0.), at(1., 0.), at(0., 1.) } };
      EXPECT_FALSE(passes_through({ { at(1.1, 0.), at(0., 1.1) } }, x));
      EXPECT_FALSE(passes_through({ { at(2., 0.1), at(2., 1.1) } }, x));
      EXPECT_FALSE(passes_through({ { at(-0.1, 0.3), at(0.9, 0.3) } }, x));
    }
  }

  TEST(BoxTree, FindsWhatASearchFinds)
  {
    Places               place;
    std::vector<AxisBox> boxes(300);
    for (AxisBox &box : boxes)
    {
      const SpaceVector3 middle = place();
      box.add(middle);
      box.add(middle + 0.2 * place());
    }
    BoxTree tree(boxes);
    for (unsigned int round = 0; round < 2; ++round)
    {
      for (unsigned int n = 0; n < 100; ++n)
      {
        AxisBox asked;
        asked.add(place());
        asked = asked.widened(0.3);
        std::set<unsigned int> found, expected;
        tree.visit(asked, [&](const unsigned int i) { EXPECT_TRUE(found.insert(i).second); });
        for (unsigned int i = 0; i < boxes.size(); ++i)
          if (boxes[i].meets(asked))
            expected.insert(i);
        EXPECT_EQ(found, expected);
      }
      for (AxisBox &box : boxes)
        box = box.widened(0.1);
      tree.move(boxes);
    }
  }

  TEST(BoxTree, FindsEachPairOnce)
  {
    Places     place;
    const auto make = [&](const unsigned int n, const double size)
    {
      std::vector<AxisBox> boxes(n);
      for (AxisBox &box : boxes)
      {
        const SpaceVector3 middle = place();
        box.add(middle);
        box.add(middle + size * place());
      }
      return boxes;
    };
    using Pairs                     = std::multiset<std::pair<unsigned int, unsigned int>>;
    const std::vector<AxisBox> some = make(300, 0.2), others = make(170, 0.4);
    const BoxTree              tree(some), other(others);
    Pairs                      found, expected, found_in_one, expected_in_one;
    tree.visit_pairs(other,
                     [&](const unsigned int i, const unsigned int j) { found.emplace(i, j); });
    tree.visit_pairs(tree, [&](const unsigned int i, const unsigned int j)
                     { found_in_one.emplace(std::min(i, j), std::max(i, j)); });
    for (unsigned int i = 0; i < some.size(); ++i)
    {
      for (unsigned int j = 0; j < others.size(); ++j)
        if (some[i].meets(others[j]))
          expected.emplace(i, j);
      for (unsigned int j = i + 1; j < some.size(); ++j)
        if (some[i].meets(some[j]))
          expected_in_one.emplace(i, j);
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found_in_one, expected_in_one);
    BoxTree().visit_pairs(tree, [](unsigned int, unsigned int) { FAIL(); });
  }
} // namespace Exemplar::Testing
