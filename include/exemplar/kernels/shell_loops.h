// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_loops_h
#define exemplar_shell_loops_h

#include <exemplar/kernels/hinge_angle.h>
#include <exemplar/kernels/shell_kernels.h>

// The loops of shell_kernels.h, for a number type with lanes. As loops_io.h says of its own, only files for one instruction set
// include this.

namespace Exemplar
{
  /// ShellKernels of one number type.
  template <typename Number>
  class ShellLoops
  {
  public:
    static ShellKernels
    kernels()
    {
      return { find_hinges, find_strains, blend, find_products, find_forces };
    }

  private:
    static constexpr std::size_t width = Lanes<Number>::n;

    /// So many neighbours in a batch.
    struct Group
    {
      std::size_t batch, lane;

      std::size_t
      at(const std::size_t n, const std::size_t e) const
      {
        return (batch * n + e) * batch_size + lane;
      }
    };

    template <typename Function>
    static void
    for_each_group(const std::size_t begin, const std::size_t end, const Function &function)
    {
      for (std::size_t batch = begin; batch < end; ++batch)
        for (std::size_t lane = 0; lane < batch_size; lane += width)
          function(Group{ batch, lane });
    }

    static Number
    load(const double *from, const Group &group, const std::size_t n, const std::size_t e)
    {
      return Lanes<Number>::load(from + group.at(n, e));
    }

    static void
    store(const Number     &number,
          double           *to,
          const Group      &group,
          const std::size_t n,
          const std::size_t e)
    {
      Lanes<Number>::store(number, to + group.at(n, e));
    }

    /// Numbers at these places of an array.
    static Number
    gather(const double *from, const unsigned int *places)
    {
      alignas(64) double numbers[width];
      for (std::size_t l = 0; l < width; ++l)
        numbers[l] = from[places[l]];
      return Lanes<Number>::load(numbers);
    }

    static Vector3<Number>
    place(const double *positions, const unsigned int *nodes)
    {
      alignas(64) double numbers[3][width];
      for (std::size_t l = 0; l < width; ++l)
        for (int c = 0; c < 3; ++c)
          numbers[c][l] = positions[3 * nodes[l] + c];
      Vector3<Number> result;
      for (int c = 0; c < 3; ++c)
        result[c] = Lanes<Number>::load(numbers[c]);
      return result;
    }

    static void
    find_hinges(const HingeTask &task, const std::size_t begin, const std::size_t end)
    {
      for_each_group(begin, end,
                     [&](const Group &group)
                     {
                       const unsigned int      *nodes = task.nodes;
                       const HingeAngle<Number> angle(
                           place(task.positions, nodes + group.at(4, 0)),
                           place(task.positions, nodes + group.at(4, 1)),
                           place(task.positions, nodes + group.at(4, 2)),
                           place(task.positions, nodes + group.at(4, 3)));
                       store(nearest(angle.value(), load(task.last, group, 1, 0))
                                 - load(task.rest, group, 1, 0),
                             task.changes, group, 1, 0);
                       const HingeForm<Number> form = angle.gradient();
                       for (int i = 0; i < 4; ++i)
                       {
                         for (int c = 0; c < 3; ++c)
                           store(form[i][c], task.forms, group, 12, 3 * i + c);
                         store(norm(form[i]), task.lengths, group, 4, i);
                       }
                     });
    }

    static TriangleShape<Number>
    shape(const TriangleTask &task, const Group &group)
    {
      TriangleShape<Number> result;
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 2; ++j)
          result.gradients[i][j] = rest(task, group, TriangleNumber::gradients + 2 * i + j);
        for (int k = 0; k < 3; ++k)
          result.bending[i][k] = rest(task, group, TriangleNumber::bending + 3 * i + k);
        result.lengths[i] = rest(task, group, TriangleNumber::lengths + i);
      }
      return result;
    }

    static Number
    rest(const TriangleTask &task, const Group &group, const std::size_t number)
    {
      return load(task.rest, group, TriangleNumber::size, number);
    }

    static std::array<Vector3<Number>, 3>
    places(const TriangleTask &task, const Group &group)
    {
      std::array<Vector3<Number>, 3> result;
      for (int i = 0; i < 3; ++i)
        result[i] = place(task.positions, task.nodes + group.at(3, i));
      return result;
    }

    static ShellNumbers<Number>
    load_six(const double *from, const Group &group)
    {
      ShellNumbers<Number> result;
      for (std::size_t k = 0; k < n_shell_strains; ++k)
        result[k] = load(from, group, n_shell_strains, k);
      return result;
    }

    static void
    find_strains(const TriangleTask &task, const std::size_t begin, const std::size_t end)
    {
      for_each_group(begin, end,
                     [&](const Group &group)
                     {
                       const TriangleShape<Number>  of = shape(task, group);
                       const TriangleStrain<Number> triangle(task.kind, of, places(task, group));
                       std::array<Number, 3>        turns;
                       for (int i = 0; i < 3; ++i)
                         turns[i] = rest(task, group, TriangleNumber::of_hinge + i)
                                        * gather(task.changes, task.hinges + group.at(3, i))
                                    + rest(task, group, TriangleNumber::of_slope + i)
                                          * gather(task.positions, task.slopes + group.at(3, i));
                       const ShellNumbers<Number> strain = triangle.strain(turns);
                       for (std::size_t k = 0; k < n_shell_strains; ++k)
                         store(strain[k], task.strains, group, n_shell_strains, k);
                       store(triangle.membrane().area_ratio(), task.areas, group, 1, 0);
                       if (task.frames == nullptr)
                         return;
                       for (int c = 0; c < 3; ++c)
                       {
                         store(triangle.membrane().axis(0)[c], task.frames, group, 9, c);
                         store(triangle.membrane().axis(1)[c], task.frames, group, 9, 3 + c);
                         store(triangle.membrane().normal()[c], task.frames, group, 9, 6 + c);
                       }
                     });
    }

    /// The weight of the i-th of the examples in each triangle.
    static Number
    weight(const TriangleTask &task, const Group &group, const std::size_t i)
    {
      const ExampleArrays &of = task.examples;
      if (of.share_start == nullptr)
        return Number(task.weights[of.first + i]);
      alignas(64) double numbers[width];
      for (std::size_t l = 0; l < width; ++l)
      {
        const std::size_t triangle = group.batch * batch_size + group.lane + l;
        numbers[l]                 = 0.;
        for (std::size_t s = of.share_start[triangle];
             triangle < task.n && s < of.share_start[triangle + 1]; ++s)
          numbers[l]
              += of.shares[s].value * task.weights[of.shares[s].region * of.n_all + of.first + i];
      }
      return Lanes<Number>::load(numbers);
    }

    static void
    blend(const TriangleTask &task, const std::size_t begin, const std::size_t end)
    {
      for_each_group(begin, end,
                     [&](const Group &group)
                     {
                       ShellNumbers<Number> sum;
                       sum.fill(Number(0.));
                       for (std::size_t i = 0; i < task.examples.n; ++i)
                       {
                         const Number w = weight(task, group, i);
                         for (std::size_t k = 0; k < n_shell_strains; ++k)
                           sum[k] += w * of_example(task, group, i, k);
                       }
                       for (std::size_t k = 0; k < n_shell_strains; ++k)
                         store(sum[k], task.targets, group, n_shell_strains, k);
                     });
    }

    static Number
    of_example(const TriangleTask &task,
               const Group        &group,
               const std::size_t   i,
               const std::size_t   k)
    {
      return load(task.examples.strains, group, n_shell_strains * task.examples.n,
                  n_shell_strains * i + k);
    }

    static void
    find_products(const TriangleTask &task,
                  const bool          of_strain_alone,
                  const std::size_t   begin,
                  const std::size_t   end)
    {
      for_each_group(begin, end,
                     [&](const Group &group)
                     {
                       ShellNumbers<Number> strain = load_six(task.strains, group);
                       if (!of_strain_alone)
                         strain = difference_of(strain, load_six(task.targets, group));
                       const ShellNumbers<Number> T = elasticity(task, group).stress(strain);
                       const Number volume          = rest(task, group, TriangleNumber::volume);
                       for (std::size_t i = 0; i < task.examples.n; ++i)
                       {
                         ShellNumbers<Number> E;
                         for (std::size_t k = 0; k < n_shell_strains; ++k)
                           E[k] = of_example(task, group, i, k);
                         store(volume * contract(T, E), task.products, group, task.examples.n, i);
                       }
                     });
    }

    static TriangleElasticity<Number>
    elasticity(const TriangleTask &task, const Group &group)
    {
      return { rest(task, group, TriangleNumber::lambda), rest(task, group, TriangleNumber::mu),
               task.kind };
    }

    static ShellNumbers<Number>
    difference_of(ShellNumbers<Number> a, const ShellNumbers<Number> &b)
    {
      for (std::size_t k = 0; k < n_shell_strains; ++k)
        a[k] -= b[k];
      return a;
    }

    /// The magnitudes of a stress, of the membrane and of what bends.
    struct Magnitudes
    {
      explicit Magnitudes(const ShellNumbers<Number> &stress)
          : membrane(sqrt(contract_membrane(stress, stress))),
            bending(sqrt(contract_bending(stress, stress)))
      {
      }

      Number
      whole() const
      {
        return sqrt(membrane * membrane + bending * bending);
      }

      Number membrane, bending;
    };

    static void
    find_forces(const TriangleTask &task, const std::size_t begin, const std::size_t end)
    {
      for_each_group(
          begin, end,
          [&](const Group &group)
          {
            using namespace TriangleResult;
            const auto put = [&](const Number &number, const std::size_t place)
            { store(number, task.found, group, TriangleResult::size, place); };
            const TriangleElasticity<Number> C      = elasticity(task, group);
            const Number                     volume = rest(task, group, TriangleNumber::volume);
            const ShellNumbers<Number>       e      = load_six(task.strains, group),
                                       D            = load_six(task.targets, group),
                                       beyond = difference_of(e, D), elastic = C.stress(e);
            ShellNumbers<Number> T = C.stress(beyond);
            const Magnitudes     of_elastic(elastic), of_target(C.stress(D));
            const Number         scale_of_all = of_elastic.whole() + of_target.whole();
            Number               membrane     = of_elastic.membrane + of_target.membrane,
                   bends                      = of_elastic.bending + of_target.bending;
            put(Number(0.5) * volume * contract(T, beyond), energy);
            put(Number(0.5) * volume * contract(elastic, e), energy_elastic);
            put(volume * scale_of_all * scale_of_all, stress_square);
            put(Number(0.), energy_damping);
            if (task.past != nullptr)
            {
              const Number               s(task.damping);
              const ShellNumbers<Number> past       = load_six(task.past, group),
                                         since      = difference_of(e, past),
                                         of_damping = C.stress(since);
              const Magnitudes of_past(C.stress(past));
              put(Number(0.5) * s * volume * contract(of_damping, since), energy_damping);
              membrane += s * (of_elastic.membrane + of_past.membrane);
              bends += s * (of_elastic.bending + of_past.bending);
              for (std::size_t k = 0; k < n_shell_strains; ++k)
                T[k] += s * of_damping[k];
            }
            put(volume * membrane, scale);
            put(volume * bends, bending_scale);
            const TriangleShape<Number>  of = shape(task, group);
            const TriangleStrain<Number> triangle(task.kind, of, places(task, group));
            const auto                   at_vertices = triangle.forces(T);
            const auto                   at_edges    = triangle.moments(T);
            for (int i = 0; i < 3; ++i)
            {
              for (int c = 0; c < 3; ++c)
                put(volume * at_vertices[i][c], TriangleResult::forces + 3 * i + c);
              put(volume * at_edges[i], TriangleResult::moments + i);
            }
          });
    }

    static Number
    nearest(const Number &angle, const Number &last)
    {
      using std::round;
      const Number whole(6.28318530717958647692);
      return angle + whole * round((last - angle) / whole);
    }
  };
} // namespace Exemplar

#endif
