// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/volume_resistance.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace Exemplar
{
  VolumeResistance::VolumeResistance(const EnclosedVolumes &volumes,
                                     const double           stiffness,
                                     const ExampleTargets  &examples,
                                     const TargetBlock     &targets)
      : volumes(volumes), stiffness(stiffness), examples(examples), targets(targets),
        changes(volumes.size(), 0.)
  {
  }

  void
  VolumeResistance::begin_step(const double s, const std::vector<WeightedPositions> &positions)
  {
    damping = s;
    past.assign(volumes.size(), 0.);
    for (const WeightedPositions &earlier : positions)
      for (unsigned int piece = 0; piece < volumes.size(); ++piece)
        past[piece] += earlier.weight * volumes.change(piece, *earlier.positions);
  }

  void
  VolumeResistance::leave_step()
  {
    damping = 0.;
    past.clear();
  }

  void
  VolumeResistance::find_changes(const Vector &positions)
  {
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
      changes[piece] = volumes.change(piece, positions);
  }

  double
  VolumeResistance::wanted(const unsigned int piece, const std::vector<double> &weights) const
  {
    double sum = 0.;
    if (!weights.empty())
      targets.add_blend(piece, weights, &sum);
    return sum;
  }

  double
  VolumeResistance::pressure(const unsigned int piece, const std::vector<double> &weights) const
  {
    const double of_damping = damping > 0. ? damping * (changes[piece] - past[piece]) : 0.;
    return unit(piece) * (changes[piece] - wanted(piece, weights) + of_damping);
  }

  void
  VolumeResistance::add(const Vector              &positions,
                        const std::vector<double> &weights,
                        const bool                 with_weights,
                        ElasticSums               &sums) const
  {
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      const double v = changes[piece], D = wanted(piece, weights), KV = unit(piece);
      double       scale = std::abs(v) + std::abs(D);
      sums->energy_elastic += 0.5 * KV * v * v;
      sums->energy += 0.5 * KV * (v - D) * (v - D);
      sums->stress_square += KV * stiffness * scale * scale;
      if (damping > 0.)
      {
        sums->energy_damping += 0.5 * damping * KV * (v - past[piece]) * (v - past[piece]);
        scale += damping * (std::abs(v) + std::abs(past[piece]));
      }
      Vector gradient(positions.size());
      volumes.add_gradient(piece, positions, 1., gradient);
      sums->gradient.add(pressure(piece, weights), gradient);
      for (std::size_t node = 0; node < gradient.size() / 3; ++node)
        sums->force_scale[node] += KV * scale * norm(place_in(gradient, node));
      for (unsigned int weight = 0; with_weights && weight < sums->weight_gradient.size(); ++weight)
        sums->weight_gradient[weight] -= KV * (v - D) * targets.number(piece, weight, 0);
    }
  }

  void
  VolumeResistance::add_weight_linear_term(std::vector<double> &c) const
  {
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
      for (unsigned int weight = 0; weight < c.size(); ++weight)
        c[weight] += unit(piece) * changes[piece] * targets.number(piece, weight, 0);
  }

  void
  VolumeResistance::add_columns(const unsigned int   piece,
                                const Vector        &gradient,
                                const FreeDofs      &free_dofs,
                                std::vector<double> &columns) const
  {
    const std::vector<unsigned int> &free = free_dofs.local_list();
    for (unsigned int weight = 0; weight < examples.n_weights(); ++weight)
    {
      if (!examples.is_strained(weight))
        continue;
      const double factor = unit(piece) * targets.number(piece, weight, 0);
      double      *column = columns.data() + free.size() * examples.strained_index(weight);
      for (std::size_t row = 0; row < free.size(); ++row)
        column[row] += factor * gradient[free[row]];
    }
  }

  void
  VolumeResistance::add_tangent(const Tangent              kind,
                                const Vector              &positions,
                                const std::vector<double> &weights,
                                const SymmetricPattern    &pattern,
                                const FreeDofs            &free_dofs,
                                std::vector<double>       &values,
                                std::vector<double>       &columns,
                                OuterProducts             &products) const
  {
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      Vector gradient(positions.size());
      volumes.add_gradient(piece, positions, 1., gradient);
      std::vector<unsigned int> nodes;
      std::vector<double>       numbers;
      for (unsigned int node = 0; node < gradient.size() / 3; ++node)
        if (const Vector3<double> at = place_in(gradient, node); norm(at) > 0.)
        {
          nodes.push_back(node);
          numbers.insert(numbers.end(), { at[0], at[1], at[2] });
        }
      products.add((1. + damping) * unit(piece), nodes, numbers);
      if (!columns.empty())
        add_columns(piece, gradient, free_dofs, columns);
      if (kind == Tangent::convex)
        continue; // the second derivative of a volume is indefinite
      const double p = pressure(piece, weights);
      volumes.for_each_second_derivative(
          piece, positions,
          [&](const unsigned int a, const unsigned int b, const Vector3<double> &v)
          {
            for (unsigned int i = 0; i < 3; ++i)
            {
              const unsigned int j = (i + 1) % 3, k = (i + 2) % 3; // e_i.(e_j x v) = v_k
              for (const auto &[row, column, entry] :
                   { std::make_tuple(3 * a + i, 3 * b + j, v[k]),
                     std::make_tuple(3 * a + j, 3 * b + i, -v[k]) })
              {
                const int m = free_dofs.free_index(row), n = free_dofs.free_index(column);
                if (m != FreeDofs::held && n != FreeDofs::held)
                  values[pattern.position(std::max(m, n), std::min(m, n))] += p * entry;
              }
            }
          });
    }
  }

  void
  VolumeResistance::add_response(const Tangent              kind,
                                 const Vector              &displacement,
                                 const Vector              &positions,
                                 const std::vector<double> &weights,
                                 Vector                    &result,
                                 std::vector<double>       &by_weights) const
  {
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      Vector gradient(positions.size());
      volumes.add_gradient(piece, positions, 1., gradient);
      const double along = gradient * displacement;
      result.add((1. + damping) * unit(piece) * along, gradient);
      for (unsigned int weight = 0; weight < by_weights.size(); ++weight)
        by_weights[weight] -= unit(piece) * along * targets.number(piece, weight, 0);
      if (kind == Tangent::convex)
        continue;
      const double p   = pressure(piece, weights);
      const auto   add = [&](const unsigned int node, const Vector3<double> &force)
      {
        for (unsigned int c = 0; c < 3; ++c)
          result[3 * node + c] += p * force[c];
      };
      volumes.for_each_second_derivative(
          piece, positions,
          [&](const unsigned int a, const unsigned int b, const Vector3<double> &v)
          {
            add(a, cross(place_in(displacement, b), v));
            add(b, cross(v, place_in(displacement, a)));
          });
    }
  }

  double
  VolumeResistance::stress_square_of(const double error) const
  {
    double sum = 0.;
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      const double stress = stiffness * error * volumes.area(piece) / volumes.rest(piece);
      sum += volumes.rest(piece) * stress * stress;
    }
    return sum;
  }

  double
  VolumeResistance::force_of(const double error) const
  {
    double greatest = 0.;
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
      greatest = std::max(greatest, stiffness * error * volumes.area(piece) / volumes.rest(piece)
                                        * 2. * volumes.greatest_triangle(piece));
    return greatest;
  }

  std::size_t
  VolumeResistance::memory_consumption() const
  {
    std::size_t n = 0;
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
      n += volumes.triangles(piece).capacity();
    return n * sizeof(unsigned int) + dealii::MemoryConsumption::memory_consumption(changes);
  }
} // namespace Exemplar
