// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_wall_h
#define exemplar_tests_wall_h

#include <exemplar/potential/barrier.h>
#include <exemplar/potential/potential_term.h>

#include <cmath>
#include <functional>

namespace Exemplar::Testing
{
  /// Where a half space is, and how it pushes.
  struct WallRules
  {
    dealii::Tensor<1, 3>          normal;    ///< into the free half
    std::function<double(double)> height;    ///< of the wall along the normal at a time [s], [m]
    double                        width;     ///< [m]
    double                        stiffness; ///< of a node [N]
    double                        friction   = 0.;
    double                        slip_speed = 1e-3; ///< [m/s]
  };

  /// A half space that nodes may not enter, with barrier and friction: what an obstacle is, in its simplest form.
  class Wall : public PotentialTerm
  {
  public:
    explicit Wall(WallRules new_rules) : rules(std::move(new_rules)) {}

    std::string
    name() const override
    {
      return "wall";
    }

    void
    attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs) override
    {
      pattern   = &new_pattern;
      free_dofs = &new_free_dofs;
    }

    void
    begin_step(const State &start, const double step_size) override
    {
      begin      = start.positions;
      slip_width = rules.slip_speed * step_size;
      n_renewals = 0;
      forces.assign(begin.size() / 3, 0.);
      move_to(start.time);
    }

    TermChange
    renew(const TermPoint &at) override
    {
      if (rules.friction == 0. || n_renewals == 20)
        return TermChange::none;
      double              difference = 0., greatest = 0.;
      std::vector<double> now(forces.size());
      for (unsigned int node = 0; node < now.size(); ++node)
        if (free_dofs->exchange().owns(node))
        {
          now[node]  = -barrier().slope(distance(at.positions, node));
          difference = std::max(difference, std::abs(now[node] - forces[node]));
          greatest   = std::max(greatest, now[node]);
        }
      if (difference <= 1e-3 * greatest)
        return TermChange::none;
      ++n_renewals;
      forces = now;
      return TermChange::values;
    }

    void
    set_time(const double time) override
    {
      move_to(time);
    }

    void
    move_to(const double time) override
    {
      height = rules.height(time);
    }

    bool
    moves_between(const double time, const double other_time) const override
    {
      return rules.height(time) != rules.height(other_time);
    }

    bool
    differs(const double time, const double other_time) const override
    {
      return moves_between(time, other_time);
    }

    double
    gap_width() const override
    {
      return rules.width;
    }

    void
    append_gaps(const Vector &positions, const double range, std::vector<Gap> &gaps) const override
    {
      for (unsigned int node = 0; node < positions.size() / 3; ++node)
      {
        const double d    = distance(positions, node);
        const bool   rubs = node < forces.size() && rules.friction * forces[node] > 0.;
        if (!free_dofs->exchange().owns(node) || !(d < range * rules.width || rubs))
          continue;
        Gap gap;
        gap.n_nodes         = 1;
        gap.nodes[0]        = node;
        gap.coefficients[0] = 1.;
        gap.normal          = rules.normal;
        gap.distance        = d;
        gap.stiffness       = rules.stiffness;
        gap.width           = rules.width;
        if (rubs)
        {
          gap.friction        = rules.friction * forces[node];
          gap.slip_width      = slip_width;
          gap.friction_normal = rules.normal;
          gap.slip            = slip(positions, node);
        }
        gaps.push_back(gap);
      }
    }

    double
    max_step(const Vector &positions, const Vector &displacement) const override
    {
      return max_step_of(positions, displacement, 0.);
    }

    double
    max_step_to(const double  time,
                const Vector &positions,
                const Vector &displacement) const override
    {
      return max_step_of(positions, displacement, rules.height(time) - height);
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override
    {
      for (unsigned int node = 0; node < at.positions.size() / 3; ++node)
      {
        const double d = distance(at.positions, node);
        if (!free_dofs->exchange().owns(node))
          continue;
        sums->energy += barrier().value(d);
        dealii::Tensor<1, 3> gradient = barrier().slope(d) * rules.normal;
        if (const double bound = friction_of(node); bound > 0.)
        {
          const dealii::Tensor<1, 3> u = slip(at.positions, node);
          const double               s = u.norm() / slip_width;
          sums->energy += bound * slip_width * (s < 1. ? s * s * (1. - s / 3.) : s - 1. / 3.);
          gradient += bound / slip_width * (s < 1. ? 2. - s : 1. / s) * u;
        }
        for (unsigned int c = 0; c < 3; ++c)
          sums->gradient[3 * node + c] += gradient[c];
        sums->force_scale[node] += gradient.norm();
      }
    }

    void
    add_tangent(const TermPoint &at,
                Tangent,
                std::vector<double> &values,
                std::vector<double> &) override
    {
      for (unsigned int node = 0; node < at.positions.size() / 3; ++node)
        if (free_dofs->exchange().owns(node))
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j <= i; ++j)
            {
              const int row    = free_dofs->free_index(3 * node + i),
                        column = free_dofs->free_index(3 * node + j);
              if (row != FreeDofs::held && column != FreeDofs::held)
                values[pattern->position(row, column)] += curvature(at.positions, node)[i][j];
            }
    }

    void
    add_response(const TermPoint &at,
                 Tangent,
                 const Vector &displacement,
                 ElasticSums  &sums) override
    {
      for (unsigned int node = 0; node < at.positions.size() / 3; ++node)
        if (free_dofs->exchange().owns(node))
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              sums->gradient[3 * node + i]
                  += curvature(at.positions, node)[i][j] * displacement[3 * node + j];
    }

    std::size_t
    memory_consumption() const override
    {
      return 0;
    }

    double
    distance(const Vector &positions, const unsigned int node) const
    {
      double along = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        along += rules.normal[c] * positions[3 * node + c];
      return along - height;
    }

    /// The least distance of a node at these positions.
    double
    least_distance(const Vector &positions) const
    {
      double least = std::numeric_limits<double>::infinity();
      for (unsigned int node = 0; node < positions.size() / 3; ++node)
        least = std::min(least, distance(positions, node));
      return least;
    }

  private:
    Barrier
    barrier() const
    {
      return { rules.stiffness, rules.width };
    }

    double
    friction_of(const unsigned int node) const
    {
      return node < forces.size() ? rules.friction * forces[node] : 0.;
    }

    /// Across the normal, since the step has begun.
    dealii::Tensor<1, 3>
    slip(const Vector &positions, const unsigned int node) const
    {
      dealii::Tensor<1, 3> u;
      for (unsigned int c = 0; c < 3; ++c)
        u[c] = positions[3 * node + c] - begin[3 * node + c];
      return u - (u * rules.normal) * rules.normal;
    }

    dealii::Tensor<2, 3>
    curvature(const Vector &positions, const unsigned int node) const
    {
      dealii::Tensor<2, 3> result = barrier().curvature(distance(positions, node))
                                    * outer_product(rules.normal, rules.normal);
      if (const double bound = friction_of(node); bound > 0.)
      {
        const dealii::Tensor<1, 3> u = slip(positions, node);
        const double               y = u.norm(), s = y / slip_width;
        dealii::Tensor<2, 3>       across;
        for (unsigned int c = 0; c < 3; ++c)
          across[c][c] = 1.;
        across -= outer_product(rules.normal, rules.normal);
        result += bound / slip_width * (s < 1. ? 2. - s : 1. / s) * across;
        if (y > 0.) // f'' - f' / y
          result -= bound / slip_width * (s < 1. ? s : 1. / s) * outer_product(u / y, u / y);
      }
      return result;
    }

    double
    max_step_of(const Vector &positions, const Vector &displacement, const double of_wall) const
    {
      double part = std::numeric_limits<double>::infinity();
      for (unsigned int node = 0; node < positions.size() / 3; ++node)
      {
        double along = -of_wall;
        for (unsigned int c = 0; c < 3; ++c)
          along += rules.normal[c] * displacement[3 * node + c];
        if (along < 0.)
          part = std::min(part, 0.9 * distance(positions, node) / -along);
      }
      return part;
    }

    const WallRules         rules;
    double                  height     = 0.;
    double                  slip_width = 0.;
    unsigned int            n_renewals = 0;
    Vector                  begin;               ///< of the step
    std::vector<double>     forces;              ///< normal ones, lagged
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar::Testing

#endif
