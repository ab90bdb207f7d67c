// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_term_h
#define exemplar_obstacle_term_h

#include <exemplar/potential/contact_slopes.h>
#include <exemplar/potential/touching_term.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// What an obstacle did to the body at the end of the last step, and since the beginning.
  struct ObstacleReport
  {
    std::string  name;
    SpaceVector3 force, torque; ///< on the body [N], [N m]
    double       work, heat;    ///< on the body, of friction [J]
  };

  /// What obstacles do to the body: a barrier between each pair of parts that are nearer than the width, and friction,
  /// doc/contact.md. It couples nodes of a face alone, which share a cell.
  class ObstacleTerm : public TouchingTerm
  {
  public:
    /// `integrator` is null unless the scene is dynamic. All must outlive the term.
    ObstacleTerm(const Obstacles      &obstacles,
                 const ContactSurface &surface,
                 const Material       &material,
                 const TimeIntegrator *integrator);

    std::string
    name() const override
    {
      return "obstacles";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override;

    void
    begin_step(const State &start, double step_size) override;

    bool
    has_tangent_of_step() const override;

    TermChange
    renew(const TermPoint &at) override;

    std::optional<double>
    dissipation(const State &end) const override;

    std::optional<EnergyFlow>
    energy_flow(const State &start, const State &end) const override;

    void
    end_step(const State &end) override;

    void
    leave_step() override;

    void
    set_time(double time) override;

    void
    move_to(double time) override;

    bool
    differs(const double time, const double other_time) const override
    {
      return moves_between(time, other_time);
    }

    bool
    moves_between(const double time, const double other_time) const override
    {
      return obstacles.move_between(time, other_time);
    }

    double
    max_step_to(double time, const Vector &positions, const Vector &displacement) const override;

    std::string
    limit_to(double time, const Vector &positions, const Vector &displacement) const override;

    double
    gap_width() const override
    {
      return obstacles.width;
    }

    void
    append_gaps_of_way(double            now,
                       double            to_time,
                       const Vector     &from,
                       const Vector     &to,
                       double            range,
                       std::vector<Gap> &gaps) override;

    double
    max_step(const Vector &positions, const Vector &displacement) const override;

    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override;

    /// Force [N] and pressure [Pa] on the nodes.
    void
    append_fields(const Vector &positions, std::vector<NodalField> &fields) const override;

    NoGradients
    no_gradients() const override;

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    std::size_t
    memory_consumption() const override;

    /// The results of each obstacle. All processes must call this.
    std::vector<ObstacleReport>
    report() const;

    /// The names of obstacles that were near where no step ended. All processes must call this.
    std::vector<std::string>
    untouched() const;

    /// The pairs that are nearer than `range` times their width, of the obstacles that are there.
    std::vector<Contact>
    contacts(const Vector &positions, double range = 1.) const;

    /// Where the obstacles were, in the formula of the time scheme.
    struct Earlier
    {
      double                        weight;
      std::vector<StandingObstacle> standing;
    };

    /// What of the term belongs to the step that has begun.
    struct Step : RubbingStep
    {
      Vector               start;       ///< positions where it begins
      std::vector<char>    there;       ///< whether each obstacle is there; empty: all are
      std::vector<Earlier> earlier;     ///< empty without friction
      unsigned int         n_looks = 0; ///< how often renew() has been called
    };

    const Step &
    get_step() const
    {
      return step;
    }

    double
    lag_tolerance() const
    {
      return obstacles.lag_tolerance;
    }

    /// Return to a step that was left for others.
    void
    set_step(Step former)
    {
      step = std::move(former);
      found.positions.reinit(0);
    }

    TouchingSlopes
    slopes(const Vector &positions, const Vector &along, const FESpace &fe_space) const override;

  private:
    /// What touches() has found last, with obstacles as they stand.
    struct Found
    {
      Vector               positions; ///< empty: to be found
      std::vector<Contact> contacts;
    };

    /// What an obstacle has done at the end of a step, and since the beginning.
    struct Sums
    {
      SpaceVector3 force, torque;       ///< on the body [N], [N m]
      double       work        = 0.;    ///< on the body [J]
      double       heat        = 0.;    ///< of friction [J]
      bool         has_touched = false; ///< whether it was near where any step ended

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &force &torque &work &heat &has_touched;
      }
    };

    ContactSearch
    search(unsigned int obstacle) const;

    /// contacts() of range 1, which are kept until the next call: forces, their rounding and their gaps are asked for at the same positions.
    const std::vector<Contact> &
    touches(const Vector &positions) const;

    /// Of each obstacle the force [N] on the body and its moment about the obstacle's place [N m], of this process.
    std::vector<std::pair<SpaceVector3, SpaceVector3>>
    pushes(const Vector &positions) const;

    /// Which obstacles are there in the step that begins at this state. Throws SolverFailure for one that appears where
    /// the body is.
    void
    follow_times(const State &at);

    /// What rubs at a contact, if anything does.
    std::optional<Rubbing>
    rubbing_of(const Contact &contact) const;

    /// Know the obstacles, of which there may be more than before.
    void
    follow_obstacles();

    /// What would rub at these positions.
    std::vector<Rubbing>
    rubbing_at(const Vector &positions) const;

    /// Where obstacles and body were, for slip().
    void
    remember_slip_base(const State &at);

    void
    visit_touches(const Vector &positions, double range, const VisitTouch &visit) const override
    {
      if (range == 1.)
        for (const Contact &contact : touches(positions))
          visit(contact);
      else
        for (const Contact &contact : contacts(positions, range))
          visit(contact);
    }

    const RubbingStep &
    rubbing_step() const override
    {
      return step;
    }

    SpaceVector3
    motion_along(const Rubbing &at, const Vector &positions) const override;

    double
    slip_speed(const Rubbing &at) const override
    {
      return obstacles.slip_speeds.at(at.gap.nodes[0]);
    }

    /// The motion of a contact that rubs.
    ContactMotion
    motion_of(const Rubbing &at, const Vector &positions) const;

    /// Add the derivatives by what makes the stiffness and the width of a contact.
    void
    add_origins(const Contact      &contact,
                const ContactSlope &slope,
                ShareDerivatives   &by_shares,
                TouchingSlopes     &sums) const;

    /// In the step, or outside of one at the time that is set.
    bool
    is_there(const unsigned int obstacle) const
    {
      return step.there.empty() ? obstacles.all[obstacle].is_there(time)
                                : step.there[obstacle] != 0;
    }

    const Obstacles              &obstacles;
    bool                          have_friction = false;
    std::vector<StandingObstacle> standing;
    Step                          step;
    double                        time = 0.;
    std::vector<Sums>             sums_of;     ///< of this process
    std::vector<char> has_appeared;            ///< of those with From, whether they have been there
    mutable std::vector<KeptPairs> kept;       ///< of each obstacle; no result depends on it
    mutable Found                  found;      ///< no result depends on it
    Reached                        reached;    ///< where a step ended, of this process
    std::vector<double>            node_areas; ///< of the whole body, by node [m^2]
  };
} // namespace Exemplar

#endif
