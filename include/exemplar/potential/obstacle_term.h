// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_term_h
#define exemplar_obstacle_term_h

#include <exemplar/potential/contact_forces.h>
#include <exemplar/potential/potential_term.h>

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
  class ObstacleTerm : public PotentialTerm
  {
  public:
    /// All must outlive the term.
    ObstacleTerm(const Obstacles      &obstacles,
                 const ContactSurface &surface,
                 const Material       &material);

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

    TermChange
    renew(const TermPoint &at) override;

    std::optional<double>
    dissipation(const State &end) const override;

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
    append_gaps(const Vector &positions, double range, std::vector<Gap> &gaps) const override;

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    void
    add_response(const TermPoint &at,
                 Tangent          kind,
                 const Vector    &displacement,
                 ElasticSums     &sums) override;

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

    /// The pairs that are nearer than `range` times their width, of the obstacles that are there.
    std::vector<Contact>
    contacts(const Vector &positions, double range = 1.) const;

  private:
    /// What an obstacle has done at the end of a step, and since the beginning.
    struct Sums
    {
      SpaceVector3 force, torque; ///< on the body [N], [N m]
      double       work = 0.;     ///< on the body [J]
      double       heat = 0.;     ///< of friction [J]

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &force &torque &work &heat;
      }
    };

    /// What an obstacle does at the nodes of a contact: call visit(obstacle, node, force on the body [N]).
    template <typename Visit>
    void
    visit_forces(const Vector &positions, const Visit &visit) const;

    /// The blocks of the tangent: visit(nodes, n, blocks).
    template <typename Visit>
    void
    visit_blocks(const Vector &positions, Tangent kind, const Visit &visit) const;

    /// Which obstacles are there in the step that begins at this state. Throws SolverFailure for one that appears where
    /// the body is.
    void
    follow_times(const State &at);

    /// What would rub at these positions.
    std::vector<Rubbing>
    rubbing_at(const Vector &positions) const;

    /// The body's slip along the obstacle since the step has begun [m].
    SpaceVector3
    slip(const Rubbing &at, const Vector &positions) const;

    SlipEnergy
    slip_energy(const Rubbing &at) const
    {
      return { at.coefficient * at.force, obstacles.slip_speed * step_size };
    }

    bool
    is_there(const unsigned int obstacle) const
    {
      return there.empty() || there[obstacle] != 0;
    }

    const Obstacles              &obstacles;
    ContactSurface                surface; ///< with the shares of the material
    const Material               &material;
    const bool                    have_friction;
    std::vector<StandingObstacle> standing;
    std::vector<StandingObstacle> at_start; ///< of the step; empty without friction
    std::vector<char>             there;    ///< whether each is there in this step
    double                        time      = 0.;
    double                        step_size = 0.;
    bool                          in_step   = false;
    Vector                        start;   ///< positions where the step begins
    std::vector<Rubbing>          rubbing; ///< since the last renewal
    unsigned int                  n_renewals = 0;
    std::vector<Sums>             sums_of; ///< of this process
    std::vector<char>       has_appeared;  ///< of those with From, whether they have been there
    double                  barrier_energy = 0.; ///< where a step ended
    double                  least_gap;
    double                  n_pairs = 0.;
    std::vector<double>     node_areas;          ///< of the whole body, by node [m^2]
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
