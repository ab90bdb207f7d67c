// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/contact_clearance.h>
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/run/problem/problem.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace Exemplar
{
  namespace
  {
    // parts of the body's diameter: what touches an obstacle is not farther outside or deeper inside
    constexpr double outside_touch = 1e-6;
    constexpr double inside_touch  = 1e-3;
    // how far it is then from the body, a part of the distance from which obstacles push
    constexpr double part_of_width = 1e-2;

    /// An obstacle of a scene and the body as it begins.
    class ObstacleStart
    {
    public:
      ObstacleStart(Obstacles            &obstacles,
                    const unsigned int    number,
                    const ContactSurface &surface,
                    const Body           &body,
                    const Vector         &positions,
                    const double          time)
          : obstacles(obstacles), number(number), obstacle(obstacles.all[number]), surface(surface),
            body(body), positions(positions), time(time)
      {
      }

      /// What was done; empty: nothing.
      std::string
      set_back()
      {
        Clearance    first    = look();
        const double diameter = obstacles.sizes.diameters[first.piece];
        if (first.least > outside_touch * diameter && !first.is_crossed)
          return "";
        const double least = part_of_width * width_of(first);
        // the middle of a shell may lie on the obstacle, as it is drawn
        const double most     = inside_touch * diameter + surface.greatest_offset() + least;
        const bool   is_solid = obstacle.shape().half_sizes || obstacle.shape().is_surface();
        double       by       = least - first.least;
        if (!is_solid && (first.is_crossed || by > most))
          refuse(first);
        if (is_solid)
          by = least_set_back(first, least, most);
        obstacle.set_back(by, first.outwards);
        return fmt::format("Obstacles/{} touches the body near {} m: it is set back by {} m",
                           obstacle.name(), place_text(first.place), short_text(by));
      }

      /// Throws UserError for a body that has gone on to where the obstacle is.
      void
      refuse_what_is_inside()
      {
        if (const Clearance now = look(); now.least <= 0. || now.is_crossed)
          refuse(now);
      }

      /// Let pairs that are near keep their distances as widths.
      void
      keep_widths()
      {
        StandingObstacle standing(obstacle);
        standing.move_to(time);
        auto                                       &widths = obstacles.start_widths[number];
        std::vector<std::pair<PairKey, StartWidth>> found;
        const ContactSearch                         search(surface, obstacles, standing, number);
        search.visit_near(positions, obstacles.width,
                          [&](const ContactPair &pair, const PairDistance &at)
                          {
                            if (at.distance < search.width(pair))
                              found.emplace_back(pair.key(),
                                                 StartWidth{ at.distance, at.nearest.a,
                                                             standing.pose.rotation * at.normal });
                          });
        // of the triangles of a flat part the nearest counts
        std::sort(found.begin(), found.end(),
                  [](const auto &one, const auto &other) {
                    return std::tie(one.first, one.second.width)
                           < std::tie(other.first, other.second.width);
                  });
        widths.insert(found.begin(), found.end());
      }

    private:
      /// From where the obstacle pushes the nearest piece [m].
      double
      width_of(const Clearance &at) const
      {
        const std::vector<double> &widths = obstacles.widths.of_pieces;
        return widths[widths.size() == 1 ? 0 : at.piece];
      }

      Clearance
      look() const
      {
        StandingObstacle standing(obstacle);
        standing.move_to(time);
        return clearance(surface, obstacles, standing, number, positions,
                         std::max(obstacles.width, inside_touch * body.mesh.diameter()),
                         body.exchange());
      }

      /// The least by which a box or surface must go, found by halving. Throws UserError if that is more than `most`.
      double
      least_set_back(Clearance &first, const double least, const double most)
      {
        constexpr unsigned int max_halvings = 40;
        const auto             is_enough    = [&](const double by)
        {
          obstacle.set_back(by, first.outwards);
          const Clearance now = look();
          obstacle.set_back(-by, first.outwards);
          return !now.is_crossed && now.least >= 0.999 * least;
        };
        // nothing tells the side of an open surface on which a shell is that lies in it
        if (first.is_either && !obstacle.shape().is_closed)
          refuse(first);
        if (first.is_either && !is_enough(most))
          first.outwards *= -1.;
        if (first.outwards.norm() == 0. || !is_enough(most))
          refuse(first);
        double low = 0., high = most;
        for (unsigned int halving = 0; halving < max_halvings && high - low > 1e-3 * least;
             ++halving)
        {
          const double middle              = 0.5 * (low + high);
          (is_enough(middle) ? high : low) = middle;
        }
        return high;
      }

      [[noreturn]] void
      refuse(const Clearance &first) const
      {
        const std::string what = fmt::format(
            "{} inside of Obstacles/{}, near {} m",
            time > 0. ? "At t = " + shortest_text(time) + " s the body is" : "The body begins",
            obstacle.name(), place_text(first.place));
        if (first.is_crossed)
          throw UserError(what
                          + ". Move the obstacle (Shape), or the body (Initial/Pose), so that "
                            "they do not meet.");
        StandingObstacle standing(obstacle);
        standing.move_to(time);
        // along the gradient of the distance there
        SpaceVector3        way;
        const ContactSearch search(surface, obstacles, standing, number);
        search.visit_near(positions, 0.,
                          [&](const ContactPair &, const PairDistance &at)
                          {
                            if (at.distance == first.least)
                              way = standing.pose.rotation * at.normal;
                          });
        std::array<double, 3> numbers{ { way[0], way[1], way[2] } };
        body.exchange().sum(numbers.data(), 3);
        for (unsigned int c = 0; c < 3; ++c)
          way[c] = numbers[c];
        if (way.norm() == 0.)
          way = -first.outwards;
        const double depth = -first.least;
        if (!(depth > 0.))
          throw UserError(fmt::format(
              "{} touches Obstacles/{} near {} m, and its shape does not tell on which side the "
              "body is. Move the obstacle (Shape), or the body (Initial/Pose), until there is a "
              "gap.",
              time > 0. ? "At t = " + shortest_text(time) + " s the body" : "The body",
              obstacle.name(), place_text(first.place)));
        if (way.norm() > 0.)
          way *= 1.001 * depth / way.norm();
        throw UserError(fmt::format(
            "{}, {} m deep. A displacement of the body by {} m would mend it, or one of "
            "the obstacle by the opposite.",
            what, short_text(depth), place_text(way)));
      }

      Obstacles            &obstacles;
      const unsigned int    number;
      Obstacle             &obstacle;
      const ContactSurface &surface;
      const Body           &body;
      const Vector         &positions;
      const double          time;
    };
  } // namespace

  namespace
  {
    /// By how much an obstacle's form turns between two poses [rad]: half spaces with their normals, a ball not at all.
    double
    turn_of_form(const ObstacleShape &shape, const ObstaclePose &before, const ObstaclePose &after)
    {
      double     least_cosine = 1.;
      const auto add          = [&](const SpaceVector3 &direction)
      {
        if (const double square = direction.norm_square(); square > 0.)
          least_cosine = std::min(least_cosine, (before.rotation * direction)
                                                    * (after.rotation * direction) / square);
      };
      for (const ObstacleShape::HalfSpace &half_space : shape.half_spaces)
        add(half_space.normal);
      for (const SpaceVector3 &vertex : shape.vertices)
        add(vertex);
      return std::acos(std::max(-1., least_cosine));
    }

    /// How far an obstacle goes and turns in the step from `begin` to `end` [s]. Throws UserError if that is more
    /// than the stages of a step can follow.
    void
    check_motion_in_step(const Obstacle &obstacle,
                         const double    begin,
                         const double    end,
                         const double    diameter)
    {
      constexpr double   greatest    = 0.25; // of the diameter
      constexpr double   most_turned = 1.;   // [rad]
      constexpr double   golden = 0.618; // of the step: what is back at its end is elsewhere then
      const ObstaclePose from = obstacle.pose(begin), to = obstacle.pose(end),
                         between = obstacle.pose(begin + golden * (end - begin));
      double way = max_or_nan((between.place - from.place).norm(), (to.place - from.place).norm());
      const bool deforms = obstacle.deforms();
      const auto before  = deforms ? obstacle.vertices(begin) : std::vector<SpaceVector3>();
      const auto after   = deforms ? obstacle.vertices(end) : before;
      for (std::size_t v = 0; v < before.size(); ++v)
        way = max_or_nan(way, (after[v] - before[v]).norm());
      if (!(way <= greatest * diameter))
        throw UserError(fmt::format(
            "Obstacles/{} goes {} m in the step to t = {} s, more than a quarter of the body's "
            "diameter of {} m. Take smaller steps (Time/Step or Time/Increments), or a slower {}.",
            obstacle.name(), short_text(way), shortest_text(end), short_text(diameter),
            deforms ? "cache" : "Motion"));
      const double turn = std::max(turn_of_form(obstacle.shape(), from, between),
                                   turn_of_form(obstacle.shape(), from, to));
      if (!(turn <= most_turned))
        throw UserError(fmt::format(
            "Obstacles/{} turns by {} rad in the step to t = {} s, more than 1. Take smaller "
            "steps (Time/Step or Time/Increments), or a slower Turn or track.",
            obstacle.name(), short_text(turn), shortest_text(end)));
    }
  } // namespace

  void
  check_obstacle_motions(const Obstacles &obstacles, const Body &body, const TimeAxis &axis)
  {
    constexpr unsigned int most_steps_of_formulas = 1000000; // two poses take microseconds
    constexpr unsigned int most_steps_of_caches   = 10000;   // which are read
    for (const Obstacle &obstacle : obstacles.all)
    {
      const unsigned int most = obstacle.deforms() ? most_steps_of_caches : most_steps_of_formulas;
      for (unsigned int step = 1; step <= std::min(axis.n_steps(), most); ++step)
        if (obstacle.is_there(axis.time(step - 1)))
          check_motion_in_step(obstacle, axis.time(step - 1), axis.time(step),
                               body.mesh.diameter());
    }
  }

  void
  suit_obstacles(Obstacles                &obstacles,
                 const ContactSurface     &surface,
                 const Body               &body,
                 const Vector             &positions,
                 const double              time,
                 std::vector<std::string> &notes)
  {
    for (unsigned int i = 0; i < obstacles.all.size(); ++i)
    {
      if (!obstacles.all[i].is_there(time))
        continue;
      ObstacleStart start(obstacles, i, surface, body, positions, time);
      if (const std::string done = start.set_back(); !done.empty())
        notes.push_back(done);
      start.keep_widths();
    }
  }

  void
  check_resumed_obstacles(Problem &problem)
  {
    if (problem.actions.obstacles == nullptr)
      return;
    Obstacles &obstacles = *problem.actions.obstacles;
    for (unsigned int i = 0; i < obstacles.all.size(); ++i)
      if (obstacles.all[i].is_there(problem.state.time))
        ObstacleStart(obstacles, i, *problem.actions.contact_surface, problem.body,
                      problem.state.positions, problem.state.time)
            .refuse_what_is_inside();
  }

  std::vector<std::string>
  idle_obstacle_warnings(const Problem &problem)
  {
    std::vector<std::string> warnings;
    if (const ObstacleTerm *const term = find_obstacle_term(problem))
      for (const std::string &name : term->untouched())
        warnings.push_back("No step ends near Obstacles/" + name
                           + ": it does nothing. Look at its Shape, Motion, From and Until, or "
                             "leave it out of Obstacles/Names.");
    return warnings;
  }

  ObstacleTerm *
  find_obstacle_term(const Problem &problem)
  {
    if (problem.actions.obstacles != nullptr)
      for (const auto &term : problem.potential.get_terms())
        if (auto *const found = dynamic_cast<ObstacleTerm *>(term.get()))
          return found;
    return nullptr;
  }

  std::vector<const TouchingTerm *>
  touching_terms(const Problem &problem)
  {
    std::vector<const TouchingTerm *> found;
    if (problem.actions.obstacles != nullptr || problem.actions.body_contacts != nullptr)
      for (const auto &term : problem.potential.get_terms())
        if (auto *const touching = dynamic_cast<const TouchingTerm *>(term.get()))
          found.push_back(touching);
    return found;
  }

  Vector
  contact_forces(const Problem &problem)
  {
    Vector sum(problem.state.positions.size());
    for (const TouchingTerm *const term : touching_terms(problem))
      sum += term->forces(problem.state.positions);
    return sum;
  }
} // namespace Exemplar
