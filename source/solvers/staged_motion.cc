// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/gap_energies.h>
#include <exemplar/solvers/line_search.h>
#include <exemplar/solvers/staged_motion.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace Exemplar
{
  namespace
  {
    constexpr double       overtaken   = 0.45; ///< widths: what would end nearer is carried
    constexpr double       carried_to  = 0.5;  ///< widths
    constexpr double       aimed_error = 0.04; ///< of the aim
    constexpr unsigned int max_carries = 3; ///< in a stage, as nodes that follow are overtaken, too
    constexpr unsigned int max_push_steps       = 200; ///< for one of these
    constexpr unsigned int max_halvings_of_part = 10;
    constexpr unsigned int max_stages           = 40;
    constexpr double       min_part      = 1e-6; ///< of the way: less in one stage is no progress
    constexpr double       least_of_held = 1e-6; ///< widths
    constexpr double       greatest_turn = 5. * 3.14159265358979323846 / 180.;

    /// Whether one of the gap's nodes is free in some direction.
    bool
    has_free(const Gap &gap, const FreeDofs &free_dofs)
    {
      bool is = false;
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          is |= free_dofs.free_index(3 * gap.nodes[i] + c) != FreeDofs::held;
      return is;
    }

    /// The first handle whose nodes are as near to something as rounding tells, which stages have only come ever nearer to;
    /// the number of handles if there is none. Collective.
    unsigned int
    touching_handle(const IncrementalPotential &potential,
                    const Handles              &handles,
                    const Vector               &positions)
    {
      const FreeDofs &free_dofs = potential.get_free_dofs();
      double          first     = handles.size();
      const auto      touches   = [&](const Gap &gap)
      {
        return gap.stiffness > 0. && gap.distance < least_of_held * gap.width
               && !has_free(gap, free_dofs);
      };
      for (const Gap &gap : potential.gaps(positions, 1.)) // which the step asks for next
        for (unsigned int h = 0; h < first && touches(gap); ++h)
          if (std::find_first_of(gap.nodes.begin(), gap.nodes.begin() + gap.n_nodes,
                                 handles.nodes(h).begin(), handles.nodes(h).end())
              != gap.nodes.begin() + gap.n_nodes)
            first = h;
      return static_cast<unsigned int>(min_of_all(free_dofs.exchange(), first));
    }

    std::string
    handle_words(const Handles &handles, const unsigned int handle)
    {
      return "handle '" + handles.name(handle) + "'";
    }

    SolverFailure
    meeting(const double time, const std::string &held, const std::string &limit)
    {
      return SolverFailure(fmt::format(
          "At t = {:.6g} s {} and {} meet, and nothing gives way. Move the one or the other "
          "another way, or let go before.",
          time, held, limit.empty() ? "what it may not pass" : limit));
    }
  } // namespace

  void
  StagedMotion::stop_if_interrupted() const
  {
    if (may_go_on && !may_go_on())
      throw Interrupted("Interrupted.");
  }

  bool
  StagedMotion::moves_held(const Vector &from, const Vector &to) const
  {
    const FreeDofs &free_dofs = potential.get_free_dofs();
    bool            moves     = false;
    for (unsigned int dof = 0; dof < free_dofs.n_dofs(); ++dof)
      moves |= free_dofs.free_index(dof) == FreeDofs::held && from[dof] != to[dof];
    return free_dofs.exchange().any(moves);
  }

  unsigned int
  StagedMotion::parts_of_turns(const double  start_time,
                               const double  time,
                               const Vector &from,
                               const Vector &to) const
  {
    // the middle of an arc by the angle a is tan(a/4)/2 of its chord beside that
    const FreeDofs &free_dofs = potential.get_free_dofs();
    Vector          middle    = to;
    handles.move(0.5 * (start_time + time), middle);
    double chord = 0., beside = 0.;
    for (unsigned int dof = 0; dof < free_dofs.n_dofs(); ++dof)
      if (free_dofs.free_index(dof) == FreeDofs::held)
      {
        chord  = std::max(chord, std::abs(to[dof] - from[dof]));
        beside = std::max(beside, std::abs(middle[dof] - 0.5 * (to[dof] + from[dof])));
      }
    chord  = free_dofs.exchange().max(chord);
    beside = free_dofs.exchange().max(beside);
    if (chord == 0.)
      return 1;
    const double turn = 4. * std::atan(2. * beside / chord);
    return static_cast<unsigned int>(std::ceil(std::max(1., turn / greatest_turn)));
  }

  unsigned int
  StagedMotion::move(const double  start_time,
                     const Vector &from,
                     const double  time,
                     Vector       &to,
                     const Follow &follow)
  {
    const bool moves_obstacles
        = potential.gap_width() > 0. && potential.moves_between(start_time, time);
    if (potential.gap_width() == 0. || (!moves_obstacles && !moves_held(from, to)))
    {
      keep_within_max_step(potential, from, to, displacement);
      return 1;
    }
    const unsigned int n        = parts_of_turns(start_time, time, from, to);
    unsigned int       n_stages = 0;
    const Vector       end      = to;
    Vector             begin    = from;
    for (unsigned int k = 1; k <= n; ++k)
    {
      const auto at = [&](const unsigned int i)
      { return i == n ? time : start_time + i * (time - start_time) / n; };
      // what is left of the way, in equal parts
      to = begin;
      to.sadd(1. - 1. / (n - k + 1), 1. / (n - k + 1), end);
      handles.move(at(k), to);
      n_stages += move_part(at(k - 1), begin, at(k), to, follow);
      begin = to;
    }
    return n_stages;
  }

  unsigned int
  StagedMotion::move_part(const double  start_time,
                          const Vector &from,
                          const double  time,
                          Vector       &to,
                          const Follow &follow) const
  {
    Vector       at     = from;
    const Vector target = to;
    double       now    = start_time;
    for (unsigned int stage = 1; stage <= max_stages; ++stage)
    {
      stop_if_interrupted();
      to = target;
      potential.move_to(now);
      const bool has_inertia = potential.inertial_positions() != nullptr;
      carry(now, at, time, to, has_inertia ? LeastRoom() : LeastRoom{ 0.5, 1. }, follow);
      Vector way = to;
      way -= at;
      const double part = potential.max_step_to(time, at, way);
      if (part >= 1.)
      {
        potential.move_to(time);
        const unsigned int touching = touching_handle(potential, handles, to);
        if (touching == handles.size())
          return stage;
        potential.move_to(start_time);
        to -= from;
        throw meeting(time, handle_words(handles, touching), potential.limit_to(time, from, to));
      }
      if (!(part > min_part))
        break;
      go(part, time, way, at, now);
    }
    to = target;
    to -= at;
    refuse(now, time, at, to);
  }

  void
  StagedMotion::go(double part, const double time, const Vector &way, Vector &at, double &now) const
  {
    // obstacles need not go straight on: half the part, until all gaps are open
    const Vector from  = at;
    const double start = now;
    for (unsigned int halving = 0; halving < max_halvings_of_part; ++halving, part *= 0.5)
    {
      at = from;
      at.add(part, way);
      now = start + part * (time - start);
      potential.move_to(now);
      bool is_closed = false;
      for (const Gap &gap : potential.gaps(at, overtaken))
        is_closed |= gap.stiffness > 0. && !(gap.distance > 0.);
      if (!potential.get_free_dofs().exchange().any(is_closed))
        return;
    }
    refuse(start, time, from, way);
  }

  namespace
  {
    /// How wide a gap must be [m], and by how much it may differ where it is pushed.
    struct Target
    {
      double distance, error;
    };

    /// The displacement u = H U f of least work after which gaps d + U^T u are at least as wide as their targets: forces f >= 0, and 0
    /// where a gap is wider than that. Conjugate gradients, which begin anew where a force would pull; gaps of which several push the
    /// same nodes may make U^T H U singular.
    class LeastPush
    {
    public:
      /// One target a gap, each of which has a barrier and no friction.
      LeastPush(const GapEnergies          &gaps,
                const std::vector<Target>  &targets,
                const FreeDofs             &free_dofs,
                const StagedMotion::Follow &follow)
          : gaps(gaps), targets(targets), free_dofs(free_dofs), follow(follow),
            missing(missing_after(Vector())), forces(missing.size()), direction(missing.size()),
            displacement(free_dofs.n_dofs())
      {
      }

      Vector
      find()
      {
        for (unsigned int i = 0; i < max_push_steps; ++i)
        {
          const std::vector<double> gradient = missing_where_pushed();
          if (!is_wrong(gradient) || !improve(gradient))
            break;
          missing = missing_after(displacement);
        }
        return displacement;
      }

    private:
      /// Of the targets, after a displacement or none.
      std::vector<double>
      missing_after(const Vector &by) const
      {
        std::vector<double> result(gaps.n_rows());
        if (by.size() > 0)
          result = gaps.changes(by);
        for (std::size_t r = 0; r < result.size(); ++r)
          result[r] = targets[r].distance - gaps.gap_of(r).distance - result[r];
        return result;
      }

      std::vector<double>
      missing_where_pushed() const
      {
        std::vector<double> result = missing;
        for (std::size_t r = 0; r < result.size(); ++r)
          if (!(forces[r] > 0.))
            result[r] = std::max(result[r], 0.);
        return result;
      }

      bool
      is_wrong(const std::vector<double> &gradient) const
      {
        double error = 0.;
        for (std::size_t r = 0; r < gradient.size(); ++r)
          error = std::max(error, std::abs(gradient[r]) / targets[r].error);
        return free_dofs.exchange().max(error) > 1.;
      }

      /// Whether there was a step that does.
      bool
      improve(const std::vector<double> &gradient)
      {
        const double square = product(gradient, gradient);
        const double ratio  = last_square > 0. ? square / last_square : 0.;
        for (std::size_t r = 0; r < direction.size(); ++r)
          direction[r] = gradient[r] + ratio * direction[r];
        const Vector response = response_to(direction);
        const double length
            = product(gradient, direction) / product(direction, gaps.changes(response));
        if (!(length > 0.) || !std::isfinite(length))
          return false;
        add(forces, length, direction);
        if (free_dofs.exchange().any(drop_pulls()))
        {
          displacement = response_to(forces);
          last_square  = 0.;
          return true;
        }
        displacement.add(length, response);
        last_square = square;
        return true;
      }

      /// Whether there were some.
      bool
      drop_pulls()
      {
        bool result = false;
        for (double &force : forces)
        {
          result |= force < 0.;
          force = std::max(force, 0.);
        }
        return result;
      }

      Vector
      response_to(const std::vector<double> &by_row) const
      {
        Vector field(free_dofs.n_dofs());
        gaps.add_forces(by_row, field);
        free_dofs.exchange().assemble(field.begin(), 3);
        std::vector<double> response;
        free_dofs.gather(field, response);
        follow(response);
        field = 0.;
        free_dofs.add(1., response, field);
        return field;
      }

      double
      product(const std::vector<double> &a, const std::vector<double> &b) const
      {
        return free_dofs.exchange().sum(dot(a, b));
      }

      const GapEnergies          &gaps;
      const std::vector<Target>  &targets; ///< by row
      const FreeDofs             &free_dofs;
      const StagedMotion::Follow &follow;
      std::vector<double>         missing, forces, direction; ///< by row
      Vector                      displacement;
      double last_square = 0.; ///< of the gradient, if the direction goes on from that
    };
  } // namespace

  namespace
  {
    /// The distance of each gap that is within a range, by its nodes and its normal.
    class Distances
    {
    public:
      explicit Distances(const std::vector<Gap> &gaps)
      {
        for (const Gap &gap : gaps)
          if (gap.stiffness > 0.)
            known[nodes_of(gap)].emplace_back(gap.normal, gap.distance);
      }

      /// Infinite for a gap that was not within the range.
      double
      of(const Gap &gap) const
      {
        double     least = std::numeric_limits<double>::infinity();
        const auto found = known.find(nodes_of(gap));
        if (found != known.end())
          for (const auto &[normal, distance] : found->second)
            if (normal * gap.normal > 0.5)
              least = std::min(least, distance);
        return least;
      }

    private:
      static std::vector<unsigned int>
      nodes_of(const Gap &gap)
      {
        return { gap.nodes.begin(), gap.nodes.begin() + gap.n_nodes };
      }

      std::map<std::vector<unsigned int>, std::vector<std::pair<dealii::Tensor<1, 3>, double>>>
          known;
    };
  } // namespace

  void
  StagedMotion::carry(const double     now,
                      const Vector    &from,
                      const double     time,
                      Vector          &to,
                      const LeastRoom &room,
                      const Follow    &follow) const
  {
    const FreeDofs     &free_dofs = potential.get_free_dofs();
    const Exchange     &exchange  = free_dofs.exchange();
    const Vector        predicted = to;
    std::vector<Gap>    carried;
    std::vector<Target> targets;
    const Distances     at_start(room.kept < infinite ? potential.gaps(from, overtaken)
                                                      : std::vector<Gap>());
    const Follow        follow_or_stop = [&](std::vector<double> &forces)
    {
      stop_if_interrupted();
      follow(forces);
    };
    for (unsigned int i = 0; i < max_carries; ++i)
    {
      // those that were carried have their aims by now
      bool   is_more    = false;
      Vector difference = to;
      difference -= predicted;
      for (const Gap &gap : potential.gaps_of_way(now, time, from, to, overtaken))
      {
        const double before = std::min(at_start.of(gap), carried_to * gap.width);
        if (!(gap.stiffness > 0.) || !has_free(gap, free_dofs)
            || gap.distance >= room.kept * before)
          continue;
        carried.push_back(gap);
        carried.back().distance -= GapEnergies({ gap }).changes(difference)[0];
        const double aim = std::min(carried_to * gap.width, room.aim * before);
        targets.push_back({ aim, aimed_error * aim });
        is_more = true;
      }
      if (!exchange.any(is_more))
        return;
      to = predicted;
      to += LeastPush(GapEnergies(carried), targets, free_dofs, follow_or_stop).find();
    }
  }

  void
  StagedMotion::keep_open(const double  time,
                          const Vector &positions,
                          Vector       &displacement,
                          const Follow &follow) const
  {
    Vector to = positions;
    to += displacement;
    carry(time, positions, time, to, { 0.1, 0.2 }, follow);
    displacement = to;
    displacement -= positions;
  }

  void
  StagedMotion::refuse(const double  now,
                       const double  time,
                       const Vector &from,
                       const Vector &way) const
  {
    const auto stops = [&](const unsigned int handle)
    {
      Vector of_handle(way.size());
      for (const unsigned int node : handles.nodes(handle))
        for (unsigned int c = 0; c < 3; ++c)
          of_handle[3 * node + c] = way[3 * node + c];
      return potential.max_step_to(time, from, of_handle) < min_part;
    };
    unsigned int handle = 0; // the first that moves, or else the first that is there
    while (handle < handles.size() && !stops(handle))
      ++handle;
    if (handle == handles.size())
      handle = touching_handle(potential, handles, from);
    const std::string held = handle < handles.size() ? handle_words(handles, handle) : "the body";
    throw meeting(now, held, potential.limit_to(time, from, way));
  }
} // namespace Exemplar
