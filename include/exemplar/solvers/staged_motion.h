// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_staged_motion_h
#define exemplar_staged_motion_h

#include <exemplar/body/handles.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/solvers/gap_energies.h>

#include <functional>
#include <limits>

namespace Exemplar
{
  /// Takes obstacles, held nodes and the body to the end of a step where obstacles or held nodes move, in stages: nodes that
  /// would be overtaken are carried before the obstacle, and the rest of the body follows as its elasticity tells.
  class StagedMotion
  {
  public:
    /// Overwrites forces, by unknown, by the displacements with which the body follows, also by unknown.
    using Follow = std::function<void(std::vector<double> &)>;

    /// All must outlive the object.
    StagedMotion(IncrementalPotential        &potential,
                 const Handles               &handles,
                 const std::function<bool()> &may_go_on)
        : potential(potential), handles(handles), may_go_on(may_go_on)
    {
    }

    /// From positions at `start_time`, where all gaps are open, to those at `time`. `to` holds where the body would be,
    /// with held nodes where handles put them, and is drawn back or carried to where gaps are open too; obstacles stand where they
    /// are at `time` then. Returns the number of stages. Throws SolverFailure where that cannot be, and Interrupted
    /// between two stages if `may_go_on` returns false.
    unsigned int
    move(double start_time, const Vector &from, double time, Vector &to, const Follow &follow);

    /// Change a displacement that would close gaps to the nearest one that leaves each a part, in the norm of the matrix whose inverse
    /// is `follow`. Obstacles are where they are at `time`. With the tangent of a convex model this is its minimum within these
    /// limits, so that a descent direction stays one.
    void
    keep_open(double        time,
              const Vector &positions,
              Vector       &displacement,
              const Follow &follow) const;

  private:
    /// Whether held nodes are at other places.
    bool
    moves_held(const Vector &from, const Vector &to) const;

    /// Of as many equal parts no handle turns by more than five degrees in one.
    unsigned int
    parts_of_turns(double start_time, double time, const Vector &from, const Vector &to) const;

    /// One of these parts, in stages.
    unsigned int
    move_part(
        double start_time, const Vector &from, double time, Vector &to, const Follow &follow) const;

    /// Go a part of a way, and the obstacles that of theirs to `time`.
    void
    go(double part, double time, const Vector &way, Vector &at, double &now) const;

    static constexpr double infinite = std::numeric_limits<double>::infinity();

    /// The parts of a gap's distance at the start that are enough at the end, and that a gap gets that has less. At most the middle of
    /// its width is asked for.
    struct LeastRoom
    {
      double kept = infinite, aim = infinite;
    };

    /// Change `to` so that gaps have this room after the way from `from`, where obstacles stand `now`, to `to` at `time` [s].
    void
    carry(double           now,
          const Vector    &from,
          double           time,
          Vector          &to,
          const LeastRoom &room,
          const Follow    &follow) const;

    /// Say who cannot pass whom on that way between these times [s].
    [[noreturn]] void
    refuse(double now, double time, const Vector &from, const Vector &way) const;

    /// Throws Interrupted unless the motion may go on.
    void
    stop_if_interrupted() const;

    IncrementalPotential        &potential;
    const Handles               &handles;
    const std::function<bool()> &may_go_on; ///< of the solver; may be empty
    Vector displacement;                    ///< of a step without stages, kept for its memory alone
  };
} // namespace Exemplar

#endif
